// SPDX-License-Identifier: Apache-2.0
// repair.h: damage that the rules of check.h prove is undone.

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/check.h>
#include <tex/format.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- repair --------------------------------------------------------------------------------------------------------
//
// Undoes what the rules find, in the one right order, and runs the rules again after each step.

// How certain the repair of a fault is.
enum class RepairClass { safe, likely, choice, never };

inline constexpr Named<RepairClass> kRepairClassNames[] = {
    {RepairClass::safe, "safe", "the texels prove the fault, and undoing it is exact but for rounding"},
    {RepairClass::likely, "likely", "the texels leave another explanation, or other data are possible"},
    {RepairClass::choice, "choice", "the texels do not show which of several repairs is right; an option says so"},
    {RepairClass::never, "never", "only its author can mend it"},
};

// Which channel is the other way round, where the slopes show that one of the two is (N401, N404).
enum class MirroredChannel { green, red };

inline constexpr Named<MirroredChannel> kMirroredChannelNames[] = {
    {MirroredChannel::green, "green", "green, as in maps of the other convention"},
    {MirroredChannel::red, "red", "red, as in a picture that was mirrored from left to right"},
};

// Which way a picture was turned by 90 degrees beside its vectors (N308).
enum class TurnedPicture { left, right };

inline constexpr Named<TurnedPicture> kTurnedPictureNames[] = {
    {TurnedPicture::left, "left", "to the left, counterclockwise"},
    {TurnedPicture::right, "right", "to the right, clockwise"},
};

// What a step does. "Channels" are those that hold x, y and z.
enum class RepairKind {
    change_sign,
    drop_srgb,
    divide_by_alpha,
    encode_srgb,
    decode_srgb,
    undo_tone,
    exchange,
    invert,
    stretch_z,
    rebuild_z,
    invert_part,
    state_y,
    bake_heights,
    straighten,
    fill_background,
    normalize,
    rebuild_levels,
    turn_left,
    turn_right,
    smooth_steps,
};

inline constexpr Named<RepairKind> kRepairKindNames[] = {
    {RepairKind::change_sign, "change-sign", "read the bytes with the other sign"},
    {RepairKind::drop_srgb, "drop-srgb", "declare linear values instead of sRGB"},
    {RepairKind::divide_by_alpha, "divide-by-alpha", "divide by alpha"},
    {RepairKind::encode_srgb, "encode-srgb", "encode with the sRGB curve"},
    {RepairKind::decode_srgb, "decode-srgb", "decode with the sRGB curve"},
    {RepairKind::undo_tone, "undo-tone", "take a change of levels back"},
    {RepairKind::exchange, "exchange", "exchange two channels"},
    {RepairKind::invert, "invert", "invert a channel"},
    {RepairKind::stretch_z, "stretch-z", "store z as (z + 1) / 2"},
    {RepairKind::rebuild_z, "rebuild-z", "rebuild z from x and y"},
    {RepairKind::invert_part, "invert-part", "invert green in a part of the map"},
    {RepairKind::state_y, "state-y", "state the direction of green that the texels show"},
    {RepairKind::bake_heights, "bake-heights", "bake normals from the heights"},
    {RepairKind::straighten, "straighten", "turn all vectors so that their mean points straight out"},
    {RepairKind::fill_background, "fill-background", "fill the background with the nearest normals"},
    {RepairKind::normalize, "normalize", "make vectors unit"},
    {RepairKind::rebuild_levels, "rebuild-levels", "build the smaller levels from the base level"},
    {RepairKind::turn_left, "turn-left", "turn all vectors by 90 degrees to the left, as the picture was"},
    {RepairKind::turn_right, "turn-right", "turn all vectors by 90 degrees to the right, as the picture was"},
    {RepairKind::smooth_steps, "smooth-steps", "smooth the steps between few values"},
};

// What repair() does about a rule.
struct RuleRepair {
    std::string_view rule;  // its id
    RepairClass certainty = RepairClass::safe;
    RepairKind kind = RepairKind::normalize;
};

// All of them, in the order in which they are applied. Steps that say how bytes are read come first, then those of
// channels, of directions, of vectors, of levels. N308 has three rows: a channel that holds z in the wrong place is
// safe; x and y exchanged is likely, and is undone only if the direction of green is required or stated by the file; a
// picture that was turned is a choice, and safe if RepairOptions::turned or, with that direction, the heights say how.
// N401 and N404 are safe if the heights or RepairOptions::mirrored decide, and N210 if RepairOptions::bumpiness is
// given; without these they are a choice, which repair() does not make. N112 inverts green as the file states it, which
// is safe; if the texels show that green is as required, the statement is wrong or red is mirrored, which is a choice,
// too.
[[nodiscard]] TEX_API std::span<const RuleRepair> rule_repairs();

