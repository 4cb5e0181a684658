// SPDX-License-Identifier: Apache-2.0
// json.h: JSON in the order in which it was filled, with floats as short as they can be read back.

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tex/result.h>
#include <nlohmann/json.hpp>

namespace tex::cli {

using Json =
    nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

// What --json prints about a failure. The file is named if it is not `input`: another input, or an output.
[[nodiscard]] inline Json error_json(const Error& error, const std::string& input) {
    Json json = {{"code", name_of(kErrorCodeNames, error.code)}, {"reason", error.reason}};
    if (!error.file.empty() && error.file != input) json["file"] = error.file;
    return json;
}

// One line, with its line feed. File names are bytes: what is not UTF-8 in them becomes U+FFFD.
[[nodiscard]] inline std::string to_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tex::cli
