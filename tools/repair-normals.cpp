// SPDX-License-Identifier: Apache-2.0
// repair-normals: undoes the damage that check-normals proves.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "options/repairing.h"
#include "reports/repair_report.h"
#include "reports/repairs.h"
#include "tasks/folders.h"
#include "tasks/model_output.h"
#include "tasks/name_pattern.h"
#include "tasks/written_levels.h"
#include "tree/state.h"

namespace {

using namespace tex;
using Bytes = std::shared_ptr<const std::vector<std::byte>>;
using MapOfModel = std::shared_ptr<const cli::ModelInput>;

bool is_about_green(const Rule& rule) { return rule.family == RuleFamily::convention || rule.id == "N112"; }

const std::vector<std::string> kStorage = {"--format",     "--container", "--metric",        "--rdo-mean",
                                           "--dds-header", "--dds-mark",  "--supercompress", "--quality"};

class RepairNormals : public cli::Converter {
public:
    explicit RepairNormals(const cli::ProgramRow& row);

    [[nodiscard]] cli::ExitCode work(cli::Console& console) override {
        is_step_ = false;
        return Converter::work(console);
    }

private:
    [[nodiscard]] Result<std::vector<cli::Task>> plan() const override {
        return dry_run_ ? Batch::plan() : Converter::plan();
    }
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules;
        rules.in_place = true;
        rules.models = repairing_.material();
        rules.writes_models = true;
        rules.keeps_maps = true;
        if (!repairing_.height_file().empty())
            rules.amend = [this](cli::Task& task) { task.own.push_back(repairing_.height_file()); };
        return rules;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    [[nodiscard]] Result<void> process_file(cli::Job& job, cli::RepairTotals& totals);
    [[nodiscard]] Result<void> process_model(cli::Job& job, const cli::ModelOutput& model, cli::RepairTotals& totals);
    void report(cli::Job& job, const std::string& name, const Repaired& repaired, cli::RepairTotals& totals) const;
    [[nodiscard]] Result<Repaired> repair_in_model(cli::Job& job, const std::vector<MapOfModel>& maps,
                                                   const Texture& texture, const Execution& execution) const;
    [[nodiscard]] Result<void> write(cli::Job& job, Texture source, Repaired repaired, const ReadOptions& read);
    [[nodiscard]] Result<void> copy(cli::Job& job, const std::vector<std::byte>& bytes);
    [[nodiscard]] Result<PackFileOptions> packing(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                                  const CheckReport& report) const;
    [[nodiscard]] Result<void> pack(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                    const CheckReport& report);
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override;

    [[nodiscard]] bool writes_to_output() const { return files.output == "-" && !dry_run_; }
    // The options that say how outputs are stored. Without them, files keep their format.
    [[nodiscard]] bool stores_otherwise() const { return !command.given_of(kStorage).empty(); }

