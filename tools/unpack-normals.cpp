// SPDX-License-Identifier: Apache-2.0
// unpack-normals: textures of normals to pictures.

#include <limits>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/name_pattern.h"
#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/source.h"

namespace {

using namespace tex;

struct UnpackNormals {
    cli::Command command{"unpack-normals",
                         "Turns textures of normals into pictures: decodes the blocks, reconstructs z and scales."};
    cli::FileOptions files;
    cli::SourceOptions source;
    int level = 0;
    bool all_levels = false;
    float scale = 1.0f;
    ScaleMode scale_mode = ScaleMode::slope;
    cli::OutputOptions output;
    cli::RunOptions run;

    UnpackNormals();
    void check(const std::vector<cli::Task>& tasks) const;
    Result<void> process(cli::Job& job);
    [[nodiscard]] Encoding encoding(const cli::Job& job) const;
};

UnpackNormals::UnpackNormals() {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR [--name PATTERN]");
    command.input("NORMALS...", "textures or pictures of normals; - is standard input");
    files.add(command);
    source.add(command);
    cli::Row& row =
        command.option("--level", "N", "the level to unpack, from 0, or all", [this](const std::string& text) {
            all_levels = text == "all";
            if (!all_levels) level = cli::parse_int(text, 0, std::numeric_limits<int>::max());
        });
    row.words = {{"all", "every level, where the output can hold them"}};
    row.completes = cli::Completes::words;
    row.preset = fmt::format("{}", level);
    command.number(scale, "--scale", "S", {-kMaxScale, kMaxScale}, "make normals steeper or flatter; negative: dents");
    command.choice(scale_mode, "--scale-mode", "M", kScaleModeNames, "how they are scaled");
    output.add(command, "rgb8 in dds and ktx2, else " + cli::default_encodings(), "as in the input");
    run.add(command);
    command.example("unpack-normals bricks.dds -o bricks.png", "The base level as a picture, whatever its layout.");
    command.example("unpack-normals bricks.dds -o bricks.exr --scale 0.5 --scale-mode xy",
                    "What a shader gets from UnpackScaleNormal, as floats.");
    command.example("unpack-normals bricks.ktx2 --level all --name '{stem}_mip{level}.png'", "All levels as pictures.");
}

void UnpackNormals::check(const std::vector<cli::Task>& tasks) const {
    for (const cli::Task& task : tasks) {
        if (!all_levels || can_hold_levels(task.container) || cli::has_level(task.output)) continue;
        throw cli::UsageError(fmt::format("{}: a {} file holds one level; --level all wants --name with {{level}}",
                                          cli::printable(task.output), name_of(kContainerNames, task.container)));
    }
}

Result<void> UnpackNormals::process(cli::Job& job) {
    PackFileOptions options;
    if (!all_levels) options.level = level;
    if (command.given("--scale")) options.scale = {scale, scale_mode};
    return cli::repack(job, source, output, options, [&](const SourceInfo&) { return encoding(job); });
}

Encoding UnpackNormals::encoding(const cli::Job& job) const {
    return can_hold_blocks(job.task.container) ? Encoding::rgb8 : default_encoding(job.task.container);
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("unpack-normals", [&] {
        UnpackNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        cli::Steps steps;
        steps.defaults = {Container::png, Container::png};
        steps.check = [&](const std::vector<cli::Task>& tasks) {
            self.check(tasks);
            return Result<void>();
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
