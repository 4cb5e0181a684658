// SPDX-License-Identifier: Apache-2.0
// repair-normals: undoes the damage that check-normals proves.

#include <algorithm>
#include <cstddef>
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
#include "options/normals.h"
#include "reports/repairs.h"
#include "tasks/name_pattern.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;

using Bytes = std::shared_ptr<const std::vector<std::byte>>;

constexpr std::size_t kMostBytes = std::size_t{1} << 40;  // of an input

class RepairNormals : public cli::Converter {
public:
    explicit RepairNormals(const cli::ProgramRow& row);

    [[nodiscard]] bool can_be_step() const override { return false; }

private:
    [[nodiscard]] Result<std::vector<cli::Task>> plan() const override {
        return dry_run_ ? Batch::plan() : Converter::plan();
    }
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules;
        rules.in_place = true;
        return rules;
    }
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    [[nodiscard]] Result<void> write(cli::Job& job, Texture source, Repaired repaired, const ReadOptions& read);
    [[nodiscard]] Result<void> copy(cli::Job& job, const std::vector<std::byte>& bytes);
    [[nodiscard]] Result<void> pack(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                    const CheckReport& report);
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override;

    [[nodiscard]] bool writes_to_output() const { return files.output == "-" && !dry_run_; }
    // The options that say how outputs are stored. Without them, files keep their format.
    [[nodiscard]] bool stores_otherwise() const {
        return !command
                    .given_of({"--format", "--container", "--y", "--metric", "--rdo-mean", "--dds-header", "--dds-mark",
                               "--supercompress", "--quality"})
                    .empty();
    }

    RepairOptions options_;
    bool dry_run_ = false;
    std::optional<cli::LengthIn> length_in_;
    std::mutex mutex_;
    cli::RepairTotals totals_;
};

RepairNormals::RepairNormals(const cli::ProgramRow& row) : Converter(row) {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR");
    command.usage("NORMALS... --dry-run");
    command.input("NORMALS...", "normal maps; - is standard input");
    command.finds_things();
    files.writes_nothing = [this] { return dry_run_; };
    files.add(command);
    command.group("Repairs");
    const auto rules_into = [](std::vector<std::string>& names) {
        return [&names](const std::string& text) {
            for (const std::string& name : cli::split(text, ',')) {
                if (find_rule(name) == nullptr)
                    throw cli::UsageError(fmt::format("there is no rule '{}'", cli::printable(name)));
                names.push_back(name);
            }
        };
    };
    command.flag(options_.likely, "--likely", "also undo faults that the texels do not prove beyond doubt")
        .often(3, "also undo faults that the texels do not prove");
    command
        .option("--only", "ID[,ID...]", "repair the faults of these rules alone (ids or names)",
                rules_into(options_.only))
        .repeatable = true;
    command.option("--skip", "ID[,ID...]", "leave the faults of these rules as they are", rules_into(options_.skip))
        .repeatable = true;
    command.flag(dry_run_, "--dry-run", "print what would be done, and write nothing")
        .often(4, "print what would be done, and write nothing");
    cli::Row& layout =
        command.option("--swizzle", "S", "which channels hold what: a word, or the channels of x, y and z, such as abg",
                       [this](const std::string& text) { options_.checks.swizzle = cli::parse_swizzle(text); });
    layout.words = cli::swizzle_words();
    layout.preset = "auto";
    layout.completes = cli::Completes::words;
    cli::add_length_in(command, length_in_);
    output.add(command, "as in the input if it fits, else " + cli::default_encodings(), "as in the input");
    running.add(command);
    command.check([this] {
        if (!dry_run_) return;
        for (const std::string& option : command.given_of({"--update", "--depfile"}))
            throw cli::UsageError(fmt::format("--dry-run and {} exclude each other", option));
    });
    command.example("repair-normals 'art/**/*_n.png' --out-dir mended", "Undoes what the texels prove.");
    command.example("repair-normals 'art/**/*_n.png' --dry-run", "What would be done, and by which angle.");
    command.example("repair-normals rock_n.dds -o rock_n.dds --y up --likely",
                    "Turns green over where it points down, in place.");
}

