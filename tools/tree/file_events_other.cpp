// SPDX-License-Identifier: Apache-2.0
// For systems whose reports of changed files are not used yet: build-normals refuses --watch.

#include "tree/file_events.h"

namespace tex::cli {

FileEvents::~FileEvents() = default;

Result<void> FileEvents::open() {
    return Error{ErrorCode::unsupported,
                 {},
                 "--watch needs inotify, which only Linux has; run build-normals again after a change: what is up to "
                 "date takes no time"};
}

Result<bool> FileEvents::add(const std::string&, const std::string&) { return false; }

void FileEvents::end(bool) {}

bool FileEvents::wait(int, std::vector<FileEvent>&) const { return true; }

bool is_complete(const std::string&) { return true; }

}  // namespace tex::cli
