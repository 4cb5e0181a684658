// SPDX-License-Identifier: Apache-2.0
// heights.h: the option groups of commands that read height maps, and the code that reads them.

#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/bake.h>
#include <tex/height.h>

#include "cli/command.h"
#include "options/input_kind.h"
#include "tasks/job.h"

namespace tex::cli {

// Heights with a greater BakeFileReport::border_ratio do not repeat.
inline constexpr double kWallRatio = 2.0;

// --color-space, --ocio-config and the environment variable OCIO.
struct ColorGroup {
    ColorOptions color;  // without the environment variable

    void add(Command& command);
    [[nodiscard]] bool is_given() const { return !color.space.empty(); }
    [[nodiscard]] ColorOptions options() const;

    // Tries the conversion, so that a name that the configuration lacks is found before any file is read. Throws
    // UsageError for such a name; returns an error if the configuration cannot be read.
    [[nodiscard]] Result<void> check() const;

    // The configuration, if it is a file, and the tables that it uses, because outputs depend on them.
    [[nodiscard]] std::vector<std::string> files() const;
};

// Strength: --bumpiness, --height-range with --world-size, --uv-height. At most one of the three; --vertical-scale
// multiplies any of them.
struct StrengthOptions {
    float bumpiness = HeightField{}.bumpiness_x;
    bool measured = false;  // --bumpiness auto
    bool is_given = false;  // any of the options
    std::optional<double> height_range;
    double width = 0.0;
    double height = 0.0;
    std::optional<double> uv_height;
    float vertical_scale = 1.0f;

    // `can_measure`: --bumpiness takes the word auto, and there is --vertical-scale.
    void add(Command& command, bool can_measure = false);
    // The option that sets the strength; empty if none does.
    [[nodiscard]] std::string given_name() const;
    [[nodiscard]] Strength strength(Extent extent) const;
};

// --kernel.
struct KernelOption {
    BakeOptions bake;

    void add(Command& command, std::string help);
};

// --channel, --heights, --raw, --invert, --deband, --blur, --fill-invalid, --no-data.
struct HeightGroup {
    HeightOptions options;
    FileValues values = FileValues::automatic;
    std::string raw;

    [[nodiscard]] ReadOptions read_options(const Job& job) const {
        ReadOptions read = job.read_options;
        read.values = values;
        read.raw = raw;
        return read;
    }

    void add(Command& command);
};

// Writes into the job's report what debanding found. Who asked for it and does not get it is told why.
void note_deband(Job& job, const DebandReport& report, Deband when, const std::string& file = {});

// FILE[:CHANNEL]: one channel of a picture, for a mask or a roughness map.
struct ChannelFile {
    std::string file;
    HeightChannel channel = HeightChannel::automatic;
};
[[nodiscard]] ChannelFile parse_channel_file(const std::string& text);
[[nodiscard]] Result<Plane<float>> read_channel(Job& job, const ChannelFile& source, const Execution& execution);
// read_channel() of a picture whose channels must hold the same unless one is named: luma would be none of them.
// `advice` ends the error of others, such as "name the one ...".
[[nodiscard]] Result<Plane<float>> read_only_channel(Job& job, const ChannelFile& source, const std::string& advice);

// Reads the heights of jobs with all of the groups above, and prints the warnings about them.
class HeightReader {
public:
    StrengthOptions strength;
    ColorGroup color;
    HeightGroup heights;

    // Adds to `error`, which comes from reading or baking heights, the option that avoids it, if there is one.
    [[nodiscard]] static Error with_remedy(const Error& error);

    // Adds the file in which a BIL keeps its header to what its output depends on.
    static void add_header_file(Task& task);

    // An error if the job's input is a normal map.
    [[nodiscard]] Result<void> accept(const Job& job) const;

    // What the job's picture is, if its luma was taken for heights without anybody asking for it.
    [[nodiscard]] JudgedColours judge(const Job& job, const HeightReport& report) const;

    // Counts the results of reading a job's heights. Any thread may call this.
    void note(Job& job, const HeightReport& report, const JudgedColours& judged);
    void note(Job& job, const HeightReport& report) { note(job, report, judge(job, report)); }

    // Prints one warning for all files about which the same must be said.
    void warn_of_files(Console& console) const;

private:
    // Files that are read in parallel arrive in any order. The alphabetically first one is named.
    struct FileCount {
        std::string first;
        std::int64_t files = 0;

        void add(const std::string& file) {
            if (files++ == 0 || file < first) first = file;
        }
        [[nodiscard]] std::string text() const;
    };

    std::mutex mutex_;
    FileCount luma_, stored_;
    std::int64_t luma_texels_ = 0;
};

}  // namespace tex::cli
