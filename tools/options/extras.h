// SPDX-License-Identifier: Apache-2.0
// others.h: the option group of commands that write normal maps with other data in blue, alpha or the vectors' lengths.

#pragma once

#include <optional>
#include <string>

#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/files.h"
#include "options/heights.h"
#include "options/normals.h"
#include "options/output.h"
#include "tasks/job.h"

namespace tex::cli {

// What an engine or a pack of textures expects beside the normals.
enum class Layout { labpbr, terrain3d, source, skyrim };

inline constexpr Named<Layout> kLayoutNames[] = {
    {Layout::labpbr, "labpbr", "x and y, occlusion in blue, height in alpha; green down"},
    {Layout::terrain3d, "terrain3d", "roughness in alpha; green up"},
    {Layout::source, "source", "a mask of reflections in alpha; green down"},
    {Layout::skyrim, "skyrim", "a mask of highlights in alpha; green down"},
};

// --blue, --alpha, --length, --kind, --layout.
class ExtraOptions {
public:
    // `reads`: how the command reads maps, whose data can be kept; null if it has heights. It and `output`, whose
    // options have been added and which a layout sets, must outlive the command.
    void add(Command& command, OutputOptions& output, const NormalsReader* reads);

    [[nodiscard]] bool is_added() const { return is_added_; }

    // Adds the files that the options read to the task.
    void amend(Task& task) const;

    // The options in the form that the library takes. It reads files when it needs them. The job must outlive it.
    [[nodiscard]] ExtraInputs inputs(Job& job) const;
    // What of the map that is read goes along.
    void apply(UnpackOptions& unpack) const;
    void apply(MipOptions& mip) const;
    // What outputs that hold this do not lose of the map's data, or were told to lose.
    [[nodiscard]] ExtraSet accounted_for(ExtraSet held) const;
    // Whether z is stored.
    [[nodiscard]] bool stores_z() const { return choices_.blue.from == Choice::From::nothing; }
    // Whether occlusion of the heights that are baked goes beside the normals.
    [[nodiscard]] bool has_occlusion() const;

private:
    struct Choice {
        enum class From { nothing, kept, heights, occlusion, number, file };
        From from = From::nothing;
        float number = 1.0f;
        ChannelFile file = {};  // its file is a pattern

        [[nodiscard]] bool is_given() const { return from != From::nothing && from != From::kept; }
    };
    struct ExtraOption;  // the option of one of them
    static const ExtraOption kExtraOptions[];

    void take(const std::string& text, const ExtraOption& row);
    void add_option(Command& command, const ExtraOption& row);
    void set_layout(const Command& command, OutputOptions& output);
    void check_room(const OutputOptions& output) const;
    void check_lengths(const Command& command) const;
    static ChannelFile file_for(const Choice& choice, const Task& task);
    std::optional<ExtraData> data(const Choice& choice, Job& job) const;

    bool is_added_ = false;
    const NormalsReader* reads_ = nullptr;
    Extras<Choice> choices_;
    std::optional<Layout> layout_;
    std::optional<ExtraKind> blue_kind_, alpha_kind_;
};

// --blue-out, --alpha-out, --length-out.
class ExtraFiles {
public:
    // The parameters must outlive this.
    void add(Command& command, const FileOptions& files, const NormalsReader& reads);
    void amend(Task& task) const;
    // Throws UsageError if an output cannot hold one channel of pictures.
    void check(const std::vector<Task>& tasks) const;
    // Sets PackFileOptions::apart.
    void apply(const Task& task, PackFileOptions& options) const;
    // Adds the files that were written after the normals to the job's outputs and report.
    void report(Job& job) const;

private:
    struct Out;  // the option of one of them
    static const Out kOuts[];

    [[nodiscard]] std::optional<ExtraFile> file(const Out& row, const Task& task) const;

    const FileOptions* files_ = nullptr;
    Extras<std::string> patterns_;
};

}  // namespace tex::cli
