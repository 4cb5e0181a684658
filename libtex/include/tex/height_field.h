// SPDX-License-Identifier: Apache-2.0
// height_field.h: heights, what lies beyond their border, and how steep they are.
//
// bake() reads a HeightField. height_field() makes one from an Image: it picks the channel, inverts, smooths terraces,
// replaces invalid texels and blurs, in that order.

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tex/deband_options.h>
#include <tex/execution.h>
#include <tex/image.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// What lies beyond the border of an axis of n texels.
//
//             heights                                        vectors and colours (mip filters)
//   repeat    h[i + n] = h[i]                                the same
//   clamp     h[-k] = 2 h[0] - h[k]: a ramp keeps its slope  the border texel again
//   mirror    h[-1 - k] = h[k] (GL_MIRRORED_REPEAT)          the same; vectors are not flipped
//
// If a filter is wider than the axis, the rules apply repeatedly. An axis of one texel has slope 0.
enum class Wrap { repeat, clamp, mirror };

inline constexpr Named<Wrap> kWrapNames[] = {
    {Wrap::repeat, "repeat", "the texture tiles"},
    {Wrap::clamp, "clamp", "heights continue their slope, filters repeat the border texel"},
    {Wrap::mirror, "mirror", "the texture is mirrored at its border"},
};

// Heights; white (greater) is high. bumpiness_x and bumpiness_y are the height of value 1.0 in texel widths along each
// axis. They are finite; 0 is flat, and negative values turn bumps into dents.
struct HeightField {
    Plane<float> height;
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

// Strength from units, as texel widths for the height of value 1.0 (Strength::x, Strength::y).
struct Strength {
    float x = 1.0f;
    float y = 1.0f;
};

// World units: value 1.0 is `range` high, the whole texture is `width` wide and `height` high, all in one unit (metres,
// for example). height = 0 means square texels. x = range * columns / width, y = range * rows / height: the same
// surface at 512 and at 2048 texels gives the same normals. Clamped to the range of float. Precondition: width > 0,
// height >= 0, all finite.
[[nodiscard]] Strength strength_from_world(Extent extent, double range, double width, double height = 0.0);

// Value 1.0 is `r` texture widths high, texels are square: x = y = r * columns. Clamped to the range of float.
// Precondition: r is finite.
[[nodiscard]] Strength strength_from_uv(Extent extent, double r);

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
    // Heights in two or three bytes; the picture has 8 bits.
    terrain_rgb,  // -10000 + 0.1 (65536 R + 256 G + B) metres (Mapbox)
    terrarium,    // 256 R + G + B / 256 - 32768 metres (Mapzen)
    rg16,         // 256 R + G, divided by 65535 unless ReadOptions::values is `stored`
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
};

struct HeightOptions {
    HeightChannel channel = HeightChannel::automatic;
    std::string channel_name;  // the whole name of a channel, such as "height.Y", instead of `channel`
    // Texels of exactly this value (after rounding to float) are invalid. It is the number that the file stores, before
    // Image::scale and Image::offset; where integers are read as fractions of their range, the fraction will do too.
    // None: Image::no_data, if the file names it. NaN: no value is.
    std::optional<float> no_data;
    bool fill_invalid = false;    // invalid texels take the value of the nearest valid one
    bool invert = false;          // h becomes 1 - h, for maps in which white is low
    Deband deband = Deband::off;  // heights regain the bits that rounding took away: see deband.h
    float blur_sigma = 0.0f;      // standard deviation of a Gaussian blur in texels; 0 is none; at most 256
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

// What height_field() found, for warnings and reports.
struct HeightReport {
    std::int64_t luma_texels = 0;     // texels for which `automatic` used luma because R, G, B differ
    std::int64_t invalid_texels = 0;  // NaN, infinite or no-data texels, all of which were filled
    DebandReport deband = {};         // all zeros if HeightOptions::deband is off
    // With terrain_rgb and terrarium: texels lower than -12000 m or higher than 9000 m. With rg16: those with R = G, as
    // all texels of a grey picture have.
    std::int64_t implausible_texels = 0;
    bool stored = false;  // as Image::stored
    std::string remark;   // as Image::remark
};

// Makes a height field of strength 1 from a picture.
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
//                     terrain_rgb, terrarium and rg16 need; blur_sigma out of range
//         bad_data    invalid texels without fill_invalid (the reason names the column and row of the first texel, and
//                     the count); or no valid texel at all
//         out_of_memory, cancelled
// `report` may be null. The result is the same for every number of threads.
[[nodiscard]] Result<HeightField> height_field(const Image& image, const HeightOptions& options,
                                               const Execution& execution = {}, HeightReport* report = nullptr);

}  // namespace tex
#pragma GCC visibility pop
