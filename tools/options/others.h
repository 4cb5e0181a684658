// SPDX-License-Identifier: Apache-2.0
// others.h: the option group of commands that write normal maps with other data in blue, alpha or the vectors' lengths.

#pragma once

#include <array>
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
class OtherOptions {
public:
    // `reads`: how the command reads maps, whose data can be kept; null if it has heights. It and `output`, whose
    // options have been added and which a layout sets, must outlive the command.
    void add(Command& command, OutputOptions& output, const NormalsReader* reads);

    [[nodiscard]] bool is_added() const { return is_added_; }

    // Adds the files that the options read to the task.
    void amend(Task& task) const;

    // The options in the form that the library takes. It reads files when it needs them. The job must outlive it.
    [[nodiscard]] OtherInputs inputs(Job& job) const;
    // What of the map that is read goes along.
    void apply(UnpackOptions& unpack) const;
    void apply(MipOptions& mip) const;
    // What outputs that hold this do not lose of the map's data, or were told to lose.
    [[nodiscard]] OtherPlanes accounted_for(OtherPlanes held) const;
    // Whether z is stored.
    [[nodiscard]] bool stores_z() const { return blue_.from == Choice::From::nothing; }

private:
    struct Choice {
        enum class From { nothing, kept, heights, number, file };
        From from = From::nothing;
        float number = 1.0f;
        ChannelFile file = {};  // its file is a pattern

        [[nodiscard]] bool is_given() const { return from != From::nothing && from != From::kept; }
    };
    // A place beside the normals, and the option that says what it holds.
    struct PlaceOption {
        const char* option;
        const char* help;
        const char* nothing;  // what it holds then
        bool OtherPlanes::*has;
        std::optional<OtherData> OtherInputs::*data;
        Choice OtherOptions::*choice;
        const char* kept;     // the word for what it holds in the input
        const char* heights;  // the word for heights that are baked; null: they do not go there
        bool is_kept;         // without the option
    };
    static const std::array<PlaceOption, 3> kPlaceOptions;

    void take(const std::string& text, const PlaceOption& place);
    void add_option(Command& command, const PlaceOption& place);
    void set_layout(const Command& command, OutputOptions& output);
    void check_room(const OutputOptions& output) const;
    void check_lengths(const Command& command) const;
    static ChannelFile file_for(const Choice& choice, const Task& task);
    std::optional<OtherData> data(const Choice& choice, Job& job) const;

    bool is_added_ = false;
    const NormalsReader* reads_ = nullptr;
    Choice blue_, alpha_, length_;
    std::optional<Layout> layout_;
    std::optional<OtherKind> blue_kind_, alpha_kind_;
};

// --blue-out, --alpha-out, --length-out.
class OtherFiles {
public:
    // The parameters must outlive this.
    void add(Command& command, const FileOptions& files, const NormalsReader& reads);
    void amend(Task& task) const;
    // Throws UsageError if an output cannot hold one channel of pictures.
    void check(const std::vector<Task>& tasks) const;
    // Sets PackFileOptions::blue_file, alpha_file and length_file.
    void apply(const Task& task, PackFileOptions& options) const;
    // Adds the files that were written after the normals to the job's outputs and report.
    void report(Job& job) const;

private:
    struct Apart {
        const char* option;
        const char* key;   // in reports
        const char* what;  // in the help
        std::string OtherFiles::*pattern;
        std::optional<OtherFile> PackFileOptions::*file;
    };
    static const std::array<Apart, 3> kApart;

    [[nodiscard]] std::optional<OtherFile> file(const Apart& apart, const Task& task) const;

    const FileOptions* files_ = nullptr;
    std::string blue_, alpha_, length_;  // patterns
};

}  // namespace tex::cli
