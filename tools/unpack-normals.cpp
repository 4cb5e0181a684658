// SPDX-License-Identifier: Apache-2.0
// unpack-normals: textures of normals to pictures.

#include <limits>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/blend_fields.h"
#include "tasks/name_pattern.h"

namespace {

using namespace tex;

class UnpackNormals : public cli::PackCommand {
public:
    explicit UnpackNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules{Container::png, Container::png};
        rules.amend = [this](cli::Task& task) { apart_.amend(task); };
        return rules;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] PackFileOptions options(cli::Job& job) const override;
    void report(cli::Job& job, const PackFileReport&) const override { apart_.report(job); }
    [[nodiscard]] Encoding encoding(const SourceInfo& input, const cli::Task& task) const override;

    int level_ = 0;
    bool all_levels_ = false;
    float scale_ = 1.0f;
    ScaleMode scale_mode_ = ScaleMode::slope;
    cli::ExtraFiles apart_;
};

UnpackNormals::UnpackNormals(const cli::ProgramRow& row) : PackCommand(row) {
    add_files("textures or pictures of normals; - is standard input");
    cli::Option& option =
        command.option("--level", "N", "the level to unpack, from 0, or all", [this](const std::string& text) {
            all_levels_ = text == "all";
            if (!all_levels_) level_ = cli::parse_int(text, 0, std::numeric_limits<int>::max());
        });
    option.words = {{"all", "every level, if the output can hold them"}};
    option.often(3, "the level to unpack, from 0, or all").completes = cli::Completes::words;
    option.preset = fmt::format("{}", level_);
    command
        .number(scale_, "--scale", "S", range_of(&Scaling::scale), "make normals steeper or flatter; negative: dents")
        .often(3, "make normals steeper or flatter");
    command.choice(scale_mode_, "--scale-mode", "M", kScaleModeNames, "how they are scaled");
    apart_.add(command, files, normals);
    output.add(command, cli::default_encodings(Encoding::rgb8), "as in the input", false, Container::png);
    running.add(command);
    command.example("unpack-normals bricks.dds -o bricks.png", "The base level as a picture, whatever its layout.");
    command.example("unpack-normals bricks.dds -o bricks.exr --scale 0.5 --scale-mode xy",
                    "What a shader gets from UnpackScaleNormal, as floats.");
    command.example("unpack-normals bricks.ktx2 --level all --name '{stem}_mip{level}.png'", "All levels as pictures.");
    command.example(
        "unpack-normals rock_pbr.png -o rock_n.png --swizzle rg --blue-out rock_ao.png --alpha-out rock_h.png",
        "What a LabPBR texture holds, in three files.");
}

Result<void> UnpackNormals::check(const std::vector<cli::Task>& tasks) {
    apart_.check(tasks);
    for (const cli::Task& task : tasks) {
        if (!all_levels_ || can_hold_levels(task.container) || cli::has_level(task.output)) continue;
        throw cli::UsageError(cli::printable(task.output),
                              fmt::format("{} files hold one level; --level all needs --name with {{level}}",
                                          name_of(kContainerNames, task.container)));
    }
    return {};
}

PackFileOptions UnpackNormals::options(cli::Job& job) const {
    PackFileOptions options;
    apart_.apply(job.task, options);
    if (!all_levels_) options.level = level_;
    if (command.given("--scale")) options.scale = {scale_, scale_mode_};
    return options;
}

Encoding UnpackNormals::encoding(const SourceInfo&, const cli::Task& task) const {
    return can_hold_blocks(task.container) ? Encoding::rgb8 : default_encoding(task.container);
}

const cli::Registered<UnpackNormals> kRegistered(
    "unpack-normals", "Turns textures of normals into pictures: decodes the blocks, reconstructs z and scales.");

}  // namespace