// The lowest class of a rule's rows; never if it has none.
[[nodiscard]] TEX_API RepairClass repair_class(const Rule& rule);

// One step of a plan.
struct RepairStep {
    const Rule* rule = nullptr;  // whose finding it removes
    RepairKind kind = RepairKind::normalize;
    RepairClass certainty = RepairClass::safe;
    int channel = -1, other = -1;            // of exchange, invert, and undo_tone of one channel: 0 to 3 for R, G, B, A
    std::optional<Region> part = {};         // of invert_part
    std::optional<ToneCurve> tone = {};      // of undo_tone
    std::optional<ChannelTones> tones = {};  // of undo_tone, instead of `tone`: of each channel by itself
    std::optional<YAxis> y = {};  // of a turn: the direction of green, where the slopes show it and nothing states it
    // The mean angle by which it changes the normals of the base level; in maps of 8 Mtexels or more, of evenly spread
    // bands of rows.
    double degrees = 0.0;
};

// "exchange R and B", "decode with the sRGB curve".
[[nodiscard]] TEX_API std::string text_of(const RepairStep& step);

// What repair() would do about a finding of check(), without trying it; nothing if it would do nothing.
[[nodiscard]] TEX_API std::optional<RepairStep> repair_of(const Finding& finding, const CheckReport& report,
                                                          const CheckOptions& checks = {});

struct RepairOptions {
    CheckOptions checks = {};                      // `mesh` and `model` must be null
    bool likely = false;                           // likely repairs, too
    std::vector<std::string> only = {};            // ids or names of rules; empty: all
    std::vector<std::string> skip = {};            // takes precedence over `only`
    std::optional<MirroredChannel> mirrored = {};  // which channel N401 and N404 are about; none: the heights decide
    std::optional<TurnedPicture> turned = {};      // how the picture of N308 was turned; none: the heights decide
    std::optional<float> bumpiness = {};   // bakes heights in place of normals (N210): the height of white in texels
    Effort effort = PackOptions{}.effort;  // of block encoders
    MipOptions mip = {};                   // of levels that are built
};

// Whether every option is in its range. repair() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const RepairOptions& options);

// A fault that is left.
struct FaultLeft {
    Finding finding;
    // likely: RepairOptions::likely would repair it; choice: RepairOptions::mirrored, turned or bumpiness would.
    RepairClass certainty = RepairClass::never;
};

struct Repaired {
    // The result, in the format of the source. If that cannot be written with this layout (BC1, BC7, BC3 with data in
    // R), it is rgba8_unorm or rgba16_float. Nothing: there was no step, and the source stays.
    std::optional<Texture> texture;
    std::vector<RepairStep> steps;
    CheckReport before, after;
    std::vector<FaultLeft> left;  // of `after`, without those that `only` and `skip` leave out

    // Whether an error is left. The map is then not what it ought to be, and the commands do not write it.
    [[nodiscard]] TEX_API bool has_errors() const;
};

// Repairs a texture. `file` is its name in the reports. A step is kept only if check() no longer has the finding that
// called for it; otherwise it is taken back, and the finding is left. Values are rounded once: the steps are applied to
// decoded floats, of all levels. Codes that no step changes stay, except in blocks, which are encoded again, and so do
// data beside the normals. Two damages can hide each other, so that the picture seems to be no normal map (N214): with
// RepairOptions::likely, one of divide_by_alpha, exchange, encode_srgb, decode_srgb and invert is then tried first, and
// kept if no error is left.
//
//     encode_srgb        c' = 12.92 c up to 0.0031308, 1.055 c^(1/2.4) - 0.055 above (IEC 61966-2-1)
//     decode_srgb        its inverse
//     divide_by_alpha    c' = min(c / alpha, 1); where alpha is 0, the vector is lost and becomes (0, 0, 1)
//     undo_tone          c' = black + (white - black) c^gamma, of RepairStep::tone
//     invert             c' = 1 - c, or -c if values are signed
//     stretch_z          c' = (c + 1) / 2
//     turn_left          (x, y)' = (-y, x), with y up; turn_right is its inverse
//     smooth_steps       the field of least bending within half a step, as deband() finds it, of x and of y, and z that
//                        they imply; for N305, of the heights behind the slopes; smaller levels are built again
//
// Precondition (asserted): the texture has at least one level, each with level_bytes() bytes.
// Errors: bad_option (see validate()), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Repaired> repair(const std::string& file, const Texture& texture,
                                              const RepairOptions& options = {}, const Execution& execution = {});

}  // namespace tex::inline v1
