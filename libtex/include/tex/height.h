// SPDX-License-Identifier: Apache-2.0
// height.h: height fields, what makes them of pictures, and what smooths their terraces.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// -- height field --------------------------------------------------------------------------------------------------
//
// Heights, what lies beyond their border, and how steep they are.
//
// bake() reads a HeightField. height_field() makes one from an Image: it picks the channel, inverts, smooths terraces,
// replaces invalid texels and blurs, in that order.

enum class Deband { off, automatic, on };

inline constexpr Named<Deband> kDebandNames[] = {
    {Deband::off, "off", "heights stay as they are"},
    {Deband::automatic, "auto", "if heights lie on steps, and at least a tenth of the texels on terraces"},
    {Deband::on, "on", "if heights lie on steps"},
};

// What deband() found. A texel lies on a terrace if it has the height of both of its neighbours, along x or along y.
struct DebandReport {
    bool applied = false;             // whether heights were changed
    float step = 0.0f;                // the height of a step; 0: heights lie on no steps
    int codes = 0;                    // the number of steps from the lowest height to the highest, both counted; or 0
    std::int64_t terrace_texels = 0;  // texels on terraces; 0 if heights lie on no steps
};

// Heights; white (greater) is high. bumpiness_x and bumpiness_y are the height of value 1.0 in texel widths along each
// axis. They are finite; 0 is flat, and negative values turn bumps into dents.
//
// With `ground`, each row has the bumpiness strength_on_ground(*ground, row), and bumpiness_x and bumpiness_y multiply
// it: 1 gives the slopes of the ground, and 2 slopes twice as steep.
struct HeightField {
    Plane<float> height;
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    std::optional<Ground> ground = {};
};

// Strength from units, as texel widths for the height of value 1.0 (Strength::x, Strength::y).
struct Strength {
    float x = 1.0f;
    float y = 1.0f;
};

// World units: value 1.0 is `range` high, the whole texture is `width` wide and `height` high, all in one unit (metres,
// for example). height = 0 means square texels. x = range * columns / width, y = range * rows / height: the same
// surface at 512 and at 2048 texels gives the same normals. Clamped to the range of float. Errors:
// bad_option (width is not above 0, or height below 0; a number is not finite).
[[nodiscard]] TEX_API Result<Strength> strength_from_world(Extent extent, double range, double width,
                                                           double height = 0.0);

// Value 1.0 is `r` texture widths high, texels are square: x = y = r * columns. Clamped to the range of float.
// Errors: bad_option (r is not finite).
[[nodiscard]] TEX_API Result<Strength> strength_from_uv(Extent extent, double r);

// The size of a texel of this row on the ground, in metres. With latitudes (Snyder, Map Projections: A Working Manual,
// USGS 1987, 4-18 to 4-21), for the ellipsoid of radii a and b, e^2 = 1 - b^2 / a^2:
//
//     width  = dlon a cos(lat) / sqrt(1 - e^2 sin^2(lat))          height = dlat a (1 - e^2) / (1 - e^2 sin^2(lat))^1.5
//
// The same bits on every machine. Precondition: the fields of `ground` are finite, and those that must be are above 0.
struct TexelSize {
    double width = 1.0;
    double height = 1.0;
};
[[nodiscard]] TEX_API TexelSize texel_size(const Ground& ground, double row);

// The latitude of the middle of a row, in degrees; 0 with GroundUnit::metre.
[[nodiscard]] TEX_API double latitude_of(const Ground& ground, double row);

// The strength that gives a row of heights the slopes of the ground: height_metres / texel_size(). At most 2^20.
[[nodiscard]] TEX_API Strength strength_on_ground(const Ground& ground, double row);

// Which value of a texel is its height.
enum class HeightChannel {
    automatic,  // the only colour channel; if there are several, for each texel R if R = G = B, else luma
    r,
    g,
    b,
    a,
    y,        // the channel called Y
    luma,     // 0.2126 R + 0.7152 G + 0.0722 B (ITU-R BT.709), of the unchanged values
    average,  // (R + G + B) / 3
    max,      // the largest of R, G, B
    // Heights in two or three bytes; the picture has 8 bits. Where terrain_rgb and terrarium have an alpha of 0, there
    // is no height.
    terrain_rgb,  // -10000 + 0.1 (65536 R + 256 G + B) metres (Mapbox)
    terrarium,    // 256 R + G + B / 256 - 32768 metres (Mapzen)
    rg16,         // 256 R + G, divided by 65535 unless ReadOptions::values is `stored`
    gr16,         // 256 G + R, likewise
};

