// SPDX-License-Identifier: Apache-2.0
// scale-normals: makes normal maps steeper or flatter.

#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/usage_error.h"
#include "fields/blend_fields.h"

namespace {

using namespace tex;

class ScaleNormals : public cli::PackCommand {
public:
    explicit ScaleNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules;
        rules.amend = [this](cli::Task& task) { extras.amend(task); };
        return rules;
    }
    [[nodiscard]] PackFileOptions options(cli::Job&) const override {
        PackFileOptions options;
        options.scale = {scale_, mode_};
        return options;
    }
    [[nodiscard]] Encoding encoding(const SourceInfo& input, const cli::Task& task) const override {
        return cli::encoding_of(input, task);
    }

    float scale_ = 1.0f;
    ScaleMode mode_ = ScaleMode::slope;
};

ScaleNormals::ScaleNormals(const cli::ProgramRow& row) : PackCommand(row) {
    command.usage("NORMALS... -o FILE --scale S");
    command.usage("NORMALS... --out-dir DIR --scale S");
    command.input("NORMALS...", "normal maps; - is standard input");
    files.add(command);
    command.group("Scale");
    command
        .number(scale_, "--scale", "S", range_of(&Scaling::scale),
                "the factor, required; 0 is flat, negative turns bumps into dents")
        .often(1, "the factor; 0 is flat, negative turns bumps into dents")
        .preset = "";
    command.choice(mode_, "--scale-mode", "M", kScaleModeNames, "how normals are scaled");
    normals.add(command);
    output.add(command, "as in the input if it fits, else " + cli::default_encodings(), "as in the input", true);
    extras.add(command, output, &normals);
    running.add(command);
    command.example("scale-normals bricks.dds -o strong.dds --scale 2",
                    "Twice as steep, all levels, the same encoding.");
    command.example("scale-normals *.png --out-dir dents --scale -1", "Bumps become dents.");
    command.example("scale-normals bricks.dds -o soft.dds --scale 0.5 --scale-mode xy", "As a shader scales x and y.");
    command.check([this] {
        if (!command.given("--scale")) throw cli::UsageError("no scale: give --scale S");
    });
}

const cli::Registered<ScaleNormals> kRegistered("scale-normals",
                                                "Makes normal maps steeper or flatter, every level of them.");

}  // namespace
