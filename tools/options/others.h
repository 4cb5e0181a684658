// SPDX-License-Identifier: Apache-2.0
// others.h: the option group of commands that write normal maps with other data in blue or alpha.

#pragma once

#include <optional>
#include <string>

#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/files.h"
#include "options/heights.h"
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

// --blue, --alpha, --kind, --layout.
class OtherOptions {
public:
    // `bakes`: the command has heights, and no map whose data could be kept. `output`, whose options have been added
    // and which a layout sets, must outlive the command.
    void add(Command& command, OutputOptions& output, bool bakes);

    [[nodiscard]] bool is_added() const { return is_added_; }

    // Adds the files that the options read to the task.
    void amend(Task& task) const;

    // The options in the form that the library takes. It reads files when it needs them. The job must outlive it.
    [[nodiscard]] OtherInputs inputs(Job& job) const;
    // What of the map that is read goes along.
    void apply(UnpackOptions& unpack) const;
    void apply(MipOptions& mip) const;

private:
    struct Choice {
        enum class From { nothing, kept, heights, number, file };
        From from = From::nothing;
        float number = 1.0f;
        ChannelFile file = {};  // its file is a pattern
    };
    void add_channel(Command& command, const char* option, Choice& choice, bool bakes);
    static void take(const std::string& text, bool bakes, Choice& choice);
    void set_layout(const Command& command, OutputOptions& output);
    void check_room(const OutputOptions& output) const;
    static ChannelFile file_for(const Choice& choice, const Task& task);
    std::optional<OtherData> data(const Choice& choice, Job& job) const;

    bool is_added_ = false;
    Choice blue_;
    Choice alpha_;
    std::optional<Layout> layout_;
    std::optional<OtherKind> blue_kind_, alpha_kind_;
};

// --blue-out, --alpha-out.
class OtherFiles {
public:
    // `files` must outlive this.
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const;
    // Throws UsageError if an output cannot hold one channel of pictures.
    void check(const std::vector<Task>& tasks) const;
    // Sets PackFileOptions::blue_file and alpha_file.
    void apply(const Task& task, PackFileOptions& options) const;
    // Adds the files that were written after the normals to the job's outputs and report.
    void report(Job& job) const;

private:
    [[nodiscard]] std::optional<OtherFile> file(const std::string& pattern, const Task& task) const;

    const FileOptions* files_ = nullptr;
    std::string blue_, alpha_;  // patterns
};

}  // namespace tex::cli