Result<void> RepairNormals::process(cli::Job& job) {
    if (is_model(job.task.input)) {
        return Error{ErrorCode::unsupported, job.task.input,
                     "is a model, and only pictures and textures are repaired: give its image"};
    }
    // Read once, so that what is copied is what was checked.
    ReadOptions read = job.read_options;
    if (!cli::is_special_file(job.task.input)) {
        const auto text = cli::read_text_file(job.task.input, kMostBytes);
        if (!text) return text.error();
        const auto* const first = reinterpret_cast<const std::byte*>(text->data());
        read.bytes = std::make_shared<const std::vector<std::byte>>(first, first + text->size());
    }
    auto texture = read_texture(job.task.input, read);
    if (!texture) return texture.error();
    if (!job.reached(0.2)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    RepairOptions options = options_;
    options.effort = output.effort;
    options.checks.require.y = output.y;
    options.checks.any_length = length_in_.has_value();
    auto repaired = repair(job.task.input, *texture, options, job.until(dry_run_ ? 1.0 : 0.7));
    if (!repaired) return repaired.error();
    const bool is_refused = repaired->has_errors();
    if (is_refused) job.raise(cli::ExitCode::findings);
    job.report.update(cli::repairs_json(*repaired));
    if (!writes_to_output()) job.say(cli::repairs_text(job.task.name(), *repaired));
    {
        const std::lock_guard lock(mutex_);
        totals_.add(*repaired);
    }
    if (dry_run_) return {};
    if (is_refused) {
        if (writes_to_output()) job.warn("an error is left, and nothing is written; --dry-run shows it");
        return {};
    }
    return write(job, std::move(*texture), std::move(*repaired), read);
}

Result<void> RepairNormals::write(cli::Job& job, Texture source, Repaired repaired, const ReadOptions& read) {
    const bool is_changed = repaired.texture.has_value();
    Texture texture = is_changed ? std::move(*repaired.texture) : std::move(source);
    const bool keeps = !stores_otherwise();
    const bool is_in_place = job.task.output == job.task.input;
    const bool is_file = read.bytes && !cli::has_level(job.task.output);
    if (keeps && !is_changed && is_in_place) return {};
    if (keeps && !is_changed && is_file && container_of(job.task.input) == job.task.container)
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
    if (auto written = write_file(job.task.output, bytes, output.write_options(job)); !written) return written;
    job.wrote(job.task.output);
    job.report["bytes"] = bytes.size();
    return {};
}

// Stores the map as pack-normals does.
Result<void> RepairNormals::pack(cli::Job& job, const Texture& texture, Bytes bytes_of_input,
                                 const CheckReport& report) {
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
    with.pack = [&](const SourceInfo& info) {
        SourceInfo own = info;
        own.format = texture.format;
        return output.pack_options(output.format.value_or(cli::encoding_of(own, job.task)), info.y_axis, info.y_known);
    };
    with.write = output.write_options(job);
    with.level_names = cli::level_names(job.task.output);
    const auto packed = pack_file(job.task.input, job.task.output, job.task.container, with, job.until(1.0));
    if (!packed) return packed.error();
    cli::wrote_levels(job, job.task.output, packed->levels);
    cli::report_texture(job, packed->extent, packed->levels, packed->pack, packed->bytes, packed->rdo);
    note_output(job, {packed->extent, packed->levels, false, packed->pack.encoding});
    return {};
}

cli::ExitCode RepairNormals::finish(cli::Console& console) {
    if (running.json || writes_to_output() || totals_.maps == 0) return cli::ExitCode::done;
    return console.print(totals_.text(dry_run_) + "\n");
}

const cli::Registered<RepairNormals> kRegistered(
    "repair-normals", "Repairs normal maps: undoes the damage that the rules of check-normals prove.");

}  // namespace
