// SPDX-License-Identifier: Apache-2.0
// check-normals: finds what is wrong with textures of normals.

#include <algorithm>
#include <chrono>
#include <memory>
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
#include "reports/kinds.h"
#include "reports/model_fixes.h"
#include "tree/state.h"

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
    [[nodiscard]] Result<void> process_model(cli::Job& job);
    [[nodiscard]] Result<void> judge_damaged(cli::Job& job, const Error& error);
    [[nodiscard]] Result<CheckReport> check_one(cli::Job& job, CheckOptions checks, const Execution& execution);
    // Prints what the picture holds, and returns it as JSON.
    [[nodiscard]] Result<cli::Json> classify(cli::Job& job, CheckReport& report);
    // Prints a report and adds it to the documents, and returns it as JSON.
    [[nodiscard]] Result<cli::Json> judge(cli::Job& job, CheckReport report, double seconds, const cli::MapOnMesh* mesh,
                                          const cli::CheckDocuments::ReadTexture& read);
    [[nodiscard]] Result<cli::Json> judge_in_model(cli::Job& job, CheckReport report, double seconds,
                                                   const Model& model, const ModelMap& map);
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override;

    bool lists_y_ = false;
    std::vector<std::string> idle_rules_;
    cli::RuleOptions rules_;
    cli::TangentSpaceOptions mesh_;
    cli::CheckDocuments documents_;
    std::mutex mutex_;
    cli::CheckTotals totals_;
    bool classifies_ = false;
    cli::KindTotals kinds_;
};

