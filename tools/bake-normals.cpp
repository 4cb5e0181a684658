// SPDX-License-Identifier: Apache-2.0
// bake-normals: height maps to normal maps.

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/repack.h"
#include "cli/usage_error.h"
#include "options/groups.h"
#include "options/heights.h"

namespace {

using namespace tex;

struct BakeNormals {
    cli::Command command{"bake-normals",
                         "Turns height maps into tangent-space normal maps: bakes the normals, builds the mip chain, "
                         "packs and writes it."};
    cli::FileOptions files;
    cli::HeightReader reader;
    cli::WrapOptions wrap;
    BakeOptions bake;
    cli::OutputOptions output;
    cli::MipChainOptions mips;
    cli::RunOptions run;

    BakeNormals();
    void add_kernel();
    Result<void> process(cli::Job& job);
    [[nodiscard]] Encoding encoding(const cli::Job& job) const;
};

BakeNormals::BakeNormals() {
    command.usage("HEIGHT... -o FILE");
    command.usage("HEIGHT... --out-dir DIR [--name PATTERN]");
    command.input("HEIGHT...", "height maps; - is standard input");
    files.add(command);
    reader.strength.add(command);
    command.group("Heights and slopes");
    add_kernel();
    wrap.add(command, "what lies beyond the border, or for x and y apart");
    reader.heights.add(command);
    reader.color.add(command);
    command.check([this] {
        if (const std::string config = reader.color.config_file(); !config.empty()) files.shared = {config};
    });
    output.add(command, cli::default_encodings(), "up");
    mips.add(command, false, "all in dds and ktx2, else none");
    run.add(command);
    command.example("bake-normals bricks.png -o bricks.dds --bumpiness 8", "A DXT5nm texture with all its mip levels.");
    command.example("bake-normals rock.exr -o rock.ktx2 --format bc5 --height-range 0.15 --size 2 --y down",
                    "A rock face 2 m wide with 15 cm of relief, as BC5 for a renderer with green down.");
    command.example("bake-normals maps/*.png --out-dir out --kernel scharr --json", "A folder at once, with a report.");
}

void BakeNormals::add_kernel() {
    cli::Row& row = command.option("--kernel", "K", "how slopes are measured", [this](const std::string& text) {
        const auto [name, sigma] = cli::cut(text, ':');
        bake.kernel = cli::parse_word(name, kGradientKernelNames);
        if (text.find(':') == std::string::npos) return;
        if (bake.kernel != GradientKernel::gaussian) {
            throw cli::UsageError(fmt::format("{} takes no sigma, only gaussian does", name));
        }
        bake.gaussian_sigma = cli::parse_float(sigma, {0.0, kMaxGaussianSigma, false});
    });
    row.words = cli::words_of(kGradientKernelNames);
    row.completes = cli::Completes::words;
    row.preset = name_of(kGradientKernelNames, bake.kernel);
    row.help += fmt::format("; gaussian:SIGMA sets its width in texels (default {})", bake.gaussian_sigma);
}

Result<void> BakeNormals::process(cli::Job& job) {
    BakeFileOptions options;
    options.read = job.read_options;
    options.heights = reader.heights.options;
    options.color = reader.color.color;
    options.strength = [this](Extent extent) { return reader.strength.strength(extent); };
    options.bake = bake;
    options.mip = mips.mip;
    options.mip.levels = mips.levels_for(job.task);
    options.pack = output.pack_options(encoding(job), output.y.value_or(YAxis::up));
    options.write = output.write_options(job);
    options.level_names = cli::level_names(job.task.output);
    options.slopes = run.json;
    const auto baked = bake_file(job.task.input, job.task.output, job.task.container, options, job.until(1.0));
    if (!baked) return cli::HeightReader::with_remedy(baked.error());
    reader.note(job, baked->heights);
    cli::wrote_levels(job, job.task.output, baked->levels);
    cli::report_texture(job, baked->extent, baked->levels, options.pack, baked->bytes);
    const SlopeRange& slopes = baked->slopes;
    job.report["slopes"] = {{"x", {slopes.min_x, slopes.max_x}}, {"y", {slopes.min_y, slopes.max_y}}};
    return {};
}

Encoding BakeNormals::encoding(const cli::Job& job) const {
    return output.format.value_or(default_encoding(job.task.container));
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("bake-normals", [&] {
        BakeNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        HeightOptions& heights = self.reader.heights.options;
        heights.wrap_x = self.mips.mip.wrap_x = self.wrap.x;
        heights.wrap_y = self.mips.mip.wrap_y = self.wrap.y;
        cli::Steps steps;
        steps.defaults.batch = Container::dds;
        steps.check = [&](const std::vector<cli::Task>& tasks) {
            self.mips.check(tasks);
            return self.reader.color.check();
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.reader.warn_of_luma(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
