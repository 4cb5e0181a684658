// SPDX-License-Identifier: Apache-2.0
// unfinished_files.h: the names of files that are not complete yet, for remove_unfinished_files() (container.h).
//
// A signal handler may run on any thread, while other threads create, rename and remove files. Every file that it
// removes must be a file of this process under the name that this process gave it: once a file has been renamed,
// another process may use its temporary name. Every change to such names therefore takes entry in a section, during
// which
//
// * this thread handles no signal: a handler that waits for a section never waits for the thread that it has
//   interrupted;
// * remove_all() waits; once it has begun, no further section begins.
//
// remove_all() therefore finds exactly the names that exist. They do not change while it runs, and no name is added
// after it. It waits only for calls of the file system: sections neither allocate memory nor take a lock, which the
// interrupted thread might hold.

#pragma once

#include <climits>
#include <cstddef>
#include <string>

namespace tex::inline v1 {

class NameSection {
public:
    // Never returns once UnfinishedFile::remove_all() has begun: the process is about to end.
    NameSection();
    ~NameSection();
    NameSection(const NameSection&) = delete;
    NameSection& operator=(const NameSection&) = delete;

private:
    struct Signals;  // which the thread let through before
    alignas(std::max_align_t) std::byte before_[128];
};

// Memory for a name. It is allocated before the section in which the file gets its name.
class UnfinishedFile {
public:
    UnfinishedFile();  // may throw std::bad_alloc
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    // Records that the file `name` exists in `folder`, an open directory. Precondition: at most NAME_MAX bytes.
    void add(const NameSection& section, int folder, const std::string& name);
    // Removes the record: the file has been renamed or removed, or will be before the section ends.
    void remove(const NameSection& section);

    // Implements remove_unfinished_files() (file.h).
    static void remove_all() noexcept;

private:
    struct Entry;
    friend struct UnfinishedFiles;
    Entry* entry_;
};

}  // namespace tex::inline v1
