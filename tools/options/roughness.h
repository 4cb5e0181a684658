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
#include "tasks/job.h"

namespace tex::cli {

// The formats that a roughness map may have, with the names that --roughness-format accepts.
inline constexpr Named<Format> kRoughnessFormatNames[] = {
    {Format::bc4_unorm, "bc4", "BC4"},
    {Format::eac_r11_unorm, "eac-r11", "EAC R11"},
    {Format::astc_4x4_unorm, "astc-4x4", "ASTC, as luminance"},
    {Format::astc_5x4_unorm, "astc-5x4", "ASTC, as luminance"},
    {Format::astc_5x5_unorm, "astc-5x5", "ASTC, as luminance"},
    {Format::astc_6x5_unorm, "astc-6x5", "ASTC, as luminance"},
    {Format::astc_6x6_unorm, "astc-6x6", "ASTC, as luminance"},
    {Format::astc_8x5_unorm, "astc-8x5", "ASTC, as luminance"},
    {Format::astc_8x6_unorm, "astc-8x6", "ASTC, as luminance"},
    {Format::astc_8x8_unorm, "astc-8x8", "ASTC, as luminance"},
    {Format::r8_unorm, "r8", "8 bits"},
    {Format::r16_unorm, "r16", "16 bits"},
    {Format::r16_float, "half", "16-bit floats"},
    {Format::r32_float, "float", "32-bit floats"},
};

// --roughness-out, --roughness-in, --roughness-model, --roughness-format.
class RoughnessOptions {
public:
    // `files` must outlive this.
    void add(Command& command, const FileOptions& files);

    [[nodiscard]] bool is_given() const { return !output_.empty(); }

    // Adds the files that the options read and write to the task.
    void amend(Task& task) const;

    // Throws UsageError if an output cannot hold the levels that the user requests (0: all).
    void check(const std::vector<Task>& tasks, int levels) const;

    // The options in the form that the library takes. It reads the file of --roughness-in when it needs it. The job
    // must outlive it.
    [[nodiscard]] RoughnessFile file(Job& job, Effort effort) const;
    // Adds the map, if one was written after the normals, to the job's report.
    void report(Job& job, const PackFileReport& packed) const;

private:
    void take_input(const std::string& text);
    [[nodiscard]] ChannelFile input_of(const Task& task) const;
    [[nodiscard]] std::string output_of(const Task& task) const;
    [[nodiscard]] Format format_in(Container container) const;

    const FileOptions* files_ = nullptr;
    std::string output_;  // a pattern
    ChannelFile input_;   // its file is a pattern; empty: value_
    float value_ = 0.0f;
    RoughnessModel model_ = RoughnessModel::toksvig;
    std::optional<Format> format_;
};

}  // namespace tex::cli
