// SPDX-License-Identifier: Apache-2.0
// unfinished_files.h: the names of files that are not whole yet, for remove_unfinished_files() (container.h).
//
// A handler may run on any thread, beside threads that create, rename and remove. What it removes must be a file of
// this process under the name that this process gave it: once a file has been renamed, another process may use its
// temporary name. So all that happens to such names happens in sections, during which
//
// * this thread handles no signal: a handler that waits for a section never waits for the thread that it has
// interrupted;
// * remove_all() waits; once it has begun, no section begins any more.
//
// It so finds exactly the names that exist, nothing moves under it, and nothing comes after it. It waits for calls of
// the file system and for nothing else, as sections neither take memory nor a lock, which the interrupted thread might
// hold.

#pragma once

#include <climits>
#include <csignal>
#include <string>

namespace tex {

class NameSection {
public:
    // Never returns once UnfinishedFile::remove_all() has begun: the process is about to end.
    NameSection();
    ~NameSection();
    NameSection(const NameSection&) = delete;
    NameSection& operator=(const NameSection&) = delete;

private:
    sigset_t before_{};
};

// Room for a name. It is taken before the section in which the file gets its name.
class UnfinishedFile {
public:
    UnfinishedFile();  // may throw std::bad_alloc
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    // The file `name` in `folder`, an open directory, is there. Precondition: at most NAME_MAX bytes.
    void add(const NameSection& section, int folder, const std::string& name);
    // It is not: it has been renamed or removed, or will be before the section ends.
    void remove(const NameSection& section);

    // remove_unfinished_files() (container.h).
    static void remove_all() noexcept;

private:
    struct Place;
    friend struct UnfinishedFiles;
    Place* place_;
};

}  // namespace tex
