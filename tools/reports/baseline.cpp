// SPDX-License-Identifier: Apache-2.0

#include "reports/baseline.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

int level_of(const Finding& finding) { return finding.regions.empty() ? 0 : finding.regions.front().level; }

// The absolute path without links being followed; the path itself if there is no working directory.
fs::path absolute_of(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    return (error ? path : absolute).lexically_normal();
}

// Content of a model's file, and the name of one of its maps.
std::string content_with_map(const CheckReport& report, const std::string& content) {
    return content.empty() || report.map.empty() ? content : content + " " + printable(report.map);
}

}  // namespace

std::string content_of(const std::string& path) {
    const auto status = status_of(path);
    if (!status || !status->is_regular()) return {};
    const ReadFile file = open_to_read(path);
    if (!file) return {};
    std::uint64_t hash = 0xcbf29ce484222325u, size = 0;  // FNV-1a
    std::vector<unsigned char> buffer(1 << 16);
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
        for (std::size_t k = 0; k < count; ++k) hash = (hash ^ buffer[k]) * 0x100000001b3u;
        size += count;
    }
    if (std::ferror(file.get()) != 0) return {};
    return fmt::format("{}-{:016x}", size, hash);
}

Baseline::Baseline(const std::string& path) : folder_(absolute_of(path).parent_path()) {}

// File names may contain any bytes; JSON's strings may not.
std::string Baseline::name_of_file(const std::string& file) const {
    if (folder_.empty()) return printable(fs::path(file).lexically_normal().generic_string());
    const fs::path absolute = absolute_of(file), relative = absolute.lexically_relative(folder_);
    return printable((relative.empty() ? absolute : relative).generic_string());
}

// The maps of a model are told apart by their names.
std::string Baseline::name_of(const CheckReport& report) const {
    return name_of_file(report.file) + (report.map.empty() ? "" : ": " + printable(report.map));
}

void Baseline::insert(const Entry& entry) {
    const auto& [file, id, level, content] = entry;
    entries_.insert(entry);
    by_file_.emplace(file, id, level);
    if (!content.empty()) by_content_.emplace(content, id, level);
}

Result<Baseline> Baseline::read(const std::string& path) {
    const auto text = read_text_file(path);
    if (!text) return text.error();
    return parse(path, *text);
}

Result<Baseline> Baseline::parse(const std::string& path, const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    const auto bad = [&](const char* reason) { return Error{ErrorCode::bad_data, path, reason}; };
    const bool known = json.is_object() && json.contains("version") && (json["version"] == 1 || json["version"] == 2);
    if (!known || !json.contains("findings") || !json["findings"].is_array()) {
        return bad("not a baseline that check-normals wrote");
    }
    Baseline baseline = json["version"] == 1 ? Baseline() : Baseline(path);
    for (const Json& item : json["findings"]) {
        const auto is_text = [&](const char* key) { return item.contains(key) && item[key].is_string(); };
        if (!item.is_object() || !is_text("file") || !is_text("id")) return bad("a finding without file or id");
        const bool has_level = item.contains("level") && item["level"].is_number_integer();
        const auto level = has_level ? item["level"].get<std::int64_t>() : 0;
        constexpr std::int64_t kMostLevels = 1000;
        if (level < 0 || level > kMostLevels) return bad("a finding on a level that no file has");
        baseline.insert({item["file"].get<std::string>(), item["id"].get<std::string>(), static_cast<int>(level),
                         is_text("content") ? item["content"].get<std::string>() : std::string()});
    }
    return baseline;
}

void Baseline::add(const CheckReport& report, const std::string& content) {
    if (report.error && content.empty()) return;
    for (const Finding& finding : report.findings)
        insert({name_of(report), std::string(finding.rule->id), level_of(finding), content_with_map(report, content)});
}

std::size_t Baseline::gone() const {
    const auto is_gone = [this](const Entry& entry) {
        const auto& [file, id, level, content] = entry;
        if (matched_.count({file, id, level}) > 0 || (!content.empty() && matched_.count({content, id, level}) > 0))
            return false;
        return seen_.count(file) > 0 || !status_of(slashed(folder_ / file.substr(0, file.find(": "))));
    };
    return static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), is_gone));
}

std::vector<Finding> Baseline::accept(CheckReport& report, const std::string& content) {
    const std::string file = name_of(report), with_map = content_with_map(report, content);
    seen_.insert(file);
    const auto is_known = [&](const Finding& finding) {
        const std::string id(finding.rule->id);
        const int level = level_of(finding);
        const bool by_file = !report.error && by_file_.count({file, id, level}) > 0,
                   by_content = by_content_.count({with_map, id, level}) > 0;
        if (by_file) matched_.emplace(file, id, level);
        if (by_content) matched_.emplace(with_map, id, level);
        return by_file || by_content;
    };
    const auto known = std::stable_partition(report.findings.begin(), report.findings.end(),
                                             [&](const Finding& finding) { return !is_known(finding); });
    std::vector<Finding> waived(std::make_move_iterator(known), std::make_move_iterator(report.findings.end()));
    report.findings.erase(known, report.findings.end());
    return waived;
}

std::string Baseline::text() const {
    std::string lines;
    for (const auto& [file, id, level, content] : entries_) {
        Json item;
        item["file"] = file;
        item["id"] = id;
        item["level"] = level;
        if (!content.empty()) item["content"] = content;
        lines += (lines.empty() ? "\n    " : ",\n    ") + item.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return "{\n  \"version\": 2,\n  \"findings\": [" + lines + (lines.empty() ? "" : "\n  ") + "]\n}\n";
}

}  // namespace tex::cli
