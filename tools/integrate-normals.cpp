// SPDX-License-Identifier: Apache-2.0
// integrate-normals: normal maps to height maps.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/sky.h"
#include "options/surface.h"
#include "tasks/name_pattern.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;

class IntegrateNormals : public cli::NormalsConverter {
public:
    explicit IntegrateNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] cli::OutputRules rules() const override;
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    void add_level();
    [[nodiscard]] Result<std::vector<Integration>> integrate_levels(cli::Job& job, const Source& source);
    [[nodiscard]] Result<void> write_heights(cli::Job& job, std::vector<Integration>& levels);

    cli::StrengthOptions strength_;
    cli::KernelOption kernel_;
    cli::WrapOptions wrap_;
    cli::StoredHeights stored_;
    cli::SurfaceMaps maps_;
    cli::SkyOptions sky_;
    std::optional<double> steepest_, least_response_;
    int level_ = 0;
    bool all_levels_ = false;
};

IntegrateNormals::IntegrateNormals(const cli::ProgramRow& row) : NormalsConverter(row) {
    command.usage("NORMALS... -o HEIGHT");
    command.usage("NORMALS... --out-dir DIR [--name PATTERN]");
    command.input("NORMALS...", "normal maps; - is standard input");
    files.add(command);
    normals.add(command, false, false);
    normals.unpack.keep_invalid = true;  // to tell unknown slopes from flat ones
    add_level();
    strength_.add(command);
    command.group("Slopes");
    kernel_.add(command, "how the map's slopes were measured");
    wrap_.add(command, "what lies beyond the border; two words set x and y separately");
    command
        .option("--steepest", "S", "slopes above S are unknown, and follow from the others",
                [this](const std::string& text) { steepest_ = cli::parse_double(text, kPositive); })
        .preset = "127 for 8 bits, 32767 for 16 bits, 1000000 for floats";
    command
        .option("--least-response", "R", "leave out what the kernel sees with less than R of a derivative's strength",
                [this](const std::string& text) {
                    least_response_ = cli::parse_double(text, {1e-6, 1.0});
                })
        .preset = "0.1 for 8 bits, else 0.001, or 0.003 for sobel5 and gaussian";
    stored_.add(command);
    command
        .choice(output.container, "--container", "TYPE", kContainerNames,
                "the file type, if the output's name does not say it (a pipe)")
        .preset = "by extension; png for -";
    maps_.add(command, files);
    sky_.add(command, files);
    running.add(command);
    command.example("integrate-normals rock_n.dds -o rock_h.png --uv-height 0.05", "Heights of 16 bits, 0 to 1.");
    command.example("integrate-normals rock_n.png -o rock_h.exr --curvature-out rock_c.png",
                    "Heights as floats, and the curvature of the surface.");
    command.example("integrate-normals rock_n.png -o rock_h.png --occlusion-out rock_ao.png",
                    "Heights, and the ambient occlusion of the surface.");
    command.example("integrate-normals *_n.png --out-dir heights --name '{stem:-_n}_h.png'", "A folder at once.");
    command.check([this] {
        if (strength_.bumpiness == 0.0f || strength_.height_range == 0.0 || strength_.uv_height == 0.0)
            throw cli::UsageError("a strength of 0 makes every height flat: no normals show them");
        if (!files.name.empty() && cli::NamePattern(files.name).uses("format"))
            throw cli::UsageError("--name", "{format} has no meaning for heights");
    });
}

void IntegrateNormals::add_level() {
    cli::Option& option =
        command.option("--level", "N", "the level to integrate, from 0, or all", [this](const std::string& text) {
            all_levels_ = text == "all";
            if (!all_levels_) level_ = cli::parse_int(text, 0, std::numeric_limits<int>::max());
        });
    option.words = {{"all", "every level, if the output can hold them"}};
    option.completes = cli::Completes::words;
    option.preset = fmt::format("{}", level_);
}

cli::OutputRules IntegrateNormals::rules() const {
    cli::OutputRules rules;
    rules.batch = Container::png;
    rules.standard_output = Container::png;
    rules.amend = [this](cli::Task& task) {
        maps_.amend(task);
        sky_.amend(task);
    };
    return rules;
}

Result<void> IntegrateNormals::check(const std::vector<cli::Task>& tasks) {
    sky_.check(command, false);
    for (const cli::Task& task : tasks) {
        std::ignore = stored_.format_in(task);
        if (!all_levels_ || can_hold_levels(task.container) || cli::has_level(task.output)) continue;
        throw cli::UsageError(cli::printable(task.output),
                              fmt::format("{} files hold one level; --level all needs --name with {{level}}",
                                          name_of(kContainerNames, task.container)));
    }
    return {};
}

