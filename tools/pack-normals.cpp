// SPDX-License-Identifier: Apache-2.0
// pack-normals: normal maps to textures in any encoding.

#include <algorithm>
#include <string>

#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/usage_error.h"
#include "options/mips.h"

namespace {

using namespace tex;

class PackNormals : public cli::PackCommand {
public:
    explicit PackNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules{Container::dds};
        rules.models = material_;
        rules.writes_models = true;
        rules.amend = [this](cli::Task& task) { extras.amend(task); };
        return rules;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] PackFileOptions options(cli::Job& job) const override;

    std::string material_;
    bool normalize_ = false;
    cli::WrapOptions wrap_;
    cli::MipChainOptions mips_;
};

PackNormals::PackNormals(const cli::ProgramRow& row) : PackCommand(row) {
    add_files("normal maps, and glTF models with their maps; - is standard input");
    command.usage("MODEL -o MODEL");
    command.text(material_, "--material", "NAME", "of models, only the maps of this material, or of its number from 0");
    command.flag(normalize_, "--normalize", "make vectors unit also where that changes codes that could stay");
    output.add(command, cli::default_encodings(), "as in the input", true);
    output.add_engines(command);
    extras.add(command, output, &normals);
    mips_.add(command, true, "keep");
    wrap_.add(command, "what lies beyond the border of levels that are built; two words set x and y separately");
    running.add(command);
    command.check([this] {
        if (normalize_ && normals.unpack.keep_length)
            throw cli::UsageError("--normalize and --keep-length exclude each other");
    });
    command.example("pack-normals bricks_n.png -o bricks.dds --mips all", "DXT5nm with all levels.");
    command.example("pack-normals scene.glb -o fixed.glb --y-in 'measured, else up' --y up",
                    "A model whose maps may have green down; those that do not show it stay.");
    command.example("pack-normals directx/*.png --out-dir opengl --format rgb8 --y-in down --y up",
                    "Pictures from one convention to the other.");
    command.example("pack-normals bricks.dds -o bricks_bc5.ktx2 --format bc5", "Another encoding, the same levels.");
    command.example("pack-normals rock_n.png -o rock_pbr.png --layout labpbr --blue rock_ao.png --alpha rock_h.png",
                    "Occlusion and heights beside the normals.");
    command.example("pack-normals model.glb --out-dir out --for unreal --name '{stem}_{material}.{type}'",
                    "Every normal map that the materials of a model use.");
}

Result<void> PackNormals::check(const std::vector<cli::Task>& tasks) {
    const auto has_model = [](const cli::Task& task) { return task.model || task.model_output; };
    if (!material_.empty() && std::none_of(tasks.begin(), tasks.end(), has_model))
        throw cli::UsageError("--material needs a model");
    const auto has_picture = [](const cli::Task& task) {
        return task.model_output != nullptr && task.container != Container::ktx2;
    };
    if (mips_.levels.value_or(1) != 1 && !mips_.keep && std::any_of(tasks.begin(), tasks.end(), has_picture))
        throw cli::UsageError("--mips", "models hold no levels: engines build them");
    mips_.check(tasks);
    mips_.check_builds(command, tasks);
    return {};
}

PackFileOptions PackNormals::options(cli::Job& job) const {
    PackFileOptions options;
    if (!mips_.keep && (mips_.levels || job.task.engine != nullptr))
        options.mip = mips_.options(mips_.levels_for(job.task), wrap_);
    options.max_side = mips_.mip.max_side;
    options.keep_codes = !normalize_;
    return options;
}

const cli::Registered<PackNormals> kRegistered(
    "pack-normals", "Stores normal maps in another encoding or file type, with the levels that they have.");

}  // namespace
