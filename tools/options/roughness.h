// SPDX-License-Identifier: Apache-2.0
// roughness.h: the option group of a roughness map that is written together with a mip chain.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/mip.h>
#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/files.h"
#include "options/heights.h"
#include "tasks/engines.h"
#include "tasks/job.h"

namespace tex::cli {

// The formats that a roughness map may have, with the names that --roughness-format accepts.
inline constexpr Named<Format> kRoughnessFormatNames[] = {
    {Format::bc4_unorm, "bc4", "BC4"},
    {Format::bc5_unorm, "bc5", "BC5, R and G"},
    {Format::eac_r11_unorm, "eac-r11", "EAC R11"},
    {Format::eac_rg11_unorm, "eac-rg11", "EAC RG11, R and G"},
    {Format::astc_4x4_unorm, "astc-4x4", "ASTC, as luminance"},
    {Format::astc_5x4_unorm, "astc-5x4", "ASTC, as luminance"},
    {Format::astc_5x5_unorm, "astc-5x5", "ASTC, as luminance"},
    {Format::astc_6x5_unorm, "astc-6x5", "ASTC, as luminance"},
    {Format::astc_6x6_unorm, "astc-6x6", "ASTC, as luminance"},
    {Format::astc_8x5_unorm, "astc-8x5", "ASTC, as luminance"},
    {Format::astc_8x6_unorm, "astc-8x6", "ASTC, as luminance"},
    {Format::astc_8x8_unorm, "astc-8x8", "ASTC, as luminance"},
    {Format::uastc_4x4_unorm, "uastc", "UASTC of Basis Universal: R, G and B"},
    {Format::r8_unorm, "r8", "8 bits"},
    {Format::rgb8_unorm, "rgb8", "3 x 8 bits"},
    {Format::rgba8_unorm, "rgba8", "4 x 8 bits"},
    {Format::r16_unorm, "r16", "16 bits"},
    {Format::rgb16_unorm, "rgb16", "3 x 16 bits"},
    {Format::rgba16_unorm, "rgba16", "4 x 16 bits"},
    {Format::r16_float, "half", "16-bit floats"},
    {Format::rgb16_float, "rgb16f", "3 x 16-bit floats"},
    {Format::rgba16_float, "rgba16f", "4 x 16-bit floats"},
    {Format::r32_float, "float", "32-bit floats"},
};

// --roughness-out, --roughness-into, --roughness-in, --roughness-model, --roughness-format.
class RoughnessOptions {
public:
    // `files` must outlive this.
    void add(Command& command, const FileOptions& files);

    [[nodiscard]] bool is_given() const { return !output_.empty() || !into_.file.empty(); }

    // Adds the files that the options read and write to the task.
    void amend(Task& task) const;

    // Throws UsageError if an output cannot hold the levels that the user requests (0: all), or what the engine reads.
    void check(const std::vector<Task>& tasks, int levels) const;

    // The options in the form that the library takes. It reads the files of --roughness-in and --roughness-into when it
    // needs them. The job must outlive it.
    [[nodiscard]] RoughnessFile file(Job& job, Effort effort) const;
    // Adds the map, if one was written after the normals, to the job's report.
    void report(Job& job, const PackFileReport& packed) const;

private:
    void take_input(const std::string& text);
    void take_into(const std::string& text);
    // Whether the file of --roughness-into is replaced.
    [[nodiscard]] bool is_in_place() const { return output_.empty() && !into_.file.empty(); }
    [[nodiscard]] ChannelFile expanded(const ChannelFile& pattern, const Task& task) const;
    // The map of the material's own roughness; without a file: the number.
    [[nodiscard]] ChannelFile input_of(const Task& task) const;
    [[nodiscard]] std::string output_of(const Task& task) const;
    [[nodiscard]] RoughnessUse use_of(const Task& task) const;
    [[nodiscard]] RoughnessParts parts_for(const Task& task) const;
    // None: that of the file of --roughness-into.
    [[nodiscard]] std::optional<Format> format_in(Container container, const Task& task) const;
    void check_format(const Task& task, const std::string& path, Container container) const;

    const FileOptions* files_ = nullptr;
    std::string output_;  // a pattern
    ChannelFile into_;    // its file is a pattern
    ChannelFile input_;   // its file is a pattern; empty: value_, or into_ if that is not given
    std::optional<float> value_;
    RoughnessModel model_ = RoughnessModel::toksvig;
    std::optional<Format> format_;
};

}  // namespace tex::cli
