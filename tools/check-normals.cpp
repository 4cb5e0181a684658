// SPDX-License-Identifier: Apache-2.0
// check-normals: what is wrong with textures of normals.

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/collisions.h"
#include "cli/console.h"
#include "cli/stream.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "reports/baseline.h"
#include "reports/check_config.h"
#include "reports/findings.h"
#include "reports/html_report.h"
#include "reports/junit.h"
#include "reports/sarif.h"

namespace {

using namespace tex;

// Findings by severity, and files, for the last line.
struct Totals {
    int files = 0, unreadable = 0, known = 0;
    int by_severity[3] = {};
};

struct CheckNormals {
    cli::Command command{
        "check-normals",
        "Checks normal maps: the file, the vectors, traces of damage, the direction of green, the mip levels."};
    cli::FileOptions files;
    cli::RunOptions run;
    CheckOptions options;
    Severity fail_on = Severity::error;
    std::string config, baseline_path, baseline_written, sarif, junit, page_path, explain, height_path;
    std::vector<std::string> required_texts;  // those of the command line
    bool list = false;

    std::optional<cli::Baseline> baseline;
    cli::Baseline new_baseline;
    std::optional<HeightField> height;
    std::mutex mutex;
    cli::HtmlReport page{"check-normals", cli::check_columns()};
    cli::HtmlSizes sizes;                        // of the page's pictures
    std::map<std::string, CheckReport> reports;  // by file: the documents do not depend on which ended first
    Totals totals;

