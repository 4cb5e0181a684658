// SPDX-License-Identifier: Apache-2.0

#include "reports/baseline.h"

#include <cstdint>
#include <filesystem>

#include "batch/text_file.h"
#include "cli/text.h"
#include "reports/json.h"

namespace tex::cli {

Baseline::Key Baseline::key_of(const CheckReport& report, const Finding& finding) {
    const int level = finding.regions.empty() ? 0 : finding.regions.front().level;
    // File names may contain any bytes; JSON's strings may not.
    return {printable(std::filesystem::path(report.file).lexically_normal().generic_string()),
            std::string(finding.rule->id), level};
}

Result<Baseline> Baseline::read(const std::string& path) {
    const auto text = read_text_file(path);
    if (!text) return text.error();
    return parse(path, *text);
}

Result<Baseline> Baseline::parse(const std::string& path, const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    const auto bad = [&](const char* reason) { return Error{ErrorCode::bad_data, path, reason}; };
    const bool known = json.is_object() && json.contains("version") && json["version"] == 1;
    if (!known || !json.contains("findings") || !json["findings"].is_array()) {
        return bad("not a baseline that check-normals wrote");
    }
    Baseline baseline;
    for (const Json& item : json["findings"]) {
        const bool whole = item.is_object() && item.contains("file") && item["file"].is_string() &&
                           item.contains("id") && item["id"].is_string();
        if (!whole) return bad("a finding without file or id");
        const bool has_level = item.contains("level") && item["level"].is_number_integer();
        const auto level = has_level ? item["level"].get<std::int64_t>() : 0;
        constexpr std::int64_t kMostLevels = 1000;
        if (level < 0 || level > kMostLevels) return bad("a finding on a level that no file has");
        baseline.known_.emplace(item["file"].get<std::string>(), item["id"].get<std::string>(),
                                static_cast<int>(level));
    }
    return baseline;
}

void Baseline::add(const CheckReport& report) {
    for (const Finding& finding : report.findings) known_.insert(key_of(report, finding));
}

int Baseline::accept(CheckReport& report) const {
    return static_cast<int>(std::erase_if(report.findings, [&](const Finding& finding) {
        return finding.rule->id != "N101" && known_.count(key_of(report, finding)) > 0;
    }));
}

std::string Baseline::text() const {
    std::string lines;
    for (const auto& [file, id, level] : known_) {
        Json item;
        item["file"] = file;
        item["id"] = id;
        item["level"] = level;
        lines += (lines.empty() ? "\n    " : ",\n    ") + item.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return "{\n  \"version\": 1,\n  \"findings\": [" + lines + (lines.empty() ? "" : "\n  ") + "]\n}\n";
}

}  // namespace tex::cli
