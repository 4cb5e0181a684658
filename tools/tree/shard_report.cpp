// SPDX-License-Identifier: Apache-2.0

#include "tree/shard_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tree/json_line.h"

namespace tex::cli {
namespace {

Json output_json(const std::string& name, const OutputRecord& record) {
    Json files = Json::array();
    for (const auto& [file, digest] : record.files)
        files.push_back({{"file", name_json(file)}, {"sha256", digest.hex()}});
    Json json = {{"output", name_json(name)},
                 {"settings", record.settings.hex()},
                 {"inputs", record.inputs.hex()},
                 {"files", std::move(files)}};
    if (!record.warnings.empty()) json["warnings"] = name_json(warnings_text(record.warnings));
    return json;
}

bool is_made(const std::string& status) { return status == "made" || status == "cached" || status == "current"; }

ShardRecord read_record(const JsonLine& line) {
    ShardRecord record;
    record.input = line.name("input");
    const std::string status = line.text("status");
    record.is_made = is_made(status);
    if (!record.is_made) {
        record.reason = line.text("reason");
        if (status != "refused" && status != "failed") line.fail(fmt::format("\"status\": '{}' is unknown", status));
        // Another disk or machine may do better. All else would fail in the same way again.
        const std::string code = status == "failed" ? line.text("code") : std::string();
        record.may_succeed = code == "io" || code == "out-of-memory" || code == "cancelled";
        return record;
    }
    for (const JsonLine& output : line.objects("outputs")) {
        OutputRecord made{record.input, output.digest("settings"), output.digest("inputs"), {}};
        for (const JsonLine& file : output.objects("files"))
            made.files.emplace_back(file.name("file"), file.digest("sha256"));
        if (output.has("warnings")) made.warnings = parse_warnings(output.name("warnings"));
        record.outputs.emplace_back(output.name("output"), std::move(made));
    }
    return record;
}

}  // namespace

std::string shard_report_text(const FarmPlan& plan, int shard, int shards, const WorkList& work,
                              const std::vector<BuildResult>& results, const BuildState& state) {
    std::string text;
    std::size_t count = 0;
    for (std::size_t k = 0; k < results.size(); ++k) {
        const BuildResult& result = results[k];
        if (result.status.empty()) continue;
        ++count;
        Json line = {{"input", name_json(work.tasks[k].input)}, {"status", result.status}};
        if (result.error) {
            line["code"] = name_of(kErrorCodeNames, result.error->code);
            line["reason"] = printable(result.error->message());
        } else if (!is_made(result.status)) {
            line["reason"] = "does not pass the check of its rule";
        } else {
            Json outputs = Json::array();
            for (const std::string& output : work.tasks[k].outputs) {
                const auto record = state.outputs.find(output);
                if (record != state.outputs.end()) outputs.push_back(output_json(output, record->second));
            }
            line["outputs"] = std::move(outputs);
        }
        line["seconds"] = result.seconds;
        text += to_line(line);
    }
    const Json head = {{"report", 1},    {"tool", TEX_VERSION}, {"plan-sha256", plan.digest.hex()},
                       {"shard", shard}, {"shards", shards},    {"textures", count}};
    return to_line(head) + text;
}

ShardReport parse_shard_report(const std::string& path, std::string_view text) {
    std::vector<std::string> lines = split(text, '\n');
    if (lines.back().empty()) lines.pop_back();
    if (lines.empty()) throw UsageError(path + ": is empty");
    const JsonLine head(path, 1, lines.front());
    if (!head.has("report")) head.fail("is no report of a shard");
    if (head.number("report", 1, 1 << 20) != 1) head.fail("a later version of build-normals has written this report");
    ShardReport report;
    report.plan = head.digest("plan-sha256");
    report.shards = static_cast<int>(head.number("shards", 1, kMostShards));
    report.shard = static_cast<int>(head.number("shard", 1, report.shards));
    if (head.number("textures", 0, std::int64_t{1} << 52) != static_cast<std::int64_t>(lines.size()) - 1)
        head.fail(fmt::format("\"textures\" is not {}, the number of the lines that follow", lines.size() - 1));
    for (std::size_t k = 1; k < lines.size(); ++k)
        report.records.push_back(read_record(JsonLine(path, k + 1, lines[k])));
    return report;
}

}  // namespace tex::cli
