// SPDX-License-Identifier: Apache-2.0
// bake-normals: height maps to normal maps.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/extras.h"
#include "options/ground.h"
#include "options/heights.h"
#include "options/mips.h"
#include "options/sky.h"
#include "options/tiles.h"
#include "tasks/repeated_warnings.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;

class BakeNormals : public cli::Converter {
public:
    explicit BakeNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    template <class Report>
    void note_strength(cli::Job& job, const Report& done) const;
    template <class Report>
    void warn_of_flat(cli::Job& job, const Report& done) const;
    void warn_of_border(cli::Job& job, double ratio) const;
    void warn_of_reach(cli::Job& job, int reach) const;
    static void warn_of_steep(cli::Job& job, std::int64_t steep_texels, Extent extent, Encoding encoding);
    [[nodiscard]] cli::OutputRules rules() const override;
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    [[nodiscard]] BakeFileOptions options(cli::Job& job) const;
    // Maps beside the output are written by process().
    [[nodiscard]] std::optional<Step> step(cli::Job& job) override {
        return sky_.is_given() ? std::optional<Step>() : options(job);
    }
    void note(cli::Job& job, const StepsReport& done) override {
        reader_.note(job, done.heights);
        note_strength(job, done);
        warn_of_steep(job, done.steep_texels, done.extent, done.pack.encoding);
        warn_of_flat(job, done);
        warn_of_border(job, done.border_ratio);
    }
    [[nodiscard]] Result<void> accept(const cli::Job& job) const override { return reader_.accept(job); }
    void add_accept(Step& step, const cli::Job& job) const override {
        std::get<BakeFileOptions>(step).accept = [this, &job](const HeightReport& heights) {
            return heights.luma_texels > 0 ? reader_.accept(job) : Result<void>();
        };
    }
    [[nodiscard]] Error with_remedy(const Error& error) const override { return cli::HeightReader::with_remedy(error); }
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override;

    cli::HeightReader reader_;
    mutable cli::RepeatedWarnings walls_, hidden_;
    cli::WrapOptions wrap_;
    cli::KernelOption kernel_;
    cli::MipChainOptions mips_;
    cli::TileOptions tiles_;
    cli::ExtraOptions extras_;
    cli::SkyOptions sky_;
};

BakeNormals::BakeNormals(const cli::ProgramRow& row) : Converter(row) {
    command.usage("HEIGHT... -o FILE");
    command.usage("HEIGHT... --out-dir DIR [--name PATTERN]");
    command.input("HEIGHT...", "height maps; - is standard input");
    files.add(command);
    tiles_.add(command, files);
    reader_.strength.add(command, true);
    command.group("Heights and slopes");
    kernel_.add(command, "how slopes are measured");
    wrap_.add(command, "what lies beyond the border; two words set x and y separately");
    reader_.heights.add(command);
    reader_.color.add(command);
    output.add(command, cli::default_encodings(), "up");
    output.add_engines(command);
    extras_.add(command, output, nullptr);
    sky_.add(command, files);
    mips_.add(command, false, "all in dds and ktx2, else none");
    running.add(command);
    command.example("bake-normals bricks.png -o bricks.dds --bumpiness 8", "A DXT5nm texture with all its mip levels.");
    command.example("bake-normals bricks.png -o bricks_nh.png --format rgba8 --alpha height",
                    "Normals and heights in one file, for parallax mapping.");
    command.example("bake-normals bricks.png -o bricks.dds --occlusion-out bricks_ao.png",
                    "Normals and the ambient occlusion of the same surface.");
    command.example("bake-normals maps/*.png --out-dir out --kernel scharr --json", "A folder at once, with a report.");
    command.example("bake-normals rock.exr -o rock.ktx2 --format bc5 --height-range 0.15 --world-size 2 --y down",
                    "A rock face 2 m wide with 15 cm of relief, as BC5 for a renderer with green down.");
}

cli::OutputRules BakeNormals::rules() const {
    cli::OutputRules rules;
    rules.batch = Container::dds;
    rules.shared = reader_.color.files();
    rules.amend = [this](cli::Task& task) {
        cli::HeightReader::add_header_file(task);
        extras_.amend(task);
        sky_.amend(task);
    };
    if (files.tiles) rules.relate = [this](std::vector<cli::Task>& tasks) { tiles_.relate(tasks, wrap_); };
    return rules;
}

