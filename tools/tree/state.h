// SPDX-License-Identifier: Apache-2.0
// state.h: what the last run made, kept beside the manifest in .NAME.state. If it is lost or damaged, nothing is taken
// to be up to date; the contents of files decide everything.

#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "cli/json.h"
#include "tree/changes.h"
#include "tree/sha256.h"

namespace tex::cli {

// What stat() says about a file. While it stays the same, so do the contents: whoever writes a file changes its ctime,
// which no program can set.
struct FileStamp {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    std::int64_t size = 0;
    std::int64_t mtime = 0;  // this and ctime in nanoseconds
    std::int64_t ctime = 0;

    friend bool operator==(const FileStamp&, const FileStamp&) = default;
    // Nothing if there is no such file.
    [[nodiscard]] static std::optional<FileStamp> of(const std::string& path);
};

// The contents of a file when it had this stamp.
struct Memo {
    FileStamp stamp;
    Digest digest;
    bool is_used = false;  // in this run; others are forgotten
};

// An output as it was made.
struct OutputRecord {
    std::string input;
    Digest settings;
    Digest inputs;
    NamedDigests files;                      // several if each level has its own
    NamedDigests from = {};                  // what it was made from; `inputs` is their digest
    std::vector<FileWarning> warnings = {};  // of making it; said again as long as it stands

    friend bool operator==(const OutputRecord&, const OutputRecord&) = default;
};

// Paths are relative to the root.
struct BuildState {
    std::unordered_map<std::string, Memo> memos;
    std::map<std::string, OutputRecord> outputs;  // by the name that the recipe gives, which may hold kLevelMark
    std::map<Digest, NamedValues> settings;       // what OutputRecord::settings stands for, for people

    // The memos to write: a run that comes to its end has used all that it will need again.
    enum class Memos { used, all };
    [[nodiscard]] std::string text(Memos memos_of = Memos::used) const;
    // Returns an empty state if the text is damaged or of another version.
    [[nodiscard]] static BuildState parse(std::string_view text);
};

// Warnings as fields: tabs and line feeds in them are escaped. parse_warnings() returns none if the text is damaged.
[[nodiscard]] std::string warnings_text(const std::vector<FileWarning>& warnings);
[[nodiscard]] std::vector<FileWarning> parse_warnings(std::string_view text);

// The path of a file of the tree: `root` is empty or the folder that names are relative to.
[[nodiscard]] std::string path_from(const std::string& root, const std::string& name);

// Errors: io, also if it is no regular file.
[[nodiscard]] Result<Digest> digest_of_file(const std::string& path);

// The path of the state of what `file` describes: .NAME.state beside it.
[[nodiscard]] std::string state_beside(const std::string& file);

// The files, as paths, that builds whose states are in `folder` have made: outputs, while their inputs lie beside them.
[[nodiscard]] std::set<std::string> files_made_by_builds(const std::string& folder);

// Checks that a state may be written to `path`: nothing is there, or a file that begins as a state does, is empty or
// begins with zeros. Errors: io.
[[nodiscard]] Result<void> check_is_state(const std::string& path);

// The digests of files. Any thread may call any of these functions.
class Contents {
public:
    Contents(std::string root, std::unordered_map<std::string, Memo>& memos) : root_(std::move(root)), memos_(memos) {}

    [[nodiscard]] std::string path(const std::string& name) const { return path_from(root_, name); }
    [[nodiscard]] std::optional<FileStamp> stamp(const std::string& name) const { return FileStamp::of(path(name)); }

    // The digest of a file. Reads it only if its stamp is new. Errors: io, as the file's path.
    [[nodiscard]] Result<Digest> digest(const std::string& name);
    // Notes the digest of a file that this run has put there, and the stamp that it had then.
    void remember(const std::string& name, const FileStamp& stamp, const Digest& digest);
    // Keeps all other threads out while the memos are read.
    [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }
    // Whether a memo was added.
    [[nodiscard]] bool has_changed() const { return changed_; }

private:
    const std::string root_;
    std::mutex mutex_;
    std::unordered_map<std::string, Memo>& memos_;
    std::atomic<bool> changed_{false};
};

}  // namespace tex::cli
