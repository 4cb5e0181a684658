// SPDX-License-Identifier: Apache-2.0
// baseline.h: findings that a project has accepted.
//
// A JSON file to be kept beside the textures: {"version": 2, "findings": [{"file": "a.dds", "id": "N201", "level": 0,
// "content": "349680-5f3e..."}, ...]}, sorted, with one finding on each line. A finding is known by its rule, its
// level, and either its file or the file's content, so that neither an edit nor a rename revives it. Its figures may
// change. Files are relative to the folder of the baseline. Baselines of version 1 have no contents, and files as they
// were given.

#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <tex/check.h>

namespace tex::cli {

// The size of a regular file and a hash of its bytes; empty if it cannot be read, or only once. The hash tells apart
// the textures of a project; it is no protection from forgery.
[[nodiscard]] std::string content_of(const std::string& path);

class Baseline {
public:
    Baseline() = default;
    // An empty baseline that will be written to `path`.
    explicit Baseline(const std::string& path);

    // Errors: io, bad_data.
    [[nodiscard]] static Result<Baseline> read(const std::string& path);
    // Reads from memory. `path` appears in messages. Errors: bad_data.
    [[nodiscard]] static Result<Baseline> parse(const std::string& path, const std::string& text);

    // Adds the findings of the report to the known ones. `content` is that of its file, or empty; a file that is no
    // picture (CheckReport::error) is known by that alone, so that one that breaks later is not accepted.
    void add(const CheckReport& report, const std::string& content);
    // Removes known findings from the report, and returns them.
    [[nodiscard]] std::vector<Finding> accept(CheckReport& report, const std::string& content);
    [[nodiscard]] std::string text() const;

    // The findings that it lists, and those of them that are gone: accept() was called for their file, or there is no
    // such file, and nothing matched them.
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    [[nodiscard]] std::size_t gone() const;

private:
    using Key = std::tuple<std::string, std::string, int>;                 // file or content, id, level
    using Entry = std::tuple<std::string, std::string, int, std::string>;  // file, id, level, content

    [[nodiscard]] std::string name_of_file(const std::string& file) const;
    [[nodiscard]] std::string name_of(const CheckReport& report) const;
    void insert(const Entry& entry);

    std::filesystem::path folder_;  // that files are relative to; empty: files are as given
    std::set<Entry> entries_;
    std::set<Key> by_file_, by_content_;
    std::set<std::string> seen_;  // files
    std::set<Key> matched_;       // of both kinds
};

}  // namespace tex::cli
