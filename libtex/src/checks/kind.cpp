// SPDX-License-Identifier: Apache-2.0

#include "checks/kind.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "checks/centre.h"
#include "checks/findings.h"
#include "checks/texel_counts.h"
#include "checks/thresholds.h"

namespace tex::inline v1 {
namespace {

constexpr double kKindTexels = 1 << 16;
constexpr int kKindUnitTolerance = 12;  // hundredths of a length: JPEG, filters and 8 bits stay within
constexpr float kKindBeyondSquare = 1.1f;
constexpr float kKindUpright = 0.1f, kKindUprightZ = 0.9f, kKindBehindZ = -0.1f;
constexpr int kKindGreyCodes = 6;
constexpr float kKindLeastAlpha = 0.1f;  // below it, dividing by alpha gives noise

using TexelCodes = std::array<std::uint8_t, 4>;  // x, y, z and alpha as stored, in codes of 8 bits
using CodeCounts = std::array<std::int64_t, 256>;

std::uint8_t code_of(float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);  // NaN: anything
}

// What a code stands for, in each reading.
struct Curves {
    std::array<float, 256> plain{}, encoded{}, decoded{};
    Curves() {
        for (std::size_t k = 0; k < 256; ++k) {
            const double c = static_cast<double>(k) / 255.0;
            plain[k] = static_cast<float>(2.0 * c - 1.0);
            encoded[k] = static_cast<float>(2.0 * srgb_encoded(c) - 1.0);
            decoded[k] = static_cast<float>(2.0 * srgb_decoded(c) - 1.0);
        }
    }
};

bool is_unit(float x, float y, float z) {
    constexpr float kTolerance = kKindUnitTolerance / 100.0f;
    constexpr float kLeast = (1.0f - kTolerance) * (1.0f - kTolerance),
                    kMost = (1.0f + kTolerance) * (1.0f + kTolerance);
    const float square = x * x + y * y + z * z;
    return square >= kLeast && square <= kMost;
}

std::size_t median_code(const CodeCounts& bins, std::int64_t count) {
    std::size_t code = 0;
    for (std::int64_t below = bins[0]; 2 * below < count && code < 255; below += bins[code]) ++code;
    return code;
}

struct ValueMoments {
    double sum = 0.0, square = 0.0;
    void add(double value) {
        sum += value;
        square += value * value;
    }
    [[nodiscard]] double variance(double n) const { return std::max(0.0, square / n - (sum / n) * (sum / n)); }
};

double correlation_of(const ValueMoments& a, const ValueMoments& b, double product, double n) {
    constexpr double kLeast = 1e-9;
    const double both = a.variance(n) * b.variance(n);
    return both > kLeast * kLeast ? (product / n - a.sum / n * (b.sum / n)) / std::sqrt(both) : 0.0;
}

class KindSums {
public:
    void add_grey(const TexelCodes& colors) {
        const auto [least, most] = std::minmax({colors[0], colors[1], colors[2]});
        grey_ += most - least <= kKindGreyCodes ? 1 : 0;
    }
    // Without `all`, only the reading as stored is counted.
    void add(const TexelCodes& codes, bool has_z, bool has_alpha, bool all) {
        const Curves& curve = curves();
        const auto at = [&codes](const std::array<float, 256>& table, std::size_t c) { return table[codes[c]]; };
        const float x = at(curve.plain, 0), y = at(curve.plain, 1);
        ++count_;
        for (std::size_t c = 0; c < 3; ++c) ++bins_[c][codes[c]];
        x_.add(x);
        y_.add(y);
        xy_ += static_cast<double>(x * y);
        const float across = x * x + y * y;
        if (across > kKindBeyondSquare) ++beyond_;
        if (!has_z) return;
        const float z = at(curve.plain, 2);
        z_.add(z);
        behind_ += z < kKindBehindZ ? 1 : 0;
        null_ += across + z * z < kNullLength * kNullLength ? 1 : 0;
        if (std::abs(x) < kKindUpright && std::abs(y) < kKindUpright) {
            ++level_;
            upright_ += z > kKindUprightZ ? 1 : 0;
            inverted_ += z < -kKindUprightZ ? 1 : 0;
        }
        if (across <= 1.0f) {
            const float rebuilt = std::sqrt(1.0f - across);
            ++inside_;
            rebuilt_.add(rebuilt);
            inside_z_.add(z);
            z_rebuilt_ += static_cast<double>(z * rebuilt);
        }
        count_unit(Reading::as_stored, x, y, z);
        if (has_alpha) ++alpha_bins_[codes[3]];
        if (!all) return;
        count_unit(Reading::srgb_encoded, at(curve.encoded, 0), at(curve.encoded, 1), at(curve.encoded, 2));
        count_unit(Reading::srgb_decoded, at(curve.decoded, 0), at(curve.decoded, 1), at(curve.decoded, 2));
        count_unit(Reading::z_from_zero, x, y, 0.5f + 0.5f * z);
        if (!has_alpha) return;
        count_unit(Reading::y_z_x, at(curve.plain, 3), z, y);
        const float alpha = std::max(kKindLeastAlpha, static_cast<float>(codes[3]) / 255.0f);
        TexelCodes straight{};
        for (std::size_t c = 0; c < 3; ++c) {
            straight[c] = code_of(static_cast<float>(codes[c]) / 255.0f / alpha);
            ++straight_[c][straight[c]];
        }
        count_unit(Reading::premultiplied, curve.plain[straight[0]], curve.plain[straight[1]],
                   curve.plain[straight[2]]);
    }

