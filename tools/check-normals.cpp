// SPDX-License-Identifier: Apache-2.0
// check-normals: finds what is wrong with textures of normals.

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/rules.h"
#include "options/tangent_space.h"
#include "reports/check_documents.h"
#include "reports/findings.h"
#include "reports/github.h"

namespace {

using namespace tex;

class CheckNormals : public cli::Batch {
public:
    explicit CheckNormals(const cli::ProgramRow& row);
    [[nodiscard]] cli::ExitCode work(cli::Console& console) override;

private:
    [[nodiscard]] bool reads_nothing() const { return rules_.list() || rules_.explain() != nullptr; }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    [[nodiscard]] Result<CheckReport> check_one(cli::Job& job, CheckOptions checks, const Execution& execution);
    [[nodiscard]] Result<void> add_to_documents(cli::Job& job, const cli::JudgedReport& judged);
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override;

    cli::RuleOptions rules_;
    cli::TangentSpaceOptions mesh_;
    cli::CheckDocuments documents_;
    std::mutex mutex_;
    cli::CheckTotals totals_;
};

CheckNormals::CheckNormals(const cli::ProgramRow& row) : Batch(row) {
    command.usage("FILE...");
    command.usage("--list | --explain ID");
    command.input("FILE...", "textures and pictures of normals; - is standard input");
    command.finds_things();
    rules_.add(command);
    mesh_.add_input(command);
    documents_.add(command);
    command.check([this] {
        if (running.json && documents_.is_for_github())
            throw cli::UsageError("--json and --github contradict each other");
        if (!reads_nothing()) return;
        if (!command.inputs().empty()) throw cli::UsageError("--list and --explain take no files");
        if (documents_.has_page()) throw cli::UsageError("--list and --explain write no --report");
        if (mesh_.has_mesh()) throw cli::UsageError("--list and --explain take no --mesh");
    });
    files.add_inputs(command, [this] { return reads_nothing(); });
    running.add(command);
    command.example("check-normals --require format=dxt5nm --require mips=full --require y=up 'art/**/*_n.dds'",
                    "What a build requires of its normal maps.");
    command.example("check-normals --config checks.toml --sarif findings.sarif --junit findings.xml --files-from list",
                    "In continuous integration.");
    command.example("check-normals 'art/**/*_n.dds' --report report.html",
                    "A page with pictures, on which the light can be moved.");
    command.example("check-normals --baseline-write known.json old/*.dds",
                    "Accepts today's findings; --baseline known.json then reports only new ones.");
    command.example("check-normals bricks_n.png --height bricks_h.png",
                    "Whether a normal map was made from a height map.");
    command.example("check-normals rock_n.dds --mesh rock.glb --decoder unreal",
                    "Whether a map fits its mesh in an engine.");
}

cli::ExitCode CheckNormals::work(cli::Console& console) {
    if (rules_.list()) return console.print(cli::rules_text());
    if (rules_.explain() != nullptr) return console.print(cli::rule_text(*rules_.explain()));
    return Batch::work(console);
}

Result<void> CheckNormals::check(const std::vector<cli::Task>& tasks) {
    std::vector<std::string> inputs;
    inputs.reserve(tasks.size());
    for (const cli::Task& task : tasks) inputs.push_back(task.input);
    std::vector<cli::NamedFile> others = {
        {"--config", rules_.config()}, {"--height", rules_.height_file()}, {"--files-from", files.files_from}};
    if (mesh_.has_mesh()) {
        for (const std::string& file : mesh_.files()) others.push_back({"--mesh", file});
    }
    documents_.check(inputs, std::move(others));
    if (auto read = documents_.read(); !read) return read;
    if (mesh_.has_mesh()) {  // jobs share it; one error is enough
        if (const auto space = mesh_.input(0, running.read, {running.threads, {}}); !space) return space.error();
    }
    return rules_.read(command, tasks, running.read);
}

Result<CheckReport> CheckNormals::check_one(cli::Job& job, CheckOptions checks, const Execution& execution) {
    if (!mesh_.has_mesh()) return check_file(job.task.input, checks, job.read_options, execution);
    const auto space = mesh_.input(job.task.tile, job.read_options, {job.threads(), {}});
    if (!space) return space.error();
    mesh_.note(job, *space);
    const MeshToCheck mesh{space->selected(), space->decoder(), space->file()};
    checks.mesh = &mesh;
    return check_file(job.task.input, checks, job.read_options, execution);
}

Result<void> CheckNormals::process(cli::Job& job) {
    const Execution execution = job.until(documents_.has_page() ? 0.5 : 1.0);
    const cli::Demands& demands = rules_.demands_of(job.task.input);
    const auto start = std::chrono::steady_clock::now();
    auto report = check_one(job, demands.checks, execution);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (!report) return report.error();
    if (report->error && report->error->code == ErrorCode::cancelled) return *report->error;
    std::vector<Finding> waived = documents_.accept(*report);
    const auto known = static_cast<int>(waived.size());
    if (report->error) {
        if (report->findings.empty()) job.console.error(report->error->message());
        job.raise(cli::exit_code(report->error->code));
    }
    const bool fails = std::any_of(report->findings.begin(), report->findings.end(),
                                   [&](const Finding& finding) { return demands.fails(finding); });
    if (fails && !documents_.writes_baseline()) job.raise(cli::ExitCode::findings);
    const Requirements& require = demands.checks.require;
    job.say(documents_.is_for_github()
                ? cli::github_text(*report, require)
                : cli::findings_text(*report, require) + cli::pair_text(*report) + cli::seams_text(*report));
    job.report = cli::findings_json(*report, require);
    if (known > 0) job.report["known"] = known;
    {
        const std::lock_guard lock(mutex_);
        totals_.add(*report, known);
    }
    if (auto added =
            add_to_documents(job, {std::move(*report), require, demands.fail_on, std::move(waived), seconds.count()});
        !added)
        return added;
    return {};
}

Result<void> CheckNormals::add_to_documents(cli::Job& job, const cli::JudgedReport& judged) {
    const CheckReport& report = judged.report;
    if (!mesh_.has_mesh() || !report.y_on_mesh) return documents_.add(job, judged, nullptr);
    const auto space = mesh_.input(job.task.tile, job.read_options, {job.threads(), {}});
    if (!space) return space.error();
    const cli::MapOnMesh on_mesh{space->space(), *report.y_on_mesh, report.seams.has_value(), mesh_.input_arguments(),
                                 cli::shell_file(job.task.tile == 0 ? job.task.input : job.task.pattern)};
    return documents_.add(job, judged, &on_mesh);
}

cli::ExitCode CheckNormals::finish(cli::Console& console) {
    const std::string summary = totals_.text();
    const cli::ExitCode printed = running.json ? cli::ExitCode::done : console.print(summary + "\n");
    return std::max(printed, documents_.write(console, summary));
}

const cli::Registered<CheckNormals> kRegistered(
    "check-normals",
    "Checks normal maps: the file, the vectors, traces of damage, the direction of green, the mip levels.");

}  // namespace
