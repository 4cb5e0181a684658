// SPDX-License-Identifier: Apache-2.0
// roughness.h: the option group of a roughness map that is written beside a mip chain.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/roughness.h>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/heights.h"
#include "cli/job.h"

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

    // Reads what --roughness-in names and builds the roughness of every level.
    [[nodiscard]] Result<RoughnessChain> build(Job& job, const NormalMap& base, const MipOptions& mip,
                                               const Execution& execution) const;
    // Writes it, after the normal map. Tells the job's report.
    [[nodiscard]] Result<void> write(Job& job, const RoughnessChain& chain, const OutputOptions& options,
                                     const Execution& execution) const;

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
