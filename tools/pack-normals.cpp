// SPDX-License-Identifier: Apache-2.0
// pack-normals: normal maps to textures in any encoding.

#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/repack.h"
#include "options/groups.h"
#include "options/source.h"

namespace {

using namespace tex;

struct PackNormals {
    cli::Command command{"pack-normals",
                         "Stores normal maps in another encoding or kind of file, with the levels that they have."};
    cli::FileOptions files;
    cli::SourceOptions source;
    cli::WrapOptions wrap;
    cli::OutputOptions output;
    cli::MipChainOptions mips;
    cli::RunOptions run;

    PackNormals();
    Result<void> process(cli::Job& job);
};

PackNormals::PackNormals() {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR [--name PATTERN]");
    command.input("NORMALS...", "normal maps; - is standard input");
    files.add(command);
    source.add(command);
    output.add(command, cli::default_encodings(), "as in the input");
    mips.add(command, true, "keep");
    wrap.add(command, "what lies beyond the border of levels that are built, or for x and y apart");
    run.add(command);
    command.example("pack-normals bricks_n.png -o bricks.dds --mips all", "DXT5nm with all levels.");
    command.example("pack-normals bricks.dds -o bricks_bc5.ktx2 --format bc5", "Another encoding, the same levels.");
    command.example("pack-normals directx/*.png --out-dir opengl --format rgb8 --y-in down --y up",
                    "Pictures from one convention to the other.");
}

Result<void> PackNormals::process(cli::Job& job) {
    PackFileOptions options;
    if (!mips.keep && mips.levels) {
        options.mip = mips.mip;
        options.mip->levels = *mips.levels;
    }
    return cli::repack(job, source, output, options,
                       [&](const SourceInfo&) { return default_encoding(job.task.container); });
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("pack-normals", [&] {
        PackNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        self.mips.mip.wrap_x = self.wrap.x;
        self.mips.mip.wrap_y = self.wrap.y;
        cli::Steps steps;
        steps.defaults.batch = Container::dds;
        steps.check = [&](const std::vector<cli::Task>& tasks) {
            self.mips.check(tasks);
            self.mips.check_builds(self.command);
            return Result<void>();
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
