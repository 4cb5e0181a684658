// SPDX-License-Identifier: Apache-2.0
// blend-normals: adds detail normals to base normals.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/blend_fields.h"
#include "options/layers.h"
#include "options/mips.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;

// A direction of green that is assumed for all maps has no effect if the texels of all of them show the other one, and
// if the output does not state it.
void trust_if_all_agree(BlendFileReport& report) {
    const auto doubtful = [](const SourceInfo& info) { return info.y_doubtful; };
    if (report.pack.y_known || !doubtful(report.source)) return;
    if (!std::all_of(report.details.begin(), report.details.end(), doubtful)) return;
    report.source.y_doubtful = false;
    for (SourceInfo& detail : report.details) detail.y_doubtful = false;
}

class BlendNormals : public cli::NormalsConverter {
public:
    explicit BlendNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    void add_blend();
    [[nodiscard]] bool joins() const { return layers_.details().empty(); }
    // The details of a task: the files of --detail, or the inputs after the base.
    [[nodiscard]] const std::vector<std::string>& details_of(const cli::Task& task) const {
        return joins() ? task.joined : layers_.details();
    }
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules{{}, Container::dds, joins(), layers_.files()};
        rules.amend = [this](cli::Task& task) { extras.amend(task); };
        return rules;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    [[nodiscard]] BlendFileOptions options(cli::Job& job) const;
    [[nodiscard]] std::optional<Step> step(cli::Job& job) override { return options(job); }

    BlendOptions blend_;
    std::shared_ptr<SharedMaps> shared_;  // if several bases get the same details
    cli::LayerOptions layers_;
    cli::WrapOptions wrap_;
    cli::MipChainOptions mips_;
};

BlendNormals::BlendNormals(const cli::ProgramRow& row) : NormalsConverter(row) {
    command.usage("BASE DETAIL... -o FILE");
    command.usage("BASE... --detail FILE --out-dir DIR");
    command.usage("BASE -o FILE --extent WxH");
    command.input("BASE DETAIL...", "normal maps, the base first; with --detail all are bases; - is standard input");
    files.add(command, true);
    add_blend();
    layers_.add(command);
    normals.add(command);
    output.add(command, "as in the base if it fits, else " + cli::default_encodings(), "as in the base", true);
    output.add_engines(command);
    extras.add(command, output, &normals);
    mips_.add(command, false, "all in dds and ktx2, else none");
    wrap_.add(command, "what lies beyond the base's border; two words set x and y separately");
    running.add(command);
    command.example("blend-normals wall.png grain.png -o wall.dds --tiling 8", "Grain on a wall, eight times across.");
    command.example("blend-normals rock.dds moss.dds -o out.dds --mode rnm --mask moss_mask.png",
                    "A layer where its mask is white.");
    command.example("blend-normals walls/*.dds --detail grain.dds --tiling 8 --out-dir out",
                    "One detail on many bases.");
    command.example(
        "blend-normals rock.dds moss.dds cracks.dds -o out.dds --mode rnm --mask moss.png:a --strength 0.8 "
        "--strength 1",
        "Two layers, one mask for both.");
}

void BlendNormals::add_blend() {
    command.group("Blend");
    command.choice(blend_.mode, "--mode", "M", kBlendModeNames, "how two normals become one")
        .often(2, "how two normals become one: whiteout, udn, rnm ...");
    command.number(blend_.base_scale, "--base-scale", "S", range_of(&BlendOptions::base_scale),
                   "make the base steeper or flatter");
    command.choice(blend_.scale_mode, "--scale-mode", "M", kScaleModeNames, "how normals are scaled");
    command
        .option("--extent", "N|WxH", "the width and height of the result in texels",
                [this](const std::string& text) {
                    const auto [width, height] = cli::parse_pair_of_sides(text, kMaxExtent);
                    blend_.extent = {width, height};
                })
        .preset = "the base's";
}

Result<void> BlendNormals::check(const std::vector<cli::Task>& tasks) {
    mips_.check(tasks);
    if (std::int64_t{blend_.extent.width} * blend_.extent.height > running.read.max_texels)
        throw cli::UsageError("--extent",
                              fmt::format("{}x{} texels are more than the limit of {}; --max-texels raises it",
                                          blend_.extent.width, blend_.extent.height, running.read.max_texels));
    if (tasks.empty()) return {};
    const std::size_t count = details_of(tasks.front()).size();
    // Without a detail, the base gets another size.
    if (count == 0 && blend_.extent == Extent{})
        throw cli::UsageError("no detail: give BASE DETAIL... -o FILE, or --detail FILE");
    layers_.check(count);
    constexpr std::int64_t kMostShared = std::int64_t{1} << 30;  // bytes
    if (tasks.size() > 1) shared_ = share_maps(kMostShared);
    return {};
}

BlendFileOptions BlendNormals::options(cli::Job& job) const {
    BlendFileOptions options;
    options.source = normals.options(job, {false, false, {}, {}, true});
    options.layers = layers_.layers(job, details_of(job.task), normals);
    options.shared = job.shared_maps ? job.shared_maps : shared_;
    options.blend = blend_;
    options.blend.wrap_x = wrap_.x;
    options.blend.wrap_y = wrap_.y;
    options.mip = mips_.options(mips_.levels_for(job.task), wrap_);
    extras.apply(options.source.unpack);
    for (LayerFile& layer : options.layers) {
        if (layer.mask) extras.apply(layer.source.unpack);
    }
    extras.apply(options.mip);
    options.others = extras.inputs(job);
    const cli::OutputOptions own = output.of(job.task.engine);
    options.pack = [own, &job](const SourceInfo& base) {
        return own.pack_options(own.format ? *own.format : cli::encoding_of(base, job.task), base.y_axis, base.y_known);
    };
    options.write = own.write_options(job);
    options.level_names = cli::level_names(job.task.output);
    return options;
}

// What a detail without a mask has beside its normals has no place in the blend.
void note_extras(cli::Job& job, const std::string& detail, const std::vector<ExtraChannel>& others) {
    std::vector<std::string> names;
    for (const ExtraChannel& other : others)
        names.push_back(other.name == 'L' ? "the lengths of vectors" : std::string(1, other.name));
    job.warn(fmt::format("data beside the normals, in {}, are not blended: the output has there what the base has "
                         "(--drop silences this warning)",
                         cli::join(names, " and ")),
             detail);
}

Result<void> BlendNormals::process(cli::Job& job) {
    const BlendFileOptions with = options(job);
    auto blended = blend_file(job.task.input, job.task.output, job.task.container, with, job.until(1.0));
    if (!blended) return blended.error();
    trust_if_all_agree(*blended);
    normals.note(job, job.task.input, blended->source);
    for (std::size_t k = 0; k < blended->details.size(); ++k) {
        SourceInfo detail = blended->details[k];
        if (!detail.others.empty() && !normals.drops_extras) note_extras(job, with.layers[k].input, detail.others);
        detail.others.clear();  // only what the base has beside its normals goes along, or is missed
        normals.note(job, with.layers[k].input, detail);
    }
    cli::report_input(job, blended->source);
    cli::wrote_levels(job, job.task.output, blended->levels);
    cli::report_texture(job, blended->extent, blended->levels, blended->pack, blended->bytes, blended->rdo);
    note_output(job, {blended->extent, blended->levels, blended->left_out > 0, blended->pack.encoding});
    return {};
}

const cli::Registered<BlendNormals> kRegistered(
    "blend-normals",
    "Blends detail normal maps on base normal maps, as a shader does, and builds the mip chain of the result.");

}  // namespace
