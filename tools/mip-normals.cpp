// SPDX-License-Identifier: Apache-2.0
// mip-normals: normal maps to renormalised mip chains.

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/name_pattern.h"
#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/groups.h"
#include "options/roughness.h"
#include "options/source.h"

namespace {

using namespace tex;

struct MipNormals {
    cli::Command command{"mip-normals",
                         "Builds the mip chain of normal maps: every level is filtered from the true average of the "
                         "one before and renormalised."};
    cli::FileOptions files;
    cli::SourceOptions source;
    cli::WrapOptions wrap;
    cli::OutputOptions output;
    cli::MipChainOptions mips;
    cli::RoughnessOptions roughness;
    cli::RunOptions run;

    MipNormals();
    void check(const std::vector<cli::Task>& tasks) const;
    Result<void> process(cli::Job& job);
};

MipNormals::MipNormals() {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR [--name PATTERN]");
    command.input("NORMALS...", "normal maps; - is standard input");
    files.add(command);
    source.add(command);
    output.add(command, cli::default_encodings(), "as in the input");
    mips.add(command, false, "all");
    wrap.add(command, "what lies beyond the border, or for x and y apart");
    roughness.add(command, files);
    run.add(command);
    command.example("mip-normals bricks_n.png -o bricks.dds", "A DXT5nm texture with all its levels.");
    command.example("mip-normals bricks_n.png -o bricks.ktx2 --format bc5 --mip-filter kaiser --fade 2,6",
                    "Sharper levels that fade to flat.");
    command.example("mip-normals rock.png --out-dir levels --name '{stem}_mip{level}{ext}'",
                    "A picture for each level, for tools that put chains together themselves.");
    command.example("mip-normals rock_n.png -o rock_n.dds --roughness-in rock_orm.png:g --roughness-out rock_r.dds",
                    "The roughness map that keeps highlights steady from afar.");
}

// A file that holds one level is not what anybody wants of this command.
void MipNormals::check(const std::vector<cli::Task>& tasks) const {
    mips.check(tasks);
    roughness.check(tasks, mips.levels.value_or(0));
    for (const cli::Task& task : tasks) {
        if (mips.levels || can_hold_levels(task.container) || cli::has_level(task.output)) continue;
        throw cli::UsageError(
            fmt::format("{}: a {} file holds one level; give .dds, .ktx2 or .exr, or --name with {{level}}",
                        cli::printable(task.output), name_of(kContainerNames, task.container)));
    }
}

Result<void> MipNormals::process(cli::Job& job) {
    PackFileOptions options;
    options.mip = mips.mip;
    options.mip->levels = mips.levels.value_or(0);
    if (roughness.is_given()) options.roughness = roughness.file(job, output.effort);
    return cli::repack(
        job, source, output, options, [&](const SourceInfo&) { return default_encoding(job.task.container); },
        [&](const PackFileReport& packed) { roughness.tell(job, packed); });
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("mip-normals", [&] {
        MipNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        self.mips.mip.wrap_x = self.wrap.x;
        self.mips.mip.wrap_y = self.wrap.y;
        cli::Steps steps;
        steps.defaults.batch = Container::dds;
        steps.check = [&](const std::vector<cli::Task>& tasks) {
            self.check(tasks);
            return Result<void>();
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
