// SPDX-License-Identifier: Apache-2.0
// WebAssembly has no signals: nothing interrupts a name that changes.

#include "files/unfinished_files.h"

namespace tex::inline v1 {

NameSection::NameSection() { static_cast<void>(before_); }
NameSection::~NameSection() = default;

UnfinishedFile::UnfinishedFile() : entry_(nullptr) {}
UnfinishedFile::~UnfinishedFile() = default;
void UnfinishedFile::add(const NameSection&, int, const std::string&) {}
void UnfinishedFile::remove(const NameSection&) {}
void UnfinishedFile::remove_all() noexcept {}

}  // namespace tex::inline v1