Result<void> BakeNormals::check(const std::vector<cli::Task>& tasks) {
    mips_.check(tasks);
    if (files.tiles && (reader_.strength.measured || reader_.heights.options.deband != Deband::off))
        throw cli::UsageError("--tiles contradicts --deband and --bumpiness auto, which look at whole pictures");
    sky_.check(command, extras_.has_occlusion());
    return reader_.color.check();
}

BakeFileOptions BakeNormals::options(cli::Job& job) const {
    BakeFileOptions options;
    options.read = reader_.heights.read_options(job);
    options.heights = reader_.heights.options;
    options.heights.wrap_x = wrap_.x;
    options.heights.wrap_y = wrap_.y;
    options.color = reader_.color.options();
    if (reader_.strength.is_given)
        options.strength = [this](Extent extent) { return reader_.strength.strength(extent); };
    options.auto_strength = reader_.strength.measured;
    options.vertical_scale = reader_.strength.vertical_scale;
    options.tile = tiles_.tile_of(job.task);
    options.bake = kernel_.bake;
    options.mip = mips_.options(mips_.levels_for(job.task), wrap_);
    extras_.apply(options.mip);
    options.others = extras_.inputs(job);
    sky_.apply(options, extras_.has_occlusion());
    constexpr bool kKnown = true;
    const cli::OutputOptions own = output.of(job.task.engine);
    options.pack = own.pack_options(own.format.value_or(default_encoding(job.task.container)), YAxis::up, kKnown);
    options.write = own.write_options(job);
    options.level_names = cli::level_names(job.task.output);
    options.slopes = running.json;
    return options;
}

Result<void> BakeNormals::process(cli::Job& job) {
    BakeFileOptions with = options(job);
    cli::JudgedColours judged;
    const auto accept_sky = [&] {
        if (job.task.input == "-") return Result<void>();  // is read once
        return sky_.accept(job, [&] { return probe(job.task.input, job.read_options); });
    };
    with.accept = [&](const HeightReport& heights) -> Result<void> {
        judged = reader_.judge(job, heights);
        if (judged.channel) return Error{ErrorCode::bad_data, job.task.input, judged.words};
        return accept_sky();
    };
    auto baked = bake_file(job.task.input, job.task.output, job.task.container, with, job.until(1.0));
    if (!baked && judged.channel) {
        with.heights.channel = *judged.channel;
        with.accept = [&](const HeightReport&) { return accept_sky(); };
        job.say(fmt::format("{}: --channel {}: R, G and B are the bytes of heights, as in map tiles\n",
                            cli::printable(job.task.input), name_of(kHeightChannelNames, *judged.channel)));
        baked = bake_file(job.task.input, job.task.output, job.task.container, with, job.until(1.0));
    }
    if (!baked) return with_remedy(baked.error());
    reader_.note(job, baked->heights, judged);
    cli::wrote_levels(job, job.task.output, baked->levels);
    cli::report_texture(job, baked->extent, baked->levels, with.pack, baked->bytes, baked->rdo);
    note_output(job, {baked->extent, baked->levels, baked->left_out > 0, with.pack.encoding});
    note_strength(job, *baked);
    if (baked->is_stated && job.task.output != "-")
        job.say(
            fmt::format("{}: --bumpiness {}, as the file states\n", cli::printable(job.task.input), baked->strength.x));
    warn_of_steep(job, baked->steep_texels, baked->extent, with.pack.encoding);
    warn_of_flat(job, *baked);
    const HeightChannel channel = with.heights.channel;
    const bool is_metres = channel == HeightChannel::terrain_rgb || channel == HeightChannel::terrarium;
    if (is_metres && !baked->is_stated && !baked->on_ground && !reader_.strength.is_given &&
        !reader_.strength.measured) {
        job.warn(
            "heights are metres, and nothing says how wide a texel is: 1 m is assumed; --height-range 1 --world-size W "
            "gives true slopes, where W is the width of the map in metres");
    }
    warn_of_border(job, baked->border_ratio);
    warn_of_reach(job, baked->occlusion_reach);
    const SlopeRange& slopes = baked->slopes;
    job.report["slopes"] = {{"x", {slopes.min_x, slopes.max_x}}, {"y", {slopes.min_y, slopes.max_y}}};
    MipOptions levels = mips_.options(mips_.levels.value_or(0), wrap_);  // averages, whatever the normals get
    levels.domain = MipDomain::vector;
    levels.fade.reset();
    return sky_.write(job, std::move(baked->occlusion), with.pack.y_axis, &levels);
}

