// SPDX-License-Identifier: Apache-2.0
// mip-normals: adds renormalised mip chains to normal maps.

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/model_plan.h"
#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/mips.h"
#include "options/roughness.h"
#include "tasks/name_pattern.h"

namespace {

using namespace tex;

class MipNormals : public cli::PackCommand {
public:
    explicit MipNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    [[nodiscard]] cli::OutputRules rules() const override;
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] PackFileOptions options(cli::Job& job) const override;
    void report(cli::Job& job, const PackFileReport& packed) const override { roughness_.report(job, packed); }

    cli::WrapOptions wrap_;
    cli::MipChainOptions mips_;
    cli::RoughnessOptions roughness_;
};

MipNormals::MipNormals(const cli::ProgramRow& row) : PackCommand(row) {
    add_files("normal maps; - is standard input");
    output.add(command, cli::default_encodings(), "as in the input", true);
    output.add_engines(command);
    extras.add(command, output, &normals);
    mips_.add(command, false, "all");
    wrap_.add(command, "what lies beyond the border; two words set x and y separately");
    roughness_.add(command, files);
    running.add(command);
    command.example("mip-normals bricks_n.png -o bricks.dds", "A DXT5nm texture with all its levels.");
    command.example("mip-normals bricks_n.png -o bricks.ktx2 --mip-filter kaiser --fade 2,6",
                    "Sharper levels that fade to flat.");
    command.example("mip-normals rock.png --out-dir levels --name '{stem}_mip{level}{ext}'",
                    "A picture for each level, for tools that put chains together themselves.");
    command.example("mip-normals rock_n.png -o rock_n.dds --roughness-in rock_orm.png:g --roughness-out rock_r.dds",
                    "The roughness map that keeps highlights steady from afar.");
    command.example("mip-normals rock_n.png -o rock_n.dds --roughness-into rock_orm.png:g --roughness-out rock_orm.dds",
                    "The same inside of a texture of occlusion, roughness and metalness.");
}

cli::OutputRules MipNormals::rules() const {
    if (cli::writes_models(files)) {
        std::string packing = "pack-normals";
        for (const std::string& input : command.inputs()) packing += ' ' + cli::shell_word(input);
        if (!files.output.empty()) packing += " -o " + cli::shell_word(files.output);
        if (!files.out_dir.empty()) packing += " --out-dir " + cli::shell_word(files.out_dir);
        if (!files.name.empty()) packing += " --name " + cli::shell_word(files.name);
        throw cli::UsageError(
            cli::printable(files.output.empty() ? files.name : files.output),
            "mip-normals writes no models. Engines build the levels of PNG and WebP in models; KTX2 holds them, "
            "renormalised: " +
                packing + " --format uastc");
    }
    cli::OutputRules rules;
    rules.batch = Container::dds;
    rules.amend = [this](cli::Task& task) {
        roughness_.amend(task);
        extras.amend(task);
    };
    return rules;
}

// An output with a single level is useless here.
Result<void> MipNormals::check(const std::vector<cli::Task>& tasks) {
    mips_.check(tasks);
    roughness_.check(tasks, mips_.levels.value_or(0));
    for (const cli::Task& task : tasks) {
        if (mips_.levels || can_hold_levels(task.container) || cli::has_level(task.output)) continue;
        const std::string_view type = name_of(kContainerNames, task.container);
        const bool engine_builds = task.engine != nullptr && !task.engine->has_mips;
        // The levels are those of roughness.
        if (engine_builds && roughness_.is_given()) continue;
        if (engine_builds)
            throw cli::UsageError(
                cli::printable(task.output),
                fmt::format("{} files hold one level, and {} builds the others: pack-normals --for {} makes such a "
                            "file; .dds, .ktx2 and .exr hold all",
                            type, task.engine->name, task.engine->name));
        throw cli::UsageError(
            fmt::format("{}: {} files hold one level; give .dds, .ktx2 or .exr, or a name with {{level}}",
                        cli::printable(task.output), type));
    }
    return {};
}

PackFileOptions MipNormals::options(cli::Job& job) const {
    PackFileOptions options;
    options.mip = mips_.options(mips_.levels.value_or(0), wrap_);
    if (!roughness_.is_given()) return options;
    options.roughness = roughness_.file(job, output.effort);
    if (options.roughness->format == Format::uastc_4x4_unorm)
        options.roughness->zstd = output.zstd_for(*options.roughness->format);
    return options;
}

const cli::Registered<MipNormals> kRegistered(
    "mip-normals",
    "Builds the mip chain of normal maps: every level is filtered from the true average of the one before and "
    "renormalised.");

}  // namespace