    [[nodiscard]] KindMeasure measure() const {
        KindMeasure m;
        const double n = std::max(1.0, static_cast<double>(count_)),
                     inside = std::max(1.0, static_cast<double>(inside_));
        const auto share = [n](std::int64_t count) { return static_cast<double>(count) / n; };
        m.texels = count_;
        const Curves& curve = curves();
        const auto vectors = [&](Reading reading, const std::array<const CodeCounts*, 3>& bins,
                                 const std::array<float, 256>& table) {
            KindMeasure::Vectors& v = m.reading[static_cast<std::size_t>(reading)];
            v.unit = share(unit_[static_cast<std::size_t>(reading)]);
            v.x = table[median_code(*bins[0], count_)];
            v.y = table[median_code(*bins[1], count_)];
            v.z = table[median_code(*bins[2], count_)];
        };
        const std::array<const CodeCounts*, 3> plain{&bins_[0], &bins_[1], &bins_[2]};
        vectors(Reading::as_stored, plain, curve.plain);
        vectors(Reading::srgb_encoded, plain, curve.encoded);
        vectors(Reading::srgb_decoded, plain, curve.decoded);
        vectors(Reading::z_from_zero, plain, curve.plain);
        vectors(Reading::premultiplied, {&straight_[0], &straight_[1], &straight_[2]}, curve.plain);
        vectors(Reading::y_z_x, {&alpha_bins_, &bins_[2], &bins_[1]}, curve.plain);
        m.correlation = correlation_of(x_, y_, xy_, n);
        m.z_correlation = correlation_of(inside_z_, rebuilt_, z_rebuilt_, inside);
        m.z_deviation = std::sqrt(rebuilt_.variance(inside));
        m.deviation_x = std::sqrt(x_.variance(n));
        m.deviation_y = std::sqrt(y_.variance(n));
        m.spread = x_.variance(n) + y_.variance(n) + z_.variance(n);
        m.grey = share(grey_);
        m.beyond = share(beyond_);
        m.level = share(level_);
        const auto used = [](std::int64_t count) { return count > 0; };
        const auto first = std::find_if(bins_[2].begin(), bins_[2].end(), used);
        const auto last = std::find_if(bins_[2].rbegin(), bins_[2].rend(), used);
        if (first != bins_[2].end())
            m.z_range = static_cast<double>((bins_[2].rend() - last) - 1 - (first - bins_[2].begin())) / 255.0;
        m.upright = share(upright_);
        m.inverted = share(inverted_);
        m.behind = share(behind_);
        m.null = share(null_);
        m.alpha_varies = std::count_if(alpha_bins_.begin(), alpha_bins_.end(), used) > 1;
        return m;
    }

private:
    static const Curves& curves() {
        static const Curves kCurves;
        return kCurves;
    }
    void count_unit(Reading reading, float x, float y, float z) {
        unit_[static_cast<std::size_t>(reading)] += is_unit(x, y, z) ? 1 : 0;
    }

