// SPDX-License-Identifier: Apache-2.0
// placement.h: the moment in which the outputs of a texture replace the old ones.
//
// An output takes its place only if it is one that the manifest names, if nothing that it is made from has changed
// since it was read, and if its name still leads to no file that the run reads. What has taken its place is known with
// its digest, even if the rest fails.

#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <tex/file.h>

#include "tree/state.h"
#include "tree/tree_files.h"

namespace tex::cli {

// A file as it was when it took its place. The stamp is missing if another program has replaced it at once.
struct PlacedFile {
    Digest digest;
    std::optional<FileStamp> stamp;
};

class Placement {
public:
    // `outputs`: the paths of all files that may take their places, whatever options a command has. `is_unchanged` says
    // whether what they are made from is as it was when it was read.
    Placement(const TreeFiles& files, std::set<std::string> outputs, std::function<Result<bool>()> is_unchanged)
        : files_(files), outputs_(std::move(outputs)), is_unchanged_(std::move(is_unchanged)) {}

    // `write` for files of this placement, which must outlive it.
    [[nodiscard]] WriteOptions watched(WriteOptions write);

    // Whether nothing has taken its place because something has changed.
    [[nodiscard]] bool met_change() const { return met_change_; }
    // By path, as it was written.
    [[nodiscard]] const std::map<std::string, PlacedFile>& placed() const { return placed_; }

private:
    [[nodiscard]] Result<void> accept(const std::string& path, const std::string& complete);
    void note(const std::string& path);

    const TreeFiles& files_;
    const std::set<std::string> outputs_;
    const std::function<Result<bool>()> is_unchanged_;
    std::mutex mutex_;
    bool is_accepted_ = false;  // later changes do not count: the outputs go together
    bool met_change_ = false;
    std::map<std::string, PlacedFile> complete_, placed_;
};

}  // namespace tex::cli