void BakeNormals::warn_of_steep(cli::Job& job, std::int64_t steep_texels, Extent extent, Encoding encoding) {
    job.report["steep_texels"] = steep_texels;
    if (steep_texels == 0) return;
    const float steepest = steepest_slope(encoding);
    job.warn(fmt::format(
        "{} of {} texels are steeper than {} can hold, which stores all slopes above {:.{}f} alike; lower the strength "
        "or choose a deeper --format, and if cliffs surround texels without data, --no-data names their value",
        steep_texels, extent.texels(), name_of(kEncodingNames, encoding), steepest, steepest < 100.0f ? 1 : 0));
}

template <class Report>
void BakeNormals::note_strength(cli::Job& job, const Report& done) const {
    const cli::StrengthOptions& given = reader_.strength;
    job.report["bumpiness"] = {done.strength.x, done.strength.y};
    if (given.measured && job.task.output != "-")
        job.say(fmt::format("{}: --bumpiness auto is {}\n", job.task.input, done.strength.x));
    const Extent extent{done.extent.width << done.left_out, done.extent.height << done.left_out};
    const bool repeats = !command.given("--wrap") && !files.tiles;
    cli::note_ground(job, done.heights, {done.on_ground, given.given_name(), given.vertical_scale, extent, repeats});
}

// Slopes that nobody sees.
template <class Report>
void BakeNormals::warn_of_flat(cli::Job& job, const Report& done) const {
    constexpr double kDegrees = 57.295779513082320877;  // of a radian
    // Whoever tries one map without a strength cannot have meant faint bumps.
    const bool is_trial = !reader_.strength.is_given && !done.on_ground && command.inputs().size() == 1;
    const double faint = is_trial ? 12.0 : 5.0;
    const double degrees = kDegrees * std::atan(static_cast<double>(done.usual_slope));
    const bool is_asked_for = done.strength.x == 0.0f && done.strength.y == 0.0f;
    if (degrees >= faint || done.auto_strength == 0.0f || is_asked_for) return;  // 0: a placeholder
    const std::string remedy = done.on_ground
                                   ? fmt::format("--vertical-scale {} would make it 45", done.auto_strength)
                                   : fmt::format("--bumpiness auto would be --bumpiness {}", done.auto_strength);
    job.warn(fmt::format("nearly flat: 99 % of the slopes are below {:.2g} degrees, which shows little; {}",
                         std::max(0.01, degrees), remedy));
}

// A wall along the border, which nobody has asked for.
void BakeNormals::warn_of_border(cli::Job& job, double ratio) const {
    if (ratio <= cli::kWallRatio || command.given("--wrap") || files.tiles) return;
    walls_.add(job, job.task.input,
               "a wall along the border, steeper than anything inside: these heights do not repeat, but are baked as "
               "if they did; --wrap clamp ends them there (--wrap repeat silences this warning; in a manifest, wrap = "
               "\"clamp\" or \"repeat\")");
}

// Occlusion by what lies beyond the tiles around a tile.
void BakeNormals::warn_of_reach(cli::Job& job, int reach) const {
    if (reach == 0) return;
    job.report["occlusion_reach"] = reach;
    hidden_.add(job, job.task.input,
                fmt::format("occlusion is that of {} texels around the tile, the width of the tiles beside it: what is "
                            "farther away could hide more of the sky; --occlusion-distance lets it count less",
                            reach));
}

cli::ExitCode BakeNormals::finish(cli::Console& console) {
    reader_.warn_of_files(console);
    walls_.print(console);
    hidden_.print(console);
    return cli::ExitCode::done;
}

const cli::Registered<BakeNormals> kRegistered(
    "bake-normals",
    "Turns height maps into tangent-space normal maps: bakes the normals, builds the mip chain, packs and writes it.");

}  // namespace