    std::int64_t count_ = 0, inside_ = 0, beyond_ = 0, grey_ = 0, behind_ = 0, null_ = 0, level_ = 0, upright_ = 0,
                 inverted_ = 0;
    std::array<std::int64_t, kReadings> unit_{};
    std::array<CodeCounts, 3> bins_{}, straight_{};
    CodeCounts alpha_bins_{};
    ValueMoments x_, y_, z_, inside_z_, rebuilt_;
    double xy_ = 0.0, z_rebuilt_ = 0.0;
};

// The correlation of x and y, if both vary by more than noise: 0 in maps that slope along one axis alone.
double relation_of(const KindMeasure& m) {
    return std::min(m.deviation_x, m.deviation_y) < thresholds::kNoiseOnly ? 0.0 : m.correlation;
}

bool are_vectors(const KindMeasure& m) {
    const KindMeasure::Vectors& v = m.as(Reading::as_stored);
    if (v.unit < thresholds::kUnitShare) return false;
    const bool follows = m.z_correlation > thresholds::kZFollows;
    // One of the three components is near 1 and the others about 0; which one is another rule's business.
    std::array<double, 3> sides{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
    std::sort(sides.begin(), sides.end());
    if (sides[1] <= thresholds::kCentred && (std::abs(m.correlation) <= thresholds::kColorRelated || follows ||
                                             m.z_deviation < thresholds::kZImplied || m.is_flat()))
        return true;
    if (follows && m.z_deviation > 2.0 * thresholds::kZImplied && m.correlation < thresholds::kColorRelated)
        return true;  // leaning
    // Leaning, with other data in blue: colours of one bright hue have R and G that follow each other.
    if (v.z > thresholds::kUprightMedian && v.off_centre() < thresholds::kSurfaceCentred && !m.is_flat() &&
        std::abs(relation_of(m)) < thresholds::kTwoRelated && m.beyond < thresholds::kMostOutside)
        return true;
    return m.spread > thresholds::kAllDirections && m.correlation < thresholds::kColorRelated;  // object space
}

bool are_damaged_vectors(const KindMeasure& m) {
    const auto restored = [&m](Reading reading) {
        const KindMeasure::Vectors& v = m.as(reading);
        // Where nearly all vectors become unit ones, the map may be steep.
        const double least_z = v.unit >= thresholds::kRestoredSurely ? 0.0 : thresholds::kUprightMedian;
        return v.unit >= thresholds::kRestoredShare && v.off_centre() <= thresholds::kRestoredCentre && v.z > least_z;
    };
    const bool related = relation_of(m) > thresholds::kRestoredRelated;
    if (restored(Reading::premultiplied) && m.as(Reading::as_stored).unit < m.as(Reading::premultiplied).unit)
        return true;
    const KindMeasure::Vectors& from_zero = m.as(Reading::z_from_zero);
    const bool is_from_zero = from_zero.unit > thresholds::kUnitShare &&
                              from_zero.off_centre() <= thresholds::kCentred && m.z_correlation > thresholds::kZFollows;
    return !related && (restored(Reading::srgb_encoded) || restored(Reading::srgb_decoded) || is_from_zero);
}

bool are_two_components(const KindMeasure& m, bool is_surface) {
    const double off = m.as(Reading::as_stored).off_centre();
    if (m.beyond > thresholds::kMostOutside || m.grey > thresholds::kMostGrey) return false;
    if (m.level < thresholds::kLeastLevel && off > thresholds::kBevelsCentred && !is_surface) return false;
    const bool is_level = m.level > thresholds::kLevelShare || m.as(Reading::as_stored).z > thresholds::kUprightMedian;
    if (std::abs(relation_of(m)) > (is_level ? thresholds::kColorRelated : thresholds::kTwoRelated)) return false;
    const double variance = m.deviation_x * m.deviation_x + m.deviation_y * m.deviation_y;
    if (variance > thresholds::kTwoVariance && !is_surface) return false;
    return off <= thresholds::kTwoCentred || (is_surface && off <= thresholds::kSurfaceCentred);
}

bool is_one(const Plane<float>& plane, float value) {
    constexpr float kNear = 8.0f / 255.0f;
    const Extent extent = plane.extent();
    for (int j = 0; j < extent.height; ++j) {
        const float* const row = plane.row(j);
        if (!std::all_of(row, row + extent.width, [&](float v) { return std::abs(v - value) <= kNear; })) return false;
    }
    return true;
}

// Contrast pushes x and y beyond the unit circle, and cuts z off at 1. Of 370 colour pictures (wild4, and others that
// no threshold was set on), none is like that but a normal map.
bool are_cut_off(const KindMeasure& m) {
    constexpr double kMostOff = 0.1, kLeastZ = 0.8, kMostCorrelated = 0.5, kMostBehind = 0.01;
    const KindMeasure::Vectors& v = m.as(Reading::as_stored);
    return v.off_centre() < kMostOff && v.z > kLeastZ && m.behind < kMostBehind &&
           std::abs(m.correlation) < kMostCorrelated;
}

bool varies(const Plane<float>& plane) { return !is_one(plane, plane.at(0, 0)); }

bool is_filler(const Plane<float>& plane) {
    const float first = plane.at(0, 0);
    return (first < 0.1f || first > 0.9f) && is_one(plane, first < 0.5f ? 0.0f : 1.0f);
}

}  // namespace

bool KindMeasure::is_flat() const { return std::max(deviation_x, deviation_y) < thresholds::kNoiseOnly; }

double KindMeasure::Vectors::off_centre() const { return std::max(std::abs(x), std::abs(y)); }

namespace {

KindMeasure measure_readings(const Stored& stored, const Background* without, bool all) {
    const Extent extent = stored.extent();
    const auto step = static_cast<int>(std::max(1.0, std::sqrt(static_cast<double>(extent.texels()) / kKindTexels)));
    const auto plane_of = [&](Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : &stored.image->planes[static_cast<std::size_t>(channel)];
    };
    const Plane<float>*x = plane_of(Component::x), *y = plane_of(Component::y), *z = plane_of(Component::z);
    const auto& planes = stored.image->planes;
    const bool has_alpha = planes.size() > 3 && x != &planes[3] && y != &planes[3];
    KindSums sums;
    for (int j = 0; j < extent.height; j += step) {
        for (int i = 0; i < extent.width; i += step) {
            if (without != nullptr && without->holds(i, j)) continue;
            const float a = x->at(i, j), b = y->at(i, j), c = z != nullptr ? z->at(i, j) : 1.0f;
            if (!std::isfinite(a + b + c)) continue;
            const float alpha = has_alpha ? planes[3].at(i, j) : 1.0f;
            sums.add({code_of(a), code_of(b), code_of(c), code_of(alpha)}, z != nullptr, has_alpha, all);
            if (planes.size() >= 3)
                sums.add_grey(
                    {code_of(planes[0].at(i, j)), code_of(planes[1].at(i, j)), code_of(planes[2].at(i, j)), 0});
        }
    }
    return sums.measure();
}

}  // namespace

KindMeasure measure_kind(const Stored& stored, const Background* without) {
    constexpr double kSurelyUnit = 0.95;  // no other reading can be better by what rules ask for
    KindMeasure measure = measure_readings(stored, without, false);
    if (!stored.has_z() || (measure.as(Reading::as_stored).unit >= kSurelyUnit && are_vectors(measure))) return measure;
    return measure_readings(stored, without, true);
}

bool are_stretched(const KindMeasure& m) {
    constexpr double kFollowsClosely = 0.7;
    const KindMeasure::Vectors& v = m.as(Reading::as_stored);
    return m.z_correlation > kFollowsClosely && v.off_centre() <= thresholds::kCentred &&
           v.z > thresholds::kUprightMedian && std::abs(m.correlation) <= thresholds::kColorRelated;
}

Kind kind_of(const KindMeasure& m, const Stored& stored, bool is_surface) {
    constexpr std::int64_t kLeastTexels = 64;
    if (m.texels < kLeastTexels) return Kind::normals;
    const auto& planes = stored.image->planes;
    if (!stored.has_z()) {
        if (planes.size() < 3 || stored.channel(Component::y) == 3) return Kind::normals;
        if (stored.channel(Component::x) != 3)
            return m.grey <= thresholds::kGreyTexels && are_two_components(m, is_surface) ? Kind::normals
                                                                                          : Kind::no_map;
        // Grey with alpha is a picture; the layout of y in R, G and B is that of compressed textures. Faint colours
        // beside grey are no layout of two components at all.
        const bool has_grey = !stored.in_blocks && stored.channel(Component::y) == 1 &&
                              (m.grey > thresholds::kGreyTexels || (varies(planes[0]) && varies(planes[2])));
        const double most_beyond = stored.in_blocks ? 0.5 : 0.25;  // of blocks, sRGB curves push more texels outside
        if (m.beyond > most_beyond) return Kind::no_map;
        return has_grey && !is_surface ? Kind::no_map : Kind::normals;
    }
    if (m.grey > thresholds::kGreyTexels) return Kind::no_map;
    const KindMeasure::Vectors& other = m.as(Reading::y_z_x);
    const bool is_x_ray = other.unit > thresholds::kUnitShare && other.off_centre() < thresholds::kCentred &&
                          other.z > thresholds::kUprightMedian;
    // A middle grey in R makes nearly unit vectors of z and y, too.
    constexpr double kClearlyMore = 0.1;
    if (is_x_ray && other.unit > m.as(Reading::as_stored).unit + kClearlyMore) return Kind::x_ray;
    if (are_vectors(m) || are_damaged_vectors(m)) return Kind::normals;
    if (is_x_ray) return Kind::x_ray;
    const bool has_alpha = planes.size() > 3 && !is_one(planes[3], 1.0f);
    if (!has_alpha && is_filler(planes[0]) && is_filler(planes[2]) && m.deviation_y > thresholds::kNoiseOnly &&
        std::abs(m.as(Reading::as_stored).y) < thresholds::kLostCentred)
        return Kind::x_lost;
    if ((is_surface && are_stretched(m)) || are_cut_off(m)) return Kind::normals;
    if (!are_two_components(m, is_surface)) return Kind::no_map;
    // Averaged vectors, and those whose lengths are occlusion, are short; but they keep facing outwards.
    const bool is_faulty = m.behind > thresholds::kFewBehind || (m.null > thresholds::kFewNull && m.alpha_varies);
    const bool is_other = m.z_correlation < thresholds::kZFollows && m.z_range > static_cast<double>(kBlockError) &&
                          m.as(Reading::as_stored).unit < thresholds::kOtherUnit;
    return is_other && is_faulty ? Kind::two_components : Kind::normals;
}

std::string evidence_text(const KindMeasure& m, bool has_z) {
    const KindMeasure::Vectors& v = m.as(Reading::as_stored);
    const std::string lengths = has_z ? percent(v.unit) + " of the vectors have about unit length, " : std::string();
    return lengths + "x and y centre on " + decimal(v.x, 2) + " and " + decimal(v.y, 2) +
           (has_z ? ", and R and G correlate by " : ", and they correlate by ") + decimal(m.correlation, 2);
}

}  // namespace tex::inline v1
