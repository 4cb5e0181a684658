// SPDX-License-Identifier: Apache-2.0
// The size of a texel, in doubles by + - * / and sqrt alone, so that it has the same bits everywhere.

#include "rows/ground.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "rows/math.h"
#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

constexpr double kDegree = math::kPi / 180.0;
constexpr double kLeastCosine = 1e-12;  // at a pole, all columns are in one place
constexpr double kMostStrength = 0x1p20;

// The northing or the latitude, as the file has it.
double north_of(const Ground& ground, double row) {
    return ground.north + (ground.north_up ? -ground.height : ground.height) * row;
}

// Tiles of one terrain compute the same latitude from different borders. The sums differ in the last bits, which are
// rounded off: a billionth of a degree is a tenth of a millimetre.
double rounded(double degrees) {
    constexpr double kSteps = 1e9;
    return std::floor(degrees * kSteps + 0.5) / kSteps;
}

struct Latitude {
    double sine, cosine;
};

Latitude latitude_in_degrees(double degrees) {
    const double angle = rounded(degrees) * kDegree;
    return {math::sin(angle), math::cos(angle)};
}

// Web Mercator has a latitude phi at a sinh(northing / a) = tan(phi), on a sphere of radius a.
Latitude latitude_of_northing(double northing, double radius) {
    const double grown = math::exp(northing / radius), shrunk = 1.0 / grown;
    return {(grown - shrunk) / (grown + shrunk), 2.0 / (grown + shrunk)};
}

float limited(double strength) { return static_cast<float>(std::min(strength, kMostStrength)); }

}  // namespace

Result<void> check_ground(const Ground& ground) {
    if (auto known = check_known("ground: unit", kGroundUnitNames, ground.unit); !known) return known;
    const double sizes[] = {ground.width, ground.height, ground.equator_radius, ground.pole_radius,
                            ground.height_metres};
    if (!std::all_of(std::begin(sizes), std::end(sizes), [](double size) { return size > 0.0 && std::isfinite(size); }))
        return bad_option("ground: sizes must be above 0");
    if (!std::isfinite(ground.north)) return bad_option("ground: north must be finite");
    return {};
}

bool have_unit(const PictureFacts& facts, const HeightSource& source) {
    switch (source.mixture) {
        case HeightChannel::terrain_rgb:
        case HeightChannel::terrarium: return true;
        case HeightChannel::rg16:
        case HeightChannel::gr16: return source.has_numbers;
        default: return source.plane >= 0 && facts.sample == SampleKind::floating;
    }
}

double latitude_of(const Ground& ground, double row) {
    const double north = north_of(ground, row);
    switch (ground.unit) {
        case GroundUnit::metre: break;
        case GroundUnit::degree: return rounded(north);
        case GroundUnit::mercator: {
            const Latitude at = latitude_of_northing(north, ground.equator_radius);
            return math::atan(at.sine / std::max(at.cosine, kLeastCosine)) / kDegree;
        }
    }
    return 0.0;
}

TexelSize texel_size(const Ground& ground, double row) {
    if (ground.unit == GroundUnit::metre) return {ground.width, ground.height};
    const bool is_mercator = ground.unit == GroundUnit::mercator;
    const double a = ground.equator_radius, b = ground.pole_radius, north = north_of(ground, row);
    const Latitude at = is_mercator ? latitude_of_northing(north, a) : latitude_in_degrees(north);
    const double cosine = std::max(at.cosine, kLeastCosine);
    const double across = is_mercator ? ground.width / a : ground.width * kDegree;
    const double along = is_mercator ? ground.height / a * cosine : ground.height * kDegree;
    const double squeezed = b / a * (b / a);  // 1 - e^2
    const double rest = 1.0 - (1.0 - squeezed) * at.sine * at.sine, root = std::sqrt(rest);
    return {across * a * cosine / root, along * a * squeezed / (rest * root)};
}

Strength strength_on_ground(const Ground& ground, double row) {
    const TexelSize size = texel_size(ground, row);
    return {limited(ground.height_metres / size.width), limited(ground.height_metres / size.height)};
}

}  // namespace tex::inline v1