CheckNormals::CheckNormals(const cli::ProgramRow& row) : Batch(row) {
    command.usage("FILE...");
    command.usage("--list | --explain ID");
    command.input("FILE...",
                  "textures and pictures of normals, glTF models with their maps, and folders of these; - is "
                  "standard input");
    command.finds_things();
    rules_.add(command);
    command.flag(classifies_, "--classify", "print what each picture holds: normals, heights, colours, ...")
        .often(2, "print what each picture holds");
    command.flag(lists_y_, "--list-y", "print which way green points in each map (--classify: a table)");
    mesh_.add_input(command);
    documents_.add(command);
    command.check([this] {
        if (running.json && documents_.is_for_github())
            throw cli::UsageError("--json and --github contradict each other");
        if (classifies_ && (documents_.are_written() || documents_.is_for_github()))
            throw cli::UsageError("--classify judges nothing: it goes without --report, --sarif, --baseline ...");
        if (!reads_nothing()) return;
        if (!command.inputs().empty()) throw cli::UsageError("--list and --explain take no files");
        if (documents_.has_page()) throw cli::UsageError("--list and --explain write no --report");
        if (mesh_.has_mesh()) throw cli::UsageError("--list and --explain take no --mesh");
    });
    files.reads_folders = true;
    files.made_in = cli::files_made_by_builds;
    files.add_inputs(command, [this] { return reads_nothing(); });
    running.add(command);
    command.example("check-normals --require mips=full --require y=up 'art/**/*_n.dds'",
                    "What a build requires of its normal maps.");
    command.example("check-normals 'art/**/*_n.dds' --report report.html",
                    "A page with pictures, on which the light can be moved.");
    command.example("check-normals bricks_n.png --height bricks_h.png",
                    "Whether a normal map was made from a height map.");
    command.example("check-normals bricks_n.png --occlusion bricks_ao.png", "Whether an occlusion map belongs to it.");
    command.example("check-normals --config checks.toml --sarif findings.sarif --junit findings.xml --files-from list",
                    "In continuous integration.");
    command.example("check-normals --baseline-write known.json old/*.dds",
                    "Accepts today's findings; --baseline known.json then reports only new ones.");
    command.example("check-normals rock_n.dds --mesh rock.glb --decoder unreal",
                    "Whether a map fits its mesh in an engine.");
    command.example("check-normals 'models/**/*.glb' --report models.html",
                    "Every normal map that the materials of models use, each on its mesh.");
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
    const auto model =
        std::find_if(inputs.begin(), inputs.end(), [](const std::string& name) { return is_model(name); });
    mesh_.check_models(command, {model == inputs.end() ? std::string() : *model, true});
    std::vector<cli::NamedFile> others = files.lists(), beside;
    others.push_back({"--config", rules_.config()});
    others.push_back({"--height", rules_.height_file()});
    others.push_back({"--occlusion", rules_.occlusion_file()});
    if (mesh_.has_mesh()) {
        for (const std::string& file : mesh_.files()) others.push_back({"--mesh", file});
    } else if (documents_.are_written()) {
        for (const std::string& input : inputs) {
            for (std::string& file : cli::files_beside_model(input, {running.read}))
                beside.push_back({cli::printable(input), std::move(file)});
        }
    }
    documents_.check(inputs, std::move(others), beside);
    if (auto read = documents_.read(); !read) return read;
    if (mesh_.has_mesh()) {  // jobs share it; one error is enough
        if (const auto space = mesh_.input(0, running.read, {running.threads, {}}); !space) return space.error();
    }
    auto done = rules_.read(command, tasks, running.read);
    if (done) idle_rules_ = rules_.idle_rules(tasks);
    return done;
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

Result<cli::Json> CheckNormals::judge(cli::Job& job, CheckReport report, double seconds, const cli::MapOnMesh* mesh,
                                      const cli::CheckDocuments::ReadTexture& read) {
    if (classifies_) return classify(job, report);
    const cli::Demands& demands = rules_.demands_of(job.task.input);
    std::vector<Finding> waived = documents_.accept(report);
    const auto known = static_cast<int>(waived.size());
    // A file whose damage the baseline knows, or will, is no failure of this run.
    const bool is_known = known > 0 || (documents_.writes_baseline() && !report.findings.empty());
    if (report.error && !is_known) {
        if (report.findings.empty())
            job.console.error(report.map.empty() ? report.error->message()
                                                 : cli::title_of(report) + ": " + report.error->reason);
        job.raise(cli::exit_code(report.error->code));
    }
    const bool fails = std::any_of(report.findings.begin(), report.findings.end(),
                                   [&](const Finding& finding) { return demands.fails(finding); });
    if (fails && !documents_.writes_baseline()) job.raise(cli::ExitCode::findings);
    const Requirements& require = demands.checks.require;
    job.say(documents_.is_for_github()
                ? (is_known && report.findings.empty() ? std::string() : cli::github_text(report, require))
                : cli::findings_text(report, require) + (lists_y_ ? cli::y_text(report) : "") + cli::pair_text(report) +
                      cli::occlusion_text(report) + cli::seams_text(report));
    cli::Json json = cli::findings_json(report, require);
    if (known > 0) json["known"] = known;
    {
        const std::lock_guard lock(mutex_);
        totals_.add(report, known);
        totals_.fails = totals_.fails || fails;
    }
    const cli::JudgedReport judged{std::move(report),      require, demands.fail_on,
                                   std::move(waived),      seconds, demands.checks.occlusion,
                                   rules_.occlusion_file()};
    if (auto added = documents_.add(job, judged, mesh, read); !added) return added.error();
    return json;
}

Result<cli::Json> CheckNormals::classify(cli::Job& job, CheckReport& report) {
    if (report.error) {
        job.console.error(report.error->message());
        job.raise(cli::exit_code(report.error->code));
    }
    report.findings.clear();
    job.say(cli::kind_text(report));
    const std::lock_guard lock(mutex_);
    kinds_.add(report);
    return cli::findings_json(report, {});
}

Result<void> CheckNormals::process(cli::Job& job) {
    if (!mesh_.has_mesh() && is_model(job.task.input)) return process_model(job);
    const Execution execution = job.until(documents_.has_page() ? 0.5 : 1.0);
    const auto start = std::chrono::steady_clock::now();
    CheckOptions checks = rules_.demands_of(job.task.input).checks;
    checks.marks = documents_.marks();
    auto report = check_one(job, std::move(checks), execution);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (!report) return report.error();
    if (report->error && report->error->code == ErrorCode::cancelled) return *report->error;
    const auto finish = [&](const cli::MapOnMesh* on_mesh) -> Result<void> {
        const auto read = [&] { return read_texture(job.task.input, job.read_options); };
        auto json = judge(job, std::move(*report), seconds.count(), on_mesh, read);
        if (!json) return json.error();
        job.report = std::move(*json);
        const std::lock_guard lock(mutex_);
        ++totals_.files;
        return {};
    };
    if (!mesh_.has_mesh() || !report->y_on_mesh) return finish(nullptr);
    const auto space = mesh_.input(job.task.tile, job.read_options, {job.threads(), {}});
    if (!space) return space.error();
    const cli::MapOnMesh on_mesh{space->space(), *report->y_on_mesh, report->seams.has_value(), mesh_.input_arguments(),
                                 cli::shell_file(job.task.tile == 0 ? job.task.input : job.task.pattern)};
    return finish(&on_mesh);
}

// A model is in memory once, and its maps are one after the other.
Result<void> CheckNormals::process_model(cli::Job& job) {
    const MeshReadOptions how{job.read_options};
    const auto model = read_model(job.task.input, how);
    if (!model) return judge_damaged(job, model.error());
    for (const std::string& remark : model->mesh.remarks) job.warn(remark);
    if (const auto files = mesh_files(job.task.input, how)) {
        for (const std::string& file : *files) documents_.depends_on(file);
    }
    const auto maps = maps_of(*model, mesh_.material());
    if (!maps) return maps.error();
    if (maps->empty() && !documents_.is_for_github())
        job.say(fmt::format("{}: no material uses a normal map\n", cli::printable(job.task.input)));
    job.report["maps"] = cli::Json::array();
    job.report["findings"] = cli::Json::array();
    ModelCheckOptions options{rules_.demands_of(job.task.input).checks, {}, mesh_.decoder(), mesh_.tangents()};
    options.checks.marks = documents_.marks();
    cli::ModelFixes fixes;
    for (std::size_t k = 0; k < maps->size(); ++k) {
        const ModelMap& map = (*maps)[k];
        const double share = (static_cast<double>(k) + 1.0) / static_cast<double>(maps->size());
        const auto start = std::chrono::steady_clock::now();
        auto report = check_map(*model, map, options, job.read_options, job.until(share));
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (!report) return report.error();
        if (report->error && report->error->code == ErrorCode::cancelled) return *report->error;
        const std::string material = report->material;
        auto json = judge_in_model(job, std::move(*report), seconds.count(), *model, map);
        if (!json) return json.error();
        for (cli::Json& finding : (*json)["findings"]) {
            if (const auto fix = finding.find("fix"); fix != finding.end())
                fixes.add(fix->get<std::string>(), material);
            finding["map"] = (*json)["map"];
            job.report["findings"].push_back(std::move(finding));
        }
        json->erase("findings");
        job.report["maps"].push_back(std::move(*json));
    }
    if (!documents_.is_for_github()) job.say(fixes.text(job.task.input));
    const std::lock_guard lock(mutex_);
    ++totals_.files;
    return {};
}

// A model that cannot be read has the finding of a damaged picture, so that baselines can know it, and documents name
// it.
Result<void> CheckNormals::judge_damaged(cli::Job& job, const Error& error) {
    auto report = check_file(job.task.input, rules_.demands_of(job.task.input).checks, job.read_options);
    if (!report) return report.error();
    const bool is_damaged = error.code == ErrorCode::bad_data || error.code == ErrorCode::unsupported;
    if (!is_damaged || !report->error) return error;
    for (Finding& finding : report->findings) finding.message = error.reason;
    report->error = error;
    auto json = judge(job, std::move(*report), 0.0, nullptr, [&]() -> Result<Texture> { return error; });
    if (!json) return json.error();
    job.report = std::move(*json);
    const std::lock_guard lock(mutex_);
    ++totals_.files;
    return {};
}

Result<cli::Json> CheckNormals::judge_in_model(cli::Job& job, CheckReport report, double seconds, const Model& model,
                                               const ModelMap& map) {
    const auto& materials = model.mesh.materials;
    const ModelImage* const image = map.image < 0 ? nullptr : &model.images[static_cast<std::size_t>(map.image)];
    if (image != nullptr && !image->file.empty()) documents_.depends_on(image->file);
    const auto finish = [&](const cli::MapOnMesh* on_mesh) -> Result<cli::Json> {
        const auto read = [&] { return read_map(model, map, job.read_options); };
        auto json = judge(job, std::move(report), seconds, on_mesh, read);
        if (!json) return json;
        (*json)["material"] = materials[static_cast<std::size_t>(map.material)].name;
        (*json)["material_number"] = map.material;
        (*json)["slot"] = name_of(kNormalSlotNames, map.slot);
        (*json)["image"] = image == nullptr ? cli::Json() : cli::Json(image->file.empty() ? image->name : image->file);
        (*json)["uv_set"] = map.uv_set;
        (*json)["scale"] = map.scale;
        return json;
    };
    if (!documents_.has_page() || !report.y_on_mesh) return finish(nullptr);
    MeshSelection selection = selection_of(model, map);
    selection.tangents = mesh_.tangents();
    auto selected = select_part(model.mesh, selection, {job.threads(), {}});
    if (!selected) return selected.error().of(model.file);
    const cli::MeshSpace space(std::make_shared<const SelectedPart>(std::move(*selected)), mesh_.decoder(), model.file);
    const std::string arguments =
        fmt::format("--mesh {} --material {}", cli::shell_file(model.file), cli::shell_word(selection.material));
    const cli::MapOnMesh on_mesh{space.space(), *report.y_on_mesh, report.seams.has_value(), arguments,
                                 image->file.empty() ? "IMAGE" : cli::shell_file(image->file)};
    return finish(&on_mesh);
}

cli::ExitCode CheckNormals::finish(cli::Console& console) {
    for (const std::string& sentence : idle_rules_) console.warning(sentence);
    totals_.left_out = files.left_out();
    const std::string summary = classifies_ ? kinds_.text() : totals_.text();
    const cli::ExitCode printed = running.json ? cli::ExitCode::done : console.print(summary + "\n");
    return std::max(printed, documents_.write(console, summary));
}

const cli::Registered<CheckNormals> kRegistered(
    "check-normals",
    "Checks normal maps: the file, the vectors, traces of damage, the direction of green, the mip levels.");

}  // namespace
