// SPDX-License-Identifier: Apache-2.0

#include "cli/version.h"

#include <fmt/format.h>
#include <tbb/version.h>
#include <tex/tex.h>

#include "cli/json.h"

namespace tex::cli {
namespace {

constexpr const char* compiler() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "gcc " __VERSION__;
#endif
}

}  // namespace

std::string version_text(const Command& command) { return fmt::format("{} {}\n", command.name(), TEX_VERSION); }

std::string version_json(const Command& command) {
    Json json;
    json["program"] = command.name();
    json["version"] = TEX_VERSION;
    json["libtex"] = version();
    json["compiler"] = compiler();
#if defined(NDEBUG)
    json["assertions"] = false;
#else
    json["assertions"] = true;
#endif
    json["dependencies"]["fmt"] =
        fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
    json["dependencies"]["nlohmann-json"] =
        fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
    json["dependencies"]["onetbb"] = TBB_runtime_version();
    const Runtime runs = runtime();
    json["instruction_set"] = runs.instruction_set;
    for (const auto& [name, number] : runs.dependencies) json["dependencies"][name] = number;
    const auto reader = reader_info();
    if (!reader) {
        json["reader"]["error"] = reader.error().message();
    } else {
        json["dependencies"]["openimageio"] = reader->openimageio;
        json["reader"] = {{"program", reader->program},
                          {"landlock", reader->landlock},
                          {"files", reader->files_restricted ? "restricted" : "not restricted"},
                          {"system_calls", reader->calls_filtered ? "filtered" : "not filtered"}};
    }
    return to_report_line(json);
}

}  // namespace tex::cli
