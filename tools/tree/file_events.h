// SPDX-License-Identifier: Apache-2.0
// file_events.h: what happens to the files in some folders, as inotify reports it.

#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <tex/types.h>

namespace tex::cli {

enum class FileEventKind {
    saved,    // closed by a writer, or moved here
    created,  // a new name: of a file that somebody may still write, or of a link
    gone,     // removed, or moved away
    folder,   // a folder came or went
};

struct FileEvent {
    FileEventKind kind;
    std::string path;  // what add() says about the folder, and the file's name
};

class FileEvents {
public:
    FileEvents() = default;
    FileEvents(const FileEvents&) = delete;
    FileEvents& operator=(const FileEvents&) = delete;
    ~FileEvents();

    // To be called first. Errors: io (the system has no more instances of inotify).
    [[nodiscard]] Result<void> open();

    // Between begin() and end(), a new list of folders is made. Folders that are not on it are no longer watched; if
    // the list is not `complete`, the old folders stay.
    void begin() { new_names_.clear(); }
    // Watches `folder`, but not the folders in it. The paths of its events begin with `name`. A folder may be added
    // under several names. Returns false if there is no such folder, or if it cannot be read. Errors: io (the limit of
    // watched folders is reached).
    [[nodiscard]] Result<bool> add(const std::string& folder, const std::string& name);
    void end(bool complete);

    [[nodiscard]] std::size_t folders() const { return names_.size(); }

    // Waits for events at most `milliseconds`, or until a signal comes, and adds them to `events`. Returns false if
    // events were lost, because too many came.
    [[nodiscard]] bool wait(int milliseconds, std::vector<FileEvent>& events) const;

private:
    using Names = std::unordered_map<int, std::vector<std::string>>;  // by the number of a watch

    int fd_ = -1;
    Names names_, new_names_;
};

// Whether a file with a new name is complete: it is a link, or nobody has it open for writing.
[[nodiscard]] bool is_complete(const std::string& path);

}  // namespace tex::cli