Result<std::vector<Integration>> IntegrateNormals::integrate_levels(cli::Job& job, const Source& source) {
    const std::vector<NormalMap>& levels = source.chain.levels;
    const auto first = static_cast<std::size_t>(all_levels_ ? 0 : level_);
    if (first >= levels.size()) {
        return Error{ErrorCode::bad_option, job.task.input,
                     fmt::format("has no level {}, only {}", level_, levels.size())};
    }
    IntegrateOptions with = cli::integrate_options_for(source.info);
    with.bake = kernel_.bake;
    with.wrap_x = wrap_.x;
    with.wrap_y = wrap_.y;
    if (steepest_) with.least_z = static_cast<float>(1.0 / std::max(1.0, *steepest_));
    if (least_response_) with.least_response = static_cast<float>(*least_response_);
    std::vector<Integration> heights;
    for (std::size_t k = first; k < (all_levels_ ? levels.size() : first + 1); ++k) {
        const Strength strength = strength_.strength(levels[k].extent());
        const float weaker = std::min(std::abs(strength.x), std::abs(strength.y));
        const float stronger = std::max(std::abs(strength.x), std::abs(strength.y));
        if (weaker < 1e-20f || stronger > 1e20f)
            return Error{ErrorCode::bad_option, job.task.input, "the strength is too small or too large"};
        with.bumpiness_x = strength.x;
        with.bumpiness_y = strength.y;
        auto level = integrate(levels[k], with, job.until(k == first ? 0.8 : 0.85));
        if (!level) return level.error().of(job.task.input);
        heights.push_back(std::move(*level));
    }
    return heights;
}

Result<void> IntegrateNormals::write_heights(cli::Job& job, std::vector<Integration>& levels) {
    const Format format = stored_.format_in(job.task);
    const auto [low, high] = stored_.span_of(levels, format);
    const Integration& base = levels.front();
    const Extent extent = base.field.height.extent();
    const float rise = high > low ? high - low : 1.0f;
    const float bumpiness[] = {base.field.bumpiness_x * rise, base.field.bumpiness_y * rise};
    job.report["extent"] = {extent.width, extent.height};
    job.report["levels"] = levels.size();
    job.report["format"] = name_of(cli::kHeightFormatNames, format);
    job.report["heights"] = {
        {"highest", base.highest}, {"stored", {low, high}}, {"bumpiness", {bumpiness[0], bumpiness[1]}}};
    job.report["unknown_texels"] = base.unused_texels;
    RoughnessChain chain;
    for (Integration& level : levels) {
        if (low != 0.0f || high != 1.0f) stretch_heights(level.field.height, low, high, {job.threads(), {}});
        chain.levels.push_back(std::move(level.field.height));
    }
    auto texture = pack_roughness(chain, format, Effort::normal, job.until(0.9));
    if (!texture) return texture.error();
    texture->bumpiness_x = bumpiness[0];
    texture->bumpiness_y = bumpiness[1];
    chain.levels.clear();
    const auto written = cli::write_levels(job, std::move(*texture), job.write_options);
    if (!written) return written.error();
    if (cli::has_level(job.task.output)) job.report["output"] = job.outputs();
    job.report["bytes"] = written->bytes;
    if (job.task.output != "-" && bumpiness[0] == bumpiness[1])
        job.say(fmt::format("{}: bake-normals --bumpiness {} bakes the map back, but for {:.2f} degrees in the mean\n",
                            cli::printable(cli::written_name(job.task.output)), bumpiness[0], base.curl.mean));
    return {};
}

Result<void> IntegrateNormals::process(cli::Job& job) {
    const bool base_only = !all_levels_ && level_ == 0;
    auto source = normals.read(job, job.task.input, job.until(0.2), {base_only, false, {}, false, true});
    if (!source) return source.error();
    cli::report_input(job, source->info);
    auto levels = integrate_levels(job, *source);
    if (!levels) return levels.error();
    if (const std::int64_t unknown = levels->front().unused_texels; unknown > 0) {
        job.warn(
            fmt::format("{} of {} texels have no slope: they are too steep (--steepest) or not finite; theirs follow "
                        "from the others",
                        unknown, levels->front().field.height.extent().texels()));
    }
    const Extent extent = levels->front().field.height.extent();
    if (auto accepted = sky_.accept(job, [&] { return extent; }); !accepted) return accepted;
    OcclusionMaps hidden;  // of the heights as they are, which are stretched for their file
    if (sky_.is_given()) {
        auto maps = occlusion(levels->front().field, sky_.options(), kernel_.bake, job.until(0.88));
        if (!maps) return maps.error().of(job.task.input);
        hidden = std::move(*maps);
    }
    const std::size_t first = all_levels_ ? 0 : static_cast<std::size_t>(level_);
    if (auto done = write_heights(job, *levels); !done) return done;
    if (auto done = sky_.write(job, std::move(hidden), source->info.y_axis); !done) return done;
    if (auto done = maps_.write_curvature(job, source->chain.levels[first], wrap_, 0.95); !done) return done;
    return maps_.write_curl(job, levels->front(), 1.0);
}

const cli::Registered<IntegrateNormals> kRegistered(
    "integrate-normals",
    "Turns normal maps into height maps: the heights whose bake is nearest to the map, and what is left over.");

}  // namespace
