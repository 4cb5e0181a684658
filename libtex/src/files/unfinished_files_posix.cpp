// SPDX-License-Identifier: Apache-2.0

#include "files/unfinished_files.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cstring>
#include <new>

namespace tex::inline v1 {

// An element of a list that only grows, to the greatest number of files that existed at once. A thread that walks
// through the list needs no lock.
struct UnfinishedFile::Entry {
    std::atomic<bool> taken{true};
    std::atomic<bool> exists{false};  // whether the file exists; `folder` and `name` are then set
    int folder = -1;
    char name[NAME_MAX + 1] = {};
    Entry* next = nullptr;
};

struct UnfinishedFiles {
    using Entry = UnfinishedFile::Entry;

    // The number of sections that are running, and a bit that forbids new ones.
    static constexpr unsigned kClosed = 1u << 31;
    static inline std::atomic<unsigned> sections{0};
    static inline std::atomic<Entry*> first{nullptr};
    static_assert(std::atomic<unsigned>::is_always_lock_free && std::atomic<Entry*>::is_always_lock_free &&
                  std::atomic<bool>::is_always_lock_free);

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

namespace {

void block_signals(sigset_t* before) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, before);
}

// Waits until another thread ends the process.
[[noreturn]] void wait_for_the_end() {
    for (;;) pause();
}

}  // namespace

struct NameSection::Signals {
    sigset_t set;
};

NameSection::NameSection() {
    static_assert(sizeof(Signals) <= sizeof before_);
    block_signals(&(new (before_) Signals)->set);
    if ((UnfinishedFiles::sections.fetch_add(1) & UnfinishedFiles::kClosed) == 0) return;
    UnfinishedFiles::sections.fetch_sub(1);
    wait_for_the_end();
}

NameSection::~NameSection() {
    UnfinishedFiles::sections.fetch_sub(1);
    pthread_sigmask(SIG_SETMASK, &std::launder(reinterpret_cast<Signals*>(before_))->set, nullptr);
}

UnfinishedFile::UnfinishedFile() : entry_(UnfinishedFiles::take()) {}

UnfinishedFile::~UnfinishedFile() {
    assert(!entry_->exists);
    entry_->taken = false;
}

void UnfinishedFile::add(const NameSection&, int folder, const std::string& name) {
    assert(name.size() <= NAME_MAX);
    entry_->folder = folder;
    std::memcpy(entry_->name, name.c_str(), name.size() + 1);
    entry_->exists = true;
}

void UnfinishedFile::remove(const NameSection&) { entry_->exists = false; }

void UnfinishedFile::remove_all() noexcept {
    block_signals(nullptr);
    if ((UnfinishedFiles::sections.fetch_or(UnfinishedFiles::kClosed) & UnfinishedFiles::kClosed) != 0)
        wait_for_the_end();
    constexpr timespec kMoment{0, 100'000};
    while (UnfinishedFiles::sections != UnfinishedFiles::kClosed) nanosleep(&kMoment, nullptr);
    for (UnfinishedFiles::Entry* entry = UnfinishedFiles::first; entry != nullptr; entry = entry->next) {
        if (entry->exists) unlinkat(entry->folder, entry->name, 0);
    }
}

}  // namespace tex::inline v1