inline constexpr Named<HeightChannel> kHeightChannelNames[] = {
    {HeightChannel::automatic, "auto", "the only channel; else R where R = G = B, and luma elsewhere"},
    {HeightChannel::r, "r", "red (of a grey picture: grey)"},
    {HeightChannel::g, "g", "green (of a grey picture: grey)"},
    {HeightChannel::b, "b", "blue (of a grey picture: grey)"},
    {HeightChannel::a, "a", "alpha"},
    {HeightChannel::y, "y", "the channel Y, or grey"},
    {HeightChannel::luma, "luma", "0.2126 R + 0.7152 G + 0.0722 B"},
    {HeightChannel::average, "average", "(R + G + B) / 3"},
    {HeightChannel::max, "max", "the largest of R, G and B"},
    {HeightChannel::terrain_rgb, "terrain-rgb", "-10000 + 0.1 (65536 R + 256 G + B) metres"},
    {HeightChannel::terrarium, "terrarium", "256 R + G + B / 256 - 32768 metres"},
    {HeightChannel::rg16, "rg16", "256 R + G, heights of 16 bits in two channels"},
    {HeightChannel::gr16, "gr16", "256 G + R, heights of 16 bits whose low byte is in red"},
};

struct HeightOptions {
    HeightChannel channel = HeightChannel::automatic;
    std::string channel_name;  // the whole name of a channel, such as "height.Y", instead of `channel`
    // Texels of exactly this value (after rounding to float) are invalid. It is the number that the file stores, before
    // Image::scale and Image::offset; where integers are read as fractions of their range, the fraction will do too. If
    // unset, Image::no_data applies (if the file names one). Set it to NaN to treat no finite value as missing, and to
    // ignore the alpha of terrain_rgb and terrarium.
    std::optional<float> no_data;
    bool fill_invalid = false;    // invalid texels take the value of the nearest valid one
    bool invert = false;          // h becomes 1 - h, for maps in which white is low
    Deband deband = Deband::off;  // heights regain the bits that rounding took away: see deband()
    float blur_sigma = 0.0f;      // standard deviation of a Gaussian blur in texels; 0 is none; at most 256
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

// Whether every option is in its range. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const HeightOptions& options);

// What height_field() found, for warnings and reports.
struct HeightReport {
    std::int64_t luma_texels = 0;     // texels for which `automatic` used luma because R, G, B differ
    std::int64_t invalid_texels = 0;  // NaN, infinite or no-data texels, all of which were filled
    DebandReport deband = {};         // all zeros if HeightOptions::deband is off
    // With terrain_rgb and terrarium: texels lower than -12000 m or higher than 9000 m. With rg16 and gr16: those with
    // R = G, as all texels of a grey picture have.
    std::int64_t implausible_texels = 0;
    bool stored = false;                // as Image::stored
    std::string remark;                 // as Image::remark
    std::optional<Ground> ground = {};  // as Image::ground, if the heights are in a unit: see height_field()
    std::string ground_remark = {};     // as Image::ground_remark
};

// The heights of a picture, and what was found on the way.
struct PictureHeights : HeightField {
    HeightReport report;
};

// Makes a height field of strength 1 from a picture. If the picture lies on the ground (Image::ground), and its heights
// are numbers and not fractions of a range, the field does too: its slopes are then those of the ground. Reset
// HeightField::ground to give the field a bumpiness in texel widths.
//
// Channel: see HeightChannel. A picture with planes R, G and B (or red, green and blue, in any case) is coloured; a
// picture of any other single plane, or of one plane and A, is grey. In an EXR file with other names, the only plane
// besides alpha, colours and vectors (X, Y, Z of one layer) holds the heights; if there are several, the plane named
// "Y", "height", "displacement", "Z" or "depth", or a plane of a layer of this name, does. If there is none, the
// colours of the only layer that has them count. If fill_invalid is set, invalid texels (NaN, infinite, equal to
// no_data) take the value of the nearest valid texel (Euclidean distance, wrap respected, ties by the smallest row,
// then column). Blur: a Gaussian of radius ceil(3 sigma), weights normalised to 1, with the field's wrap. Invalid
// texels tell deband() nothing about the heights.
//
// Errors: bad_option  the picture lacks the channel (the reason lists its channels), or has not the 8 bits that
//                     terrain_rgb, terrarium, rg16 and gr16 need; as validate(options)
//         bad_data    rg16 or gr16 whose high byte varies from texel to texel more than twice as much as the low one;
//                     invalid texels without fill_invalid (the reason names the column and row of the first texel, and
//                     the count); or no valid texel at all
//         out_of_memory, cancelled
// The result is the same for every number of threads.
[[nodiscard]] TEX_API Result<PictureHeights> height_field(const Image& image, const HeightOptions& options = {},
                                                          const Execution& execution = {});

// -- deband --------------------------------------------------------------------------------------------------------
//
// Smooth heights from rounded ones.

struct DebandedField : HeightField {
    DebandReport report;
};

// Replaces heights that were rounded to steps (8 bits, for example) by smooth ones that round to the same steps. Slopes
// are then no longer terraces. HeightOptions::deband of height_field() does this while a picture is read.
//
// The steps. Heights lie on steps if all are c + k step for integers k, within 0.6 / 65535 or a quarter of a millionth
// of the largest magnitude, whichever is larger (but at most a tenth of a step). The step is found from the heights
// alone, so that 8 bits are recognised in a file of 16 bits, padded or stretched. There are at most 4096 steps from the
// lowest height to the highest; a step is at most 1/32, or the heights span at least 32 of them. Other heights stay as
// they are: those of 16 bits, floats, and those that a colour space, luma or a blur made uneven.
//
// The heights. With heights in steps, k is the input, h the result and L the difference of the four neighbours' mean
// from a texel, times 4 (the Laplacian):
//
//     the least sum of (L h)^2 + w (h - k)^2,    k - 0.499 <= h <= k + 0.499
//
// that is, the field of least bending energy that rounds to the input, with a pull w >= 0 to the input. No height
// leaves the range from 0 to 1 where the input ends at 0 or at 1. Where the ground is smooth, w is 0. Where it is
// rough, rounding acts as white noise of variance 1/12, and the best estimate is that of a Wiener filter: w is 12 times
// the variance of L h (Wiener 1949). It is estimated as the local mean of (L k)^2, less 20/12 for the noise; the
// means of 2x2 texels must confirm it, with 4 times their energy less 0.6, and an energy of at least 1, so that the
// beat of a steady slope with the steps is not mistaken for roughness. Where w > 300, heights stay at their codes: the
// pull would move them by about 1 / sqrt(12 w), a sixtieth of a step, and the plateaus between cliffs stay flat.
//
// Method: from coarse grids to fine ones; on each, a fixed number of projected gradient steps with momentum (Beck,
// Teboulle 2009): more on coarse grids, where they are cheap and reach far. A coarse grid has every other texel of the
// finer one, with its bounds, and a pull where the ground is rough at that scale. Cubic interpolation takes
// its heights to the finer one (Dubuc 1986). The bending energy is near its least, not at it; the bounds hold exactly.
//
// Texels that are NaN have no bounds and stay NaN; the field bends through them. Wraps are those of the field; with
// Wrap::clamp, slopes continue. Every height depends on all others. Memory: 9 bytes for each texel besides the field.
//
// Errors: bad_option (the field has no texels, or more than kMaxExtent in a direction); out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<DebandedField> deband(HeightField field, Deband when = Deband::on,
                                                   const Execution& execution = {});