    CheckNormals();
    void add_rules();
    void add_documents();
    void check_documents(const std::vector<cli::Task>& tasks);
    Result<void> add_to_page(cli::Job& job, const CheckReport& report);
    Result<void> prepare(const std::vector<cli::Task>& tasks);
    Result<void> process(cli::Job& job);
    cli::ExitCode write_documents() const;
    std::string summary() const;
};

CheckNormals::CheckNormals() {
    command.usage("FILE...");
    command.usage("--list | --explain ID");
    command.input("FILE...", "textures and pictures of normals; - is standard input");
    command.finds_things();
    add_rules();
    add_documents();
    command.check([this] {
        if (!list && explain.empty()) return;
        if (!command.inputs().empty()) throw cli::UsageError("--list and --explain take no files");
        if (!page_path.empty()) throw cli::UsageError("--list and --explain write no --report");
    });
    files.add_inputs(command, [this] { return list || !explain.empty(); });
    run.add(command);
    command.example("check-normals --require format=dxt5nm --require mips=full --require y=up art/**/*_n.dds",
                    "What a build wants of its normal maps.");
    command.example("check-normals --config normals.toml --sarif findings.sarif --junit findings.xml --files-from list",
                    "In continuous integration.");
    command.example("check-normals art/**/*_n.dds --report report.html",
                    "A page with pictures, on which the light can be moved.");
    command.example("check-normals --baseline-write known.json old/*.dds",
                    "Accepts what is wrong today; --baseline known.json then tells what is new.");
    command.example("check-normals bricks_n.png --height bricks_h.png",
                    "Whether a normal map belongs to a height map.");
}

void CheckNormals::add_rules() {
    const auto rule_name = [](const std::string& name) {
        if (find_rule(name) != nullptr) return name;
        std::vector<std::string> names;
        for (const Rule& rule : rules()) names.emplace_back(rule.name);
        throw cli::UsageError(fmt::format("there is no rule '{}'{}", name, cli::did_you_mean(name, names)));
    };
    command.group("Rules");
    command
        .option("--require", "KEY[=VALUE]", "demand something of every file",
                [this](const std::string& text) {
                    if (auto added = add_requirement(options.require, text); !added)
                        throw cli::UsageError(added.error().reason);
                    required_texts.push_back(text);
                })
        .repeatable = true;
    command
        .option("--enable", "ID", "check a rule (id or name) that is off by default",
                [this, rule_name](const std::string& text) { options.enable.push_back(rule_name(text)); })
        .repeatable = true;
    command
        .option("--disable", "ID", "leave a rule out",
                [this, rule_name](const std::string& text) { options.disable.push_back(rule_name(text)); })
        .repeatable = true;
    command
        .option("--severity", "ID=SEVERITY", "take a rule as error, warning or note",
                [this, rule_name](const std::string& text) {
                    const auto [name, severity] = cli::cut(text, '=');
                    options.severity.emplace_back(rule_name(name), cli::parse_word(severity, kSeverityNames));
                })
        .repeatable = true;
    command.text(config, "--config", "FILE", "read requirements, rules and severities from a TOML file").completes =
        cli::Completes::files;
    command.choice(fail_on, "--fail-on", "SEVERITY", kSeverityNames,
                   "the least severity of a finding that makes the command fail (exit 1)");
    command
        .text(height_path, "--height", "FILE",
              "the height map that the (single) input was made from: check that it follows")
        .completes = cli::Completes::files;
    command.flag(list, "--list", "list all rules and end");
    command.option("--explain", "ID", "tell all about a rule and end",
                   [this, rule_name](const std::string& text) { explain = rule_name(text); });
}

void CheckNormals::add_documents() {
    command.group("Documents");
    command
        .text(page_path, "--report", "FILE",
              "write a page with the findings and pictures, on which the light can be moved")
        .completes = cli::Completes::files;
    command.text(sarif, "--sarif", "FILE", "write the findings as SARIF 2.1.0").completes = cli::Completes::files;
    command.text(junit, "--junit", "FILE", "write the findings as JUnit XML").completes = cli::Completes::files;
    command.text(baseline_path, "--baseline", "FILE", "accept the findings that this file lists").completes =
        cli::Completes::files;
    command
        .text(baseline_written, "--baseline-write", "FILE",
              "write such a file with all findings, and do not fail for them")
        .completes = cli::Completes::files;
}

Result<void> CheckNormals::prepare(const std::vector<cli::Task>& tasks) {
    if (!config.empty()) {
        auto read = cli::read_check_config(config);
        if (!read) return read.error();
        // The file's words come first, so that the command line's win.
        CheckOptions merged = read->options;
        for (const std::string& text : required_texts) (void)add_requirement(merged.require, text);
        const auto append = [](auto& list_of, const auto& more) {
            list_of.insert(list_of.end(), more.begin(), more.end());
        };
        append(merged.enable, options.enable);
        append(merged.severity, options.severity);
        // A rule may be called by its id in one place and by its name in the other.
        for (const std::string& name : options.enable) {
            std::erase_if(merged.disable,
                          [&](const std::string& other) { return find_rule(other) == find_rule(name); });
        }
        append(merged.disable, options.disable);
        options = std::move(merged);
        if (read->fail_on && !command.given("--fail-on")) fail_on = *read->fail_on;
    }
    if (!baseline_path.empty()) {
        auto read = cli::Baseline::read(baseline_path);
        if (!read) return read.error();
        baseline = std::move(*read);
    }
    if (height_path.empty()) return {};
    if (tasks.size() != 1) throw cli::UsageError("--height goes with a single file");
    const auto image = read_image(height_path, run.read);
    if (!image) return image.error();
    auto field = height_field(*image, {});
    if (!field) return Error{field.error().code, height_path, field.error().reason};
    height = std::move(*field);
    options.height = &*height;
    return {};
}

// Every document is a file of its own; only the baseline that is written may be the one that is read.
void CheckNormals::check_documents(const std::vector<cli::Task>& tasks) {
    std::vector<std::string> inputs;
    inputs.reserve(tasks.size());
    for (const cli::Task& task : tasks) inputs.push_back(task.input);
    std::vector<cli::NamedFile> others = {
        {"--config", config}, {"--height", height_path}, {"--files-from", files.files_from}};
    for (const cli::NamedFile& document : std::initializer_list<cli::NamedFile>{{"--baseline-write", baseline_written},
                                                                                {"--baseline", baseline_path},
                                                                                {"--report", page_path},
                                                                                {"--sarif", sarif},
                                                                                {"--junit", junit}}) {
        if (!document.path.empty() && document.option != "--baseline") cli::check_document(document, inputs, others);
        others.push_back(document);
    }
    if (!page_path.empty()) cli::check_read_twice("--report", inputs);
    sizes = cli::html_sizes(tasks.size());
}

Result<void> CheckNormals::add_to_page(cli::Job& job, const CheckReport& report) {
    for (const Finding& finding : report.findings) page.explain(*finding.rule);
    std::optional<cli::HtmlMap> map;
    if (!report.error) {
        const auto texture = read_texture(job.task.input, job.read_options);
        if (!texture) return texture.error();
        auto drawn = cli::draw_html_map(job.task.input, *texture, report.swizzle, sizes, job.until(1.0));
        // What holds no normals has findings, and no pictures.
        if (drawn)
            map = std::move(*drawn);
        else if (drawn.error().code != ErrorCode::bad_option)
            return drawn.error();
    }
    page.add(job.task.input, cli::check_entry(report, options.require, map ? &*map : nullptr));
    return {};
}

// What was fitted to the height map, whether or not that is a finding.
std::string pair_text(const CheckReport& report) {
    if (!report.pair) return {};
    const PairEvidence& pair = *report.pair;
    return fmt::format("{}: fits the height map with correlation {:.2f}, strength {:.2f}, y {}, offset {}, {}\n",
                       cli::printable(report.file), pair.correlation, pair.strength, name_of(kYAxisNames, pair.y),
                       pair.offset_x, pair.offset_y);
}

Result<void> CheckNormals::process(cli::Job& job) {
    auto report = check_file(job.task.input, options, job.read_options, job.until(page_path.empty() ? 1.0 : 0.5));
    if (!report) return report.error();
    if (report->error && report->error->code == ErrorCode::cancelled) return *report->error;
    if (!baseline_written.empty()) {
        const std::lock_guard lock(mutex);
        new_baseline.add(*report);  // with what --baseline accepts
    }
    const int known = baseline ? baseline->accept(*report) : 0;
    if (report->error) {
        if (report->findings.empty()) cli::print_error(report->error->message());
        job.raise(cli::exit_code(report->error->code));
    }
    const bool fails = std::any_of(report->findings.begin(), report->findings.end(),
                                   [&](const Finding& finding) { return finding.severity >= fail_on; });
    if (fails && baseline_written.empty()) job.raise(cli::ExitCode::findings);
    job.say(cli::findings_text(*report, options.require) + pair_text(*report));
    job.report = cli::findings_json(*report, options.require);
    if (known > 0) job.report["known"] = known;
    if (!page_path.empty()) {
        if (const auto added = add_to_page(job, *report); !added) return added.error();
    }

    const std::lock_guard lock(mutex);
    ++totals.files;
    totals.known += known;
    if (report->error) ++totals.unreadable;
    for (const Finding& finding : report->findings) ++totals.by_severity[static_cast<int>(finding.severity)];
    if (!sarif.empty() || !junit.empty()) reports.insert_or_assign(job.task.input, std::move(*report));
    return {};
}

cli::ExitCode CheckNormals::write_documents() const {
    std::vector<CheckReport> all;
    for (const auto& [file, report] : reports) all.push_back(report);
    cli::ExitCode code = cli::ExitCode::done;
    const auto write = [&](const std::string& path, const std::string& text) {
        if (path.empty()) return;
        const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
        const auto written = write_file(path, std::vector<std::byte>(bytes, bytes + text.size()));
        if (written) return;
        cli::print_error(written.error().message());
        code = std::max(code, cli::exit_code(written.error().code));
    };
    if (!sarif.empty()) write(sarif, cli::sarif_text(all, options.require));
    if (!junit.empty()) write(junit, cli::junit_text(all, options.require, fail_on));
    if (!page_path.empty()) write(page_path, page.page(summary()));
    if (!baseline_written.empty()) write(baseline_written, new_baseline.text());
    return code;
}

std::string CheckNormals::summary() const {
    const auto count = [](int n, const char* one) { return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s"); };
    std::string text = fmt::format("{}: {}, {}, {}", count(totals.files, "file"), count(totals.by_severity[2], "error"),
                                   count(totals.by_severity[1], "warning"), count(totals.by_severity[0], "note"));
    if (totals.unreadable > 0) text += fmt::format("; {} unreadable", totals.unreadable);
    if (totals.known > 0) text += fmt::format("; {} known and accepted", totals.known);
    return text;
}

cli::ExitCode run_command(CheckNormals& self) {
    if (self.list) return cli::print(cli::rules_text());
    if (!self.explain.empty()) return cli::print(cli::rule_text(*find_rule(self.explain)));
    cli::Steps steps;
    steps.check = [&](const std::vector<cli::Task>& tasks) {
        self.check_documents(tasks);
        return self.prepare(tasks);
    };
    steps.process = [&](cli::Job& job) { return self.process(job); };
    bool has_run = false;
    steps.finish = [&] { has_run = true; };
    cli::ExitCode code = cli::run_readers(self.command, self.files, self.run, steps);
    if (has_run) {
        if (!self.run.json) code = std::max(code, cli::print(self.summary() + "\n"));
        code = std::max(code, self.write_documents());
    }
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("check-normals", [&] {
        CheckNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        return run_command(self);
    });
}
