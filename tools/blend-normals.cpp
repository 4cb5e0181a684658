// SPDX-License-Identifier: Apache-2.0
// blend-normals: detail normals on top of base normals.

#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/repack.h"
#include "cli/usage_error.h"
#include "options/groups.h"
#include "options/layers.h"
#include "options/source.h"

namespace {

using namespace tex;

struct BlendNormals {
    cli::Command command{"blend-normals",
                         "Blends detail normal maps on base normal maps, as a shader does, and builds the mip chain of "
                         "the result."};
    cli::FileOptions files;
    BlendOptions blend;
    cli::LayerOptions layers;
    cli::SourceOptions source;
    cli::WrapOptions wrap;
    cli::OutputOptions output;
    cli::MipChainOptions mips;
    cli::RunOptions run;

    BlendNormals();
    void add_blend();
    // The details of a job: those of --detail, or the inputs after the base.
    [[nodiscard]] std::vector<std::string> details_of(const cli::Task& task) const;
    void check(const std::vector<cli::Task>& tasks) const;
    Result<void> process(cli::Job& job);
};

BlendNormals::BlendNormals() {
    command.usage("BASE DETAIL... -o FILE");
    command.usage("BASE... --detail FILE --out-dir DIR");
    command.input("BASE DETAIL...", "normal maps, the base first; with --detail all are bases; - is standard input");
    files.joins = true;
    files.add(command);
    add_blend();
    layers.add(command);
    source.add(command);
    output.add(command, "as in the base where it fits, else " + cli::default_encodings(), "as in the base");
    mips.add(command, false, "all in dds and ktx2, else none");
    wrap.add(command, "what lies beyond the base's border, or for x and y apart");
    run.add(command);
    command.example("blend-normals wall.png grain.png -o wall.dds --tiling 8", "Grain on a wall, eight times across.");
    command.example(
        "blend-normals rock.dds moss.dds cracks.dds -o out.dds --mode rnm --mask moss.png:a --strength 0.8 "
        "--strength 1",
        "Two layers, one mask for both.");
    command.example("blend-normals walls/*.dds --detail grain.dds --tiling 8 --out-dir out",
                    "One detail on many bases.");
}

void BlendNormals::add_blend() {
    command.group("Blend");
    command.choice(blend.mode, "--mode", "M", kBlendModeNames, "how two normals become one");
    command.number(blend.base_scale, "--base-scale", "S", {-kMaxScale, kMaxScale}, "make the base steeper or flatter");
    command.choice(blend.scale_mode, "--scale-mode", "M", kScaleModeNames, "how normals are scaled");
    command
        .option("--extent", "WxH", "the size of the result in texels",
                [this](const std::string& text) {
                    const auto [width, height] = cli::cut(text, 'x');
                    blend.extent = {cli::parse_int(width, 1, kMaxExtent), cli::parse_int(height, 1, kMaxExtent)};
                })
        .preset = "the base's";
    command.check([this] {
        files.joins = layers.details().empty();
        files.shared = layers.details();
        for (std::string& mask : layers.mask_files()) files.shared.push_back(std::move(mask));
    });
}

std::vector<std::string> BlendNormals::details_of(const cli::Task& task) const {
    if (!files.joins) return layers.details();
    return {task.also.begin(), task.also.end() - static_cast<std::ptrdiff_t>(files.shared.size())};
}

void BlendNormals::check(const std::vector<cli::Task>& tasks) const {
    mips.check(tasks);
    if (tasks.empty()) return;
    const std::size_t count = files.output.empty() && files.joins ? 0 : details_of(tasks.front()).size();
    if (count == 0) throw cli::UsageError("no detail: give BASE DETAIL... -o FILE, or --detail FILE");
    layers.check(count);
}

Result<void> BlendNormals::process(cli::Job& job) {
    for (const std::string& name : job.task.also) job.depends_on(name);
    BlendFileOptions options;
    options.source = source.options(job);
    options.layers = layers.files(job, details_of(job.task), source);
    options.blend = blend;
    options.mip = mips.mip;
    options.mip.levels = mips.levels_for(job.task);
    options.pack = [&](const SourceInfo& base) {
        return output.pack_options(output.format ? *output.format : cli::encoding_of(base, job.task),
                                   output.y.value_or(base.y_axis));
    };
    options.write = output.write_options(job);
    options.level_names = cli::level_names(job.task.output);
    const auto blended = blend_file(job.task.input, job.task.output, job.task.container, options, job.until(1.0));
    if (!blended) return blended.error();
    source.note(job, job.task.input, blended->source);
    for (std::size_t k = 0; k < blended->details.size(); ++k)
        source.note(job, options.layers[k].input, blended->details[k]);
    cli::report_source(job, blended->source);
    cli::wrote_levels(job, job.task.output, blended->levels);
    cli::report_texture(job, blended->extent, blended->levels, blended->pack, blended->bytes);
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("blend-normals", [&] {
        BlendNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        self.blend.wrap_x = self.mips.mip.wrap_x = self.wrap.x;
        self.blend.wrap_y = self.mips.mip.wrap_y = self.wrap.y;
        cli::Steps steps;
        steps.check = [&](const std::vector<cli::Task>& tasks) {
            self.check(tasks);
            return Result<void>();
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
