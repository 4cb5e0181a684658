// SPDX-License-Identifier: Apache-2.0
// Windows tells a process in a thread of its own that it must end, so that no thread is interrupted.

#include <windows.h>

#include <atomic>
#include <cassert>
#include <cstring>
#include <memory>

#include "files/unfinished_files.h"
#include "files/wide_windows.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMostOfPath = 32768;  // of Windows

}  // namespace

// An element of a list that only grows, as in unfinished_files_posix.cpp.
struct UnfinishedFile::Entry {
    std::atomic<bool> taken{true};
    std::atomic<bool> exists{false};
    std::unique_ptr<wchar_t[]> path = std::make_unique<wchar_t[]>(kMostOfPath);
    Entry* next = nullptr;
};

struct UnfinishedFiles {
    using Entry = UnfinishedFile::Entry;

    // The number of sections that are running, and a bit that forbids new ones.
    static constexpr unsigned kClosed = 1u << 31;
    static inline std::atomic<unsigned> sections{0};
    static inline std::atomic<Entry*> first{nullptr};

    static Entry* take() {
        for (Entry* entry = first; entry != nullptr; entry = entry->next) {
            bool taken = false;
            if (entry->taken.compare_exchange_strong(taken, true)) return entry;
        }
        auto* made = new Entry;
        made->next = first;
        while (!first.compare_exchange_weak(made->next, made)) {
        }
        return made;
    }
};

NameSection::NameSection() {
    if ((UnfinishedFiles::sections.fetch_add(1) & UnfinishedFiles::kClosed) == 0) return;
    UnfinishedFiles::sections.fetch_sub(1);
    Sleep(INFINITE);  // another thread ends the process
}

NameSection::~NameSection() { UnfinishedFiles::sections.fetch_sub(1); }

UnfinishedFile::UnfinishedFile() : entry_(UnfinishedFiles::take()) {}

UnfinishedFile::~UnfinishedFile() {
    assert(!entry_->exists);
    entry_->taken = false;
}

// `folder` is not used: `name` is a whole path.
void UnfinishedFile::add(const NameSection&, int, const std::string& name) {
    const std::wstring path = system_path(name);
    if (path.empty() || path.size() >= kMostOfPath) return;
    std::memcpy(entry_->path.get(), path.c_str(), (path.size() + 1) * sizeof(wchar_t));
    entry_->exists = true;
}

void UnfinishedFile::remove(const NameSection&) { entry_->exists = false; }

void UnfinishedFile::remove_all() noexcept {
    if ((UnfinishedFiles::sections.fetch_or(UnfinishedFiles::kClosed) & UnfinishedFiles::kClosed) != 0) Sleep(INFINITE);
    while (UnfinishedFiles::sections != UnfinishedFiles::kClosed) Sleep(1);
    for (UnfinishedFiles::Entry* entry = UnfinishedFiles::first; entry != nullptr; entry = entry->next) {
        if (entry->exists) DeleteFileW(entry->path.get());
    }
}

}  // namespace tex::inline v1
