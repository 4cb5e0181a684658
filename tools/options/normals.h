// SPDX-License-Identifier: Apache-2.0
// normals.h: the option group of commands that read normal maps, and the code that reads them.

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>

#include "cli/command.h"
#include "options/input_kind.h"
#include "tasks/job.h"
#include "tasks/repeated_warnings.h"

namespace tex::cli {

// The encoding of an output that keeps its input's encoding, if the user names none. It is the input's encoding if both
// are textures or both are pictures and the output can hold it, else the container's default.
[[nodiscard]] Encoding encoding_of(const SourceInfo& input, const Task& task);

// Puts the format and swizzle of the job's input into its report.
void report_input(Job& job, const SourceInfo& info);

enum class Bc5Order { xy, yx };

inline constexpr Named<Bc5Order> kBc5OrderNames[] = {
    {Bc5Order::xy, "xy", "x first, as Direct3D's BC5"},
    {Bc5Order::yx, "yx", "y first, as ATI's 3Dc"},
};

// What the lengths of stored vectors are, if they are not 1 by intention.
enum class LengthIn { occlusion, ignore };

inline constexpr Named<LengthIn> kLengthInNames[] = {
    {LengthIn::occlusion, "occlusion", "occlusion, as Terrain3D packs it: 0.5 + 0.5 sqrt(occlusion)"},
    {LengthIn::ignore, "ignore", "nothing: vectors become unit"},
};

// The layout that a word of kSwizzleNames, "labpbr" or the channels of x, y and, if it is stored, z name: "abg",
// "x=a,y=b,z=g". Nothing for "auto" and the words of `more`. Throws UsageError if it is none of these.
std::optional<Swizzle> parse_swizzle(const std::string& text, const std::vector<std::string>& more = {});
// Whether the word names a layout with occlusion in blue.
[[nodiscard]] bool has_occlusion_in_blue(const std::string& swizzle);
// What --swizzle takes.
std::vector<Word> swizzle_words();

// --length-in.
void add_length_in(Command& command, std::optional<LengthIn>& length_in);

// What --y-in and --detail-y-in say: a direction of green, or that the texels show it.
struct YIn {
    std::optional<YAxis> axis;       // none: measured
    std::optional<YAxis> otherwise;  // what it is if the texels do not show it clearly; none: that is an error
};

// An option whose value becomes a YIn, which `set` gets.
Option& add_y_in(Command& command, const char* name, std::string help, std::function<void(YIn)> set);

// How one file is read, if this differs from the options.
struct Reading {
    bool base_only = false;     // without the smaller levels
    bool is_detail = false;     // the file's own y overrides --y-in, which is the base's
    std::optional<YIn> y = {};  // overrides all of that
    std::optional<bool> keep_length = {};
    bool doubt_y = false;                 // warn if y is assumed and the texels clearly show the other direction
    bool object = false;                  // the vectors are in object space
    const ModelInput* model = nullptr;    // the file is this map of a model
    std::optional<ExtraSet> extras = {};  // what goes along beside the normals
    // What of it is not lost; empty: nothing.
    std::function<ExtraSet(const SourceInfo& info)> holds = {};
};

class NormalsReader {
public:
    std::optional<Swizzle> swizzle;  // none: as the file says, else guessed from its texels
    bool rg_or_ag = false;           // x in R or A, whichever is not constant
    std::optional<Bc5Order> bc5_order;
    UnpackOptions unpack;
    std::optional<LengthIn> length_in;
    bool measures_y = false;           // the texels show which way green points
    std::optional<YAxis> y_otherwise;  // as YIn::otherwise
    bool fills_background = false;
    bool warns_of_background = true;  // where the output may mix it into the charts
    bool drops_extras = false;        // channels that hold no normals are left out, and no warning says so

    // `with_keep_length`: --keep-length is an option. Otherwise the command itself chooses. `keeps_extras`: the command
    // writes a map, and what the input holds beside its normals goes along.
    void add(Command& command, bool with_keep_length = true, bool keeps_extras = true);

    // What was given, as options of the library.
    [[nodiscard]] SourceOptions options(const Job& job, const Reading& reading = {}) const;

    // What the file is, if the texels that were read raise a doubt about it.
    [[nodiscard]] std::optional<JudgedPicture> judged(const Job& job, const std::string& path,
                                                      const SourceInfo& info) const;
    // An error if it is no normal map.
    [[nodiscard]] Result<void> accept(const Job& job, const std::string& path, const SourceInfo& info) const;

    // Prints the remarks about `path` as warnings, and counts guesses. Any thread may call this.
    void note(Job& job, const std::string& path, const SourceInfo& info);

    // Reads and unpacks `path`, and calls note(). Any thread may call this.
    [[nodiscard]] Result<Source> read(Job& job, const std::string& path, const Execution& execution,
                                      const Reading& reading = {});

    // Reads the job's input. Calls report_input(), too.
    [[nodiscard]] Result<Source> read(Job& job, double until, bool base_only);

    // Prints a warning for each layout that was guessed from texels, with the first of its files.
    void warn_of_guesses(Console& console) const { guesses_.print(console); }

private:
    // Warns of what seems to be something else than normals. Returns false if it is no normal map at all.
    bool warn_of_kind(Job& job, const std::string& path, const SourceInfo& info) const;
    void warn_of_extras(Job& job, const std::string& path, const SourceInfo& info) const;

    bool keeps_extras_ = false;
    RepeatedWarnings guesses_;
};

}  // namespace tex::cli
