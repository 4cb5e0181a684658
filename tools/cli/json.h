// SPDX-License-Identifier: Apache-2.0
// json.h: JSON that keeps the order of insertion, and writes floats in their shortest exact form.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <tex/types.h>
#include <nlohmann/json.hpp>

namespace tex::cli {

using Json =
    nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

// A warning about a file.
struct FileWarning {
    std::string file;
    std::string message;
    bool is_counted = false;  // printed once for all files that call for it

    friend bool operator==(const FileWarning&, const FileWarning&) = default;
};

// Adds warnings that are not there yet: two flows may have read the same files.
inline void add_new(std::vector<FileWarning>&& more, std::vector<FileWarning>& all) {
    for (FileWarning& warning : more) {
        if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(std::move(warning));
    }
}

// Warnings as --json prints them, with --quiet too.
[[nodiscard]] inline Json warnings_json(const std::vector<FileWarning>& warnings) {
    Json json = Json::array();
    for (const FileWarning& warning : warnings) json.push_back({{"file", warning.file}, {"message", warning.message}});
    return json;
}

using Clock = std::chrono::steady_clock;

// The wall-clock time since `start`. It is the only figure that differs from run to run, so it ends its line.
[[nodiscard]] inline float seconds_since(Clock::time_point start) {
    const auto passed = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start);
    return static_cast<float>(static_cast<double>(passed.count()) * 1e-6);
}

// The failure as --json prints it. The file is named if it is not `input`, but another input or an output.
[[nodiscard]] inline Json error_json(const Error& error, const std::string& input) {
    Json json = {{"code", name_of(kErrorCodeNames, error.code)}, {"reason", error.reason}};
    if (!error.file.empty() && error.file != input) json["file"] = error.file;
    return json;
}

// The schema of what --json prints: normal-maps-stability(7) says when it grows.
inline constexpr int kJsonSchema = 1;

// One line, including its line feed. File names are bytes; bytes in them that are not UTF-8 become U+FFFD.
[[nodiscard]] inline std::string to_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// A line of --json, with the schema as its first key.
[[nodiscard]] inline std::string to_report_line(const Json& json) {
    Json line = {{"schema", kJsonSchema}};
    line.update(json);
    return to_line(line);
}

}  // namespace tex::cli
