// SPDX-License-Identifier: Apache-2.0
// roughness.h: the option group of a roughness map that is written beside a mip chain.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/pipeline.h>
#include <tex/roughness.h>

#include "batch/files.h"
#include "batch/job.h"
#include "cli/command.h"
#include "options/heights.h"

namespace tex::cli {

// The formats that roughness goes into, by the names that --roughness-format takes.
inline constexpr Named<Format> kRoughnessFormatNames[] = {
    {Format::bc4_unorm, "bc4", "BC4"},
    {Format::r8_unorm, "r8", "8 bits"},
    {Format::r16_unorm, "r16", "16 bits"},
    {Format::r16_float, "half", "16-bit floats"},
    {Format::r32_float, "float", "32-bit floats"},
};

// --roughness-out, --roughness-in, --roughness-model, --roughness-format.
class RoughnessOptions {
public:
    // Tells `files` of what is read and written besides; it must outlive this.
    void add(Command& command, FileOptions& files);

    [[nodiscard]] bool is_given() const { return !output_.empty(); }

    // Throws UsageError where an output cannot hold the levels. `levels` are those asked for, 0 for all.
    void check(const std::vector<Task>& tasks, int levels) const;

    // What the library makes of them; it reads what --roughness-in names when it needs it. The job must outlive it.
    [[nodiscard]] RoughnessFile file(Job& job, Effort effort) const;
    // Tells the job's report of a map that has been written after the normals; nothing where none was asked for.
    void tell(Job& job, const PackFileReport& packed) const;

private:
    void take_input(const std::string& text);
    [[nodiscard]] ChannelFile input_of(const Task& task) const;
    [[nodiscard]] std::string output_of(const Task& task) const;
    [[nodiscard]] Format format_in(Container container) const;

    FileOptions* files_ = nullptr;
    std::string output_;  // a pattern
    ChannelFile input_;   // its file is a pattern; empty: value_
    float value_ = 0.0f;
    RoughnessModel model_ = RoughnessModel::toksvig;
    std::optional<Format> format_;
};

}  // namespace tex::cli