    cli::RepairingOptions repairing_;
    bool dry_run_ = false;
    bool is_step_ = true;  // of a manifest
    std::mutex mutex_;
    cli::RepairTotals totals_;
    cli::RepairReport report_;
};

RepairNormals::RepairNormals(const cli::ProgramRow& row) : Converter(row) {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR");
    command.usage("NORMALS... --dry-run");
    command.usage("MODEL -o MODEL");
    command.usage("NORMALS... --in-place");
    command.input("NORMALS...", "normal maps, glTF models with their maps, and folders of these; - is standard input");
    command.finds_things();
    files.writes_nothing = [this] { return dry_run_; };
    files.reads_folders = true;
    files.made_in = cli::files_made_by_builds;
    files.add(command);
    command.flag(files.in_place, "--in-place", "write each map that is repaired over its input")
        .often(4, "write each map over its input");
    command.flag(dry_run_, "--dry-run", "print what would be done, and write nothing")
        .often(5, "print what would be done, and write nothing");
    report_.add(command);
    repairing_.add(command);
    output.add(command, "as in the input if it fits, else " + cli::default_encodings(), "as in the input", true);
    running.add(command);
    command.check([this] {
        for (const std::string& option : command.given_of({"--update", "--depfile"}))
            if (dry_run_) throw cli::UsageError(fmt::format("--dry-run and {} exclude each other", option));
    });
    command.example("repair-normals art --out-dir mended", "Undoes what the texels prove in a whole folder.");
    command.example("repair-normals 'art/**/*_n.png' --dry-run --report plan.html",
                    "What would be done, and by which angle.");
    command.example("repair-normals scene.glb -o mended.glb", "The maps of a model, and nothing else of it.");
    command.example("repair-normals rock_n.dds -o rock_n.dds --y up --mirrored green",
                    "Turns green over where it points down, in place.");
}

Result<void> RepairNormals::check(const std::vector<cli::Task>& tasks) {
    const bool has_models = std::ranges::any_of(tasks, [](const cli::Task& task) { return is_model(task.input); });
    if (!repairing_.material().empty() && !has_models) throw cli::UsageError("--material needs a model");
    const bool writes_models =
        std::ranges::any_of(tasks, [](const auto& task) { return task.model_output != nullptr; });
    for (const std::string& option : command.given_of({"--update", "--depfile"})) {
        // Which files are beside a model depends on which of its maps change.
        if (writes_models) throw cli::UsageError(fmt::format("{} is not for models that are written", option));
    }
    report_.check(tasks, {{"--height", repairing_.height_file()}, {"--depfile", files.depfile}});
    if (repairing_.height_file().empty()) return {};
    if (tasks.size() != 1 || has_models) throw cli::UsageError("--height goes with a single file, which is no model");
    return repairing_.read_heights(running.read);
}

void RepairNormals::report(cli::Job& job, const std::string& name, const Repaired& repaired,
                           cli::RepairTotals& totals) const {
    totals.add(repaired);
    for (const FaultLeft& fault : repaired.left) {
        const Finding& left = fault.finding;
        if (left.severity != Severity::error) continue;
        job.raise(cli::ExitCode::findings,
                  fmt::format("cannot be repaired: {} {}{}", left.rule->id, left.message, cli::manifest_words(fault)));
        break;
    }
    // Between two of them, other steps took it as it was.
    const auto inversions = std::ranges::count_if(repaired.steps, [](const auto& s) { return s.rule->id == "N220"; });
    const bool is_in_model = job.task.model != nullptr;
    if (inversions % 2 == 1) job.warn(cli::inversion_words(is_in_model), is_in_model ? "" : name);
    const bool is_about_y =
        std::ranges::any_of(repaired.steps, [](const auto& step) { return is_about_green(*step.rule); });
    if (repairing_.names_mirrored() && !is_about_y && !repaired.after.y.y &&
        repaired.after.kind == PictureKind::normals) {
        job.warn(
            "which way green points does not show in it, so that --mirrored turns nothing over; pack-normals with "
            "--y-in and --y does",
            name);
    }
    if (!writes_to_output()) job.say(cli::repairs_text(name, repaired));
}

Result<void> RepairNormals::process(cli::Job& job) {
    cli::RepairTotals totals;
    auto done = process_file(job, totals);
    if (!done && report_.is_given()) report_.add_failure(job, done.error());
    const std::lock_guard lock(mutex_);
    if (done) totals_.add(totals);  // what could not be written counts nowhere
    return done;
}

Result<void> RepairNormals::process_file(cli::Job& job, cli::RepairTotals& totals) {
    if (job.task.model_output) return process_model(job, *job.task.model_output, totals);
    if (dry_run_ && is_model(job.task.input)) {
        const auto model = cli::maps_to_write(job.task.input, repairing_.material(), {job.read_options});
        return model ? process_model(job, *model, totals) : model.error();
    }
    // Read once, so that what is copied is what was checked.
    ReadOptions read = job.read_options;
    if (job.task.model) {
        if (auto opened = job.task.model->open(read); !opened) return opened;
    } else if (!cli::is_special_file(job.task.input)) {
        auto bytes = cli::read_binary_file(job.task.input);
        if (!bytes) return bytes.error();
        read.bytes = std::make_shared<const std::vector<std::byte>>(std::move(*bytes));
    }
    auto texture = read_texture(job.task.map_path(), read);
    if (!texture) return texture.error();
    if (!job.reached(0.2)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    const Execution execution = job.until(dry_run_ ? 1.0 : 0.7);
    auto repaired = job.task.model
                        ? repair_in_model(job, {job.task.model}, *texture, execution)
                        : repair(job.task.input, *texture, repairing_.options(output.y, output.effort), execution);
    if (!repaired) return repaired.error();
    job.report.update(cli::repairs_json(*repaired));
    if (job.task.in_folder && !repairing_.bakes() && cli::holds_no_normals(*repaired)) {
        totals.leave_out();
        job.report["state"] = "left-out";
        job.say(cli::left_out_text(job.task.name(), *repaired));
        return {};
    }
    report(job, job.task.name(), *repaired, totals);
    if (report_.is_given()) {
        const auto y = job.task.model ? output.y.value_or(YAxis::up) : output.y;
        if (auto added = report_.add(job, job.task.name(), *texture, *repaired, y); !added) return added;
    }
    if (dry_run_) return {};
    if (repaired->has_errors()) {
        if (writes_to_output()) job.warn("an error is left, and nothing is written; --dry-run shows it");
        return {};
    }
    return write(job, std::move(*texture), std::move(*repaired), read);
}

// glTF demands green up: a warning, as in check_map(), unless --y is given. What the model's tangents cancel is left.
Result<Repaired> RepairNormals::repair_in_model(cli::Job& job, const std::vector<MapOfModel>& maps,
                                                const Texture& texture, const Execution& execution) const {
    RepairOptions options = repairing_.options(output.y.value_or(YAxis::up), output.effort);
    if (!output.y) options.checks.severity.push_back({"N401", Severity::warning});
    auto repaired = repair(maps.front()->name(), texture, options, execution);
    using std::ranges::any_of;
    if (!repaired || (!any_of(repaired->steps, [](const auto& step) { return is_about_green(*step.rule); }) &&
                      !any_of(repaired->left, [](const auto& left) { return is_about_green(*left.finding.rule); })))
        return repaired;
    const auto model = maps.front()->read(cli::LastModel::Part::all, job.read_options);
    if (!model) return model.error();
    for (const MapOfModel& map : maps) {
        const auto report = check_map(**model, *map->map, {options.checks}, job.read_options, execution.quiet());
        if (!report) return report.error();
        if (!any_of(report->findings, [](const Finding& finding) { return finding.rule->id == "N707"; })) continue;
        for (const Rule& rule : tex::rules()) {
            if (is_about_green(rule)) options.skip.emplace_back(rule.id);
        }
        return repair(map->name(), texture, options, execution.quiet());
    }
    return repaired;
}

// The maps that change become PNG, and the others keep their bytes.
Result<void> RepairNormals::process_model(cli::Job& job, const cli::ModelOutput& model, cli::RepairTotals& totals) {
    ModelChanges changes;
    bool is_refused = false;
    for (std::size_t k = 0; k < model.images.size(); ++k) {
        const std::vector<MapOfModel>& maps = model.images[k];
        const Execution execution =
            job.until(0.9 * static_cast<double>(k + 1) / static_cast<double>(model.images.size()));
        ReadOptions read = job.read_options;
        if (auto opened = maps.front()->open(read); !opened) return opened;
        auto texture = read_texture(maps.front()->path, read);
        if (!texture) return texture.error();
        auto repaired = repair_in_model(job, maps, *texture, execution);
        if (!repaired) return repaired.error();
        report(job, maps.front()->name(), *repaired, totals);
        if (report_.is_given()) {
            const YAxis y = output.y.value_or(YAxis::up);
            if (auto added = report_.add(job, maps.front()->name(), *texture, *repaired, y); !added) return added;
        }
        is_refused = is_refused || repaired->has_errors();
        for (const MapOfModel& map : maps) {
            cli::Json line = cli::repairs_json(*repaired);
            map->report(line);
            job.report["maps"].push_back(std::move(line));
        }
        if (!repaired->texture || is_refused || dry_run_) continue;
        auto with = packing(job, *repaired->texture, nullptr, repaired->after);
        if (!with) return with.error();
        const auto bytes = std::make_shared<std::vector<std::byte>>();
        with->write.into = bytes;
        const auto packed =
            pack_file(maps.front()->path, maps.front()->name(), job.task.container, *with, {job.threads(), {}});
        if (!packed) return packed.error();
        ModelPicture& picture = changes.pictures.emplace_back();
        picture.container = job.task.container;
        for (const MapOfModel& map : maps) picture.maps.push_back(*map->map);
        picture.bytes = std::move(*bytes);
    }
    if (is_refused)
        job.warn(
            "no map of it is written, because an error is left in one; --skip with that rule leaves that map as it is");
    if (is_refused || dry_run_) return {};
    if (!job.reached(0.95)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    return cli::write_model_output(job, changes);
}

Result<void> RepairNormals::write(cli::Job& job, Texture source, Repaired repaired, const ReadOptions& read) {
    const bool is_changed = repaired.texture.has_value();
    Texture texture = is_changed ? std::move(*repaired.texture) : std::move(source);
    // The green of a map without faults points where --y wants it.
    const bool keeps = !stores_otherwise() && !(is_changed && output.y);
    const bool is_in_place = cli::is_same_name(job.task.output, job.task.input);
    const bool is_file = read.bytes && !cli::has_level(job.task.output);
    if (keeps && !is_changed && is_in_place) return {};
    if (keeps && !is_changed && is_file && container_of(job.task.map_path()) == job.task.container)
        return copy(job, *read.bytes);
    if (keeps && can_hold(job.task.container, texture.format)) {
        const auto written = cli::write_levels(job, std::move(texture), output.write_options(job));
        if (!written) return written.error();
        job.report["bytes"] = written->bytes;
        return {};
    }
    return pack(job, texture, is_changed ? nullptr : read.bytes, repaired.after);
}

// A map without faults stays as it is, with all that its file says.
Result<void> RepairNormals::copy(cli::Job& job, const std::vector<std::byte>& bytes) {
    auto written = write_file(job.task.output, bytes, output.write_options(job));
    if (!written) return written;
    job.wrote(job.task.output);
    job.report["bytes"] = bytes.size();
    return written;
}

// How a map is stored as pack-normals does it.
Result<PackFileOptions> RepairNormals::packing(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                               const CheckReport& report) const {
    PackFileOptions with;
    with.source.read = job.read_options;
    with.source.unpack.others = {true, true, false};
    with.source.unpack.swizzle = report.swizzle;
    with.keep_codes = true;
    // y is as the texels show; where they do not, nothing turns green over.
    if (output.y && !texture.y_known) with.source.unpack.y_axis = report.y.y.value_or(*output.y);
    with.source.read.bytes = std::move(bytes_of_input);
    if (!with.source.read.bytes) {
        auto bytes = encode_file(texture, Container::ktx2, {}, {job.threads(), {}});
        if (!bytes) return bytes.error();
        with.source.read.bytes = std::make_shared<const std::vector<std::byte>>(std::move(*bytes));
    }
    with.pack = [this, &job, format = texture.format](const SourceInfo& info) {
        SourceInfo own = info;
        own.format = format;
        return output.pack_options(output.format.value_or(cli::encoding_of(own, job.task)), info.y_axis, info.y_known);
    };
    with.write = output.write_options(job);
    return with;
}

Result<void> RepairNormals::pack(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                 const CheckReport& report) {
    auto with = packing(job, texture, std::move(bytes_of_input), report);
    if (!with) return with.error();
    with->level_names = cli::level_names(job.task.output);
    const auto packed = pack_file(job.task.map_path(), job.task.output, job.task.container, *with, job.until(1.0));
    if (!packed) return packed.error();
    cli::wrote_levels(job, job.task.output, packed->levels);
    cli::report_texture(job, packed->extent, packed->levels, packed->pack, packed->bytes, packed->rdo);
    note_output(job, {packed->extent, packed->levels, false, packed->pack.encoding});
    return {};
}

cli::ExitCode RepairNormals::finish(cli::Console& console) {
    const std::string summary = totals_.text(dry_run_) + files.left_out();
    const cli::ExitCode code = report_.write(console, summary);
    if (is_step_ || running.json || writes_to_output() || totals_.maps + totals_.left_out == 0) return code;
    return std::max(code, console.print(summary + "\n"));
}

const cli::Registered<RepairNormals> kRegistered(
    "repair-normals", "Repairs normal maps: undoes the damage that the rules of check-normals prove.");

}  // namespace