// -- color ---------------------------------------------------------------------------------------------------------
//
// Colour spaces of height maps.
//
// Heights are data: libtex reads raw values, whatever a file claims. If a height map was saved with a transfer curve
// nevertheless (painted as sRGB in an image editor, for example), to_linear() makes its values linear again. Normals
// are never converted.

struct ColorOptions {
    // A colour space, role or alias of the configuration; without one, "sRGB" or "linear" (any case).
    std::string space;
    // An OpenColorIO configuration file (or "ocio://..." name); empty: only the built-in sRGB curve.
    std::string config;
};

// Converts the planes R, G and B of `image` (in a grey picture its one plane, as R = G = B) from the colour space
// `options.space` to the configuration's scene_linear role. Alpha and other planes are unchanged. With a configuration,
// OpenColorIO computes the result, which may differ in the last bits between processors; the built-in curve (IEC
// 61966-2-1:1999) gives the same bytes everywhere.
//
// Errors: bad_option  no such colour space (the reason lists some that exist); the configuration has no
//                     scene_linear role
//         io          the configuration cannot be read; unsupported: this libtex was built without OpenColorIO
//         bad_data    the configuration is damaged
//         out_of_memory
[[nodiscard]] TEX_API Result<Image> to_linear(Image image, const ColorOptions& options);

// The files on which to_linear() depends: the configuration, if it is a file, and the tables (LUTs) that it uses for
// the colour space `options.space`. Empty without a configuration. OpenColorIO keeps tables in memory; after this call,
// to_linear() reads them again. Errors: those of to_linear() that concern the configuration.
[[nodiscard]] TEX_API Result<std::vector<std::string>> color_files(const ColorOptions& options);

// The version of OpenColorIO: "2.1.2"; empty in a build without it.
[[nodiscard]] TEX_API const char* opencolorio_version();

}  // namespace tex::inline v1
