// SPDX-License-Identifier: Apache-2.0
// normals.h: the option group of commands that read normal maps, and the step that reads them.

#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <tex/container.h>
#include <tex/source.h>

#include "batch/job.h"
#include "cli/command.h"

namespace tex::cli {

// The encoding of an output that keeps its input's, unless the user names one: the input's if both are textures or both
// are pictures and the output can hold it, else the container's own.
[[nodiscard]] Encoding encoding_of(const SourceInfo& input, const Task& task);

// Puts the format and swizzle of the job's input into its report.
void report_input(Job& job, const SourceInfo& info);

enum class Bc5Order { xy, yx };

inline constexpr Named<Bc5Order> kBc5OrderNames[] = {
    {Bc5Order::xy, "xy", "x first, as Direct3D's BC5"},
    {Bc5Order::yx, "yx", "y first, as ATI2 files"},
};

// How one file is read, if not as the options say for all.
struct Reading {
    bool base_only = false;       // without the smaller levels
    bool is_detail = false;       // what the file says about y counts before --y-in, which is the base's
    std::optional<YAxis> y = {};  // counts before all of that
    std::optional<bool> keep_length = {};
};

class NormalsReader {
public:
    std::optional<Swizzle> swizzle;  // none: as the file says, else as its texels look
    bool rg_or_ag = false;           // x in R or A, whichever is not constant
    std::optional<Bc5Order> bc5_order;
    UnpackOptions unpack;

    // `with_keep_length`: --keep-length is an option; other commands choose themselves.
    void add(Command& command, bool with_keep_length = true);

    // The same for the library.
    [[nodiscard]] SourceOptions options(const Job& job, const Reading& reading = {}) const;

    // Warns about what was overlooked in `path`, and counts what was guessed. Any thread may call.
    void note(Job& job, const std::string& path, const SourceInfo& info);

    // Reads and unpacks `path`; calls note(). Any thread may call.
    [[nodiscard]] Result<Source> read(Job& job, const std::string& path, const Execution& execution,
                                      const Reading& reading = {});

    // The same for the job's input; calls report_input().
    [[nodiscard]] Result<Source> read(Job& job, double until, bool base_only);

    // A warning for each layout that was guessed from texels, with the first of its files.
    void warn_of_guesses(Console& console) const;

private:
    struct Guesses {
        std::string first;  // file
        int count = 0;
    };

    std::mutex mutex_;
    std::map<std::string, Guesses> guesses_;  // by the name of the swizzle
};

}  // namespace tex::cli
