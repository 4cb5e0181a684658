// SPDX-License-Identifier: Apache-2.0
// scale-normals: normal maps made steeper or flatter.

#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/repack.h"
#include "cli/usage_error.h"
#include "options/source.h"

namespace {

using namespace tex;

struct ScaleNormals {
    cli::Command command{"scale-normals", "Makes normal maps steeper or flatter, every level of them."};
    cli::FileOptions files;
    float scale = 1.0f;
    ScaleMode mode = ScaleMode::slope;
    cli::SourceOptions source;
    cli::OutputOptions output;
    cli::RunOptions run;

    ScaleNormals();
    Result<void> process(cli::Job& job);
};

ScaleNormals::ScaleNormals() {
    command.usage("NORMALS... -o FILE --scale S");
    command.usage("NORMALS... --out-dir DIR --scale S");
    command.input("NORMALS...", "normal maps; - is standard input");
    files.add(command);
    command.group("Scale");
    command
        .number(scale, "--scale", "S", {-kMaxScale, kMaxScale},
                "the factor, needed; 0 is flat, negative turns bumps into dents")
        .preset = "";
    command.choice(mode, "--scale-mode", "M", kScaleModeNames, "how normals are scaled");
    source.add(command);
    output.add(command, "as in the input where it fits, else " + cli::default_encodings(), "as in the input");
    run.add(command);
    command.example("scale-normals bricks.dds -o strong.dds --scale 2",
                    "Twice as steep, all levels, the same encoding.");
    command.example("scale-normals *.png --out-dir dents --scale -1", "Bumps become dents.");
    command.check([this] {
        if (!command.given("--scale")) throw cli::UsageError("no scale: give --scale S");
    });
}

Result<void> ScaleNormals::process(cli::Job& job) {
    PackFileOptions options;
    options.scale = {scale, mode};
    return cli::repack(job, source, output, options,
                       [&](const SourceInfo& info) { return cli::encoding_of(info, job.task); });
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("scale-normals", [&] {
        ScaleNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        cli::Steps steps;
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
