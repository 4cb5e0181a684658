// SPDX-License-Identifier: Apache-2.0
// kind.h: what a picture holds: normals, or colours and data in the place of a normal map.

#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// How colours are turned into vectors.
enum class Reading {
    as_stored,
    srgb_encoded,   // after encoding as sRGB, which undoes a decoding
    srgb_decoded,   // after decoding
    premultiplied,  // divided by alpha
    z_from_zero,    // blue is z itself, not (z + 1) / 2
    y_z_x,          // x, y and z in A, B and G
};
inline constexpr int kReadings = 6;

// What the colours show, as vectors: those of up to 2^16 texels that are spread over the map. Values are rounded to 8
// bits first.
struct KindMeasure {
    struct Vectors {
        double unit = 0.0;                        // share of vectors whose length is within 0.12 of 1
        double x = 0.0, y = 0.0, z = 0.0;         // medians
        [[nodiscard]] double off_centre() const;  // the larger of |x| and |y|
    };
    std::array<Vectors, kReadings> reading;
    [[nodiscard]] const Vectors& as(Reading r) const { return reading[static_cast<std::size_t>(r)]; }

    std::int64_t texels = 0;
    double correlation = 0.0;    // of x and y: colours are bright or dark in all channels
    double z_correlation = 0.0;  // of z and the z that x and y imply
    double z_deviation = 0.0;    // standard deviation of the z that x and y imply
    double deviation_x = 0.0, deviation_y = 0.0;
    double spread = 0.0;                   // variances of x, y and z, added
    double grey = 0.0;                     // share of texels whose R, G and B are within 6 codes
    double beyond = 0.0;                   // share of texels with x^2 + y^2 above 1.1
    double level = 0.0;                    // share of texels whose x and y are near 0
    double upright = 0.0, inverted = 0.0;  // of these, whose z is near 1, and near -1
    double behind = 0.0;                   // share of vectors with z below -0.1
    double null = 0.0;                     // share of vectors with hardly any length
    bool alpha_varies = false;
    double z_range = 0.0;                // of the stored values of z
    [[nodiscard]] bool is_flat() const;  // x and y vary by no more than noise
};

enum class Kind {
    normals,         // x, y and z, however damaged; or too little to tell
    two_components,  // x and y; blue holds something else, which makes vectors that no normals are
    x_ray,           // x, y and z in A, B and G: textures of the X-Ray engine
    x_lost,          // y alone: R and B are constant, as in DXT5nm, and there is no alpha
    no_map,          // colours, or data
};

// Leaves out the texels that `without` holds, which may be null. Precondition: x and y are stored, unsigned.
KindMeasure measure_kind(const Stored& stored, const Background* without);

// Whether contrast may have moved x and y out of the unit circle: z follows them all the same.
bool are_stretched(const KindMeasure& measure);

// What the measures show. `is_surface` says whether the slopes of x and y are those of a surface, which no colours are;
// it is asked only if the measures leave a choice.
Kind kind_of(const KindMeasure& measure, const Stored& stored, bool is_surface);

// The evidence against normals, for a message. `has_z`: z is stored, so that vectors have lengths.
std::string evidence_text(const KindMeasure& measure, bool has_z);

}  // namespace tex::inline v1
