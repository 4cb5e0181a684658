// SPDX-License-Identifier: Apache-2.0

#include "checks/layout_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "checks/background.h"
#include "checks/curl.h"
#include "checks/kind.h"
#include "checks/thresholds.h"
#include "checks/y_verdict.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kFitChannels = 4, kFitAlpha = 3;
constexpr char kChannelLetters[] = "rgba";
// Slopes of a surface correlate by more than 0.4 in nearly all maps; a guess that is printed as advice must not be one
// of noise.
constexpr double kFitCorrelation = 0.4;
constexpr double kFitLead = 0.15;       // before the pair that comes second
constexpr double kFitDeviation = 0.03;  // of both channels: less is rounding

struct ChannelPair {
    std::size_t x = 0, y = 0;
    double correlation = 0.0;
};

Stored read_as(const Stored& stored, std::size_t x, std::size_t y, std::optional<std::size_t> z = {}) {
    Stored read = stored;
    read.swizzle.fill(Component::other);
    read.swizzle[x] = Component::x;
    read.swizzle[y] = Component::y;
    if (z) read.swizzle[*z] = Component::z;
    return read;
}

// How well two channels are x and y, in that order or the other.
std::optional<ChannelPair> fit_of(const Stored& stored, std::size_t a, std::size_t b) {
    const Stored read = read_as(stored, a, b);
    const KindMeasure measure = measure_kind(read, stored.transparent);
    const KindMeasure::Vectors& vectors = measure.as(Reading::as_stored);
    const bool is_centred = vectors.off_centre() < thresholds::kCentred &&
                            std::abs(measure.correlation) < thresholds::kColorRelated &&
                            measure.beyond < thresholds::kMostOutside;
    if (!is_centred || std::min(measure.deviation_x, measure.deviation_y) < kFitDeviation) return {};
    const Curl curl = measure_curl(read);
    if (curl.usable < kLeastUsable) return {};
    const bool is_exchanged = std::abs(curl.exchanged) > std::abs(curl.correlation);
    if (is_exchanged && diagonal_share(read) > kMostDiagonal) return {};
    if ((is_exchanged ? curl.exchanged_confidence : curl.confidence) < kLeastConfidence) return {};
    if (is_exchanged) return ChannelPair{b, a, std::abs(curl.exchanged)};
    return ChannelPair{a, b, std::abs(curl.correlation)};
}

// A channel that makes unit vectors of x and y, which point outwards.
std::optional<std::size_t> third_of(const Stored& stored, const ChannelPair& pair) {
    for (std::size_t c = 0; c < kFitChannels; ++c) {
        if (c == pair.x || c == pair.y) continue;
        const KindMeasure measure = measure_kind(read_as(stored, pair.x, pair.y, c), stored.transparent);
        const KindMeasure::Vectors& vectors = measure.as(Reading::as_stored);
        if (vectors.unit > thresholds::kUnitShare && vectors.z > thresholds::kUprightMedian &&
            measure.z_correlation > thresholds::kZFollows)
            return c;
    }
    return {};
}

}  // namespace

std::string fitting_layout(const Stored& stored) {
    if (stored.image->planes.size() < kFitChannels || stored.is_signed) return {};
    ChannelPair best;
    double second = 0.0;
    for (std::size_t c = 0; c < kFitAlpha; ++c) {
        const std::optional<ChannelPair> pair = fit_of(stored, kFitAlpha, c);
        if (!pair) continue;
        second = std::max(second, std::min(best.correlation, pair->correlation));
        if (pair->correlation > best.correlation) best = *pair;
    }
    if (best.correlation < kFitCorrelation || best.correlation < second + kFitLead) return {};
    std::string letters{kChannelLetters[best.x], kChannelLetters[best.y]};
    if (const auto z = third_of(stored, best)) letters += kChannelLetters[*z];
    return letters;
}

std::string fitting_layout_text(const Stored& stored) {
    const std::string letters = fitting_layout(stored);
    if (letters.empty()) return {};
    const auto name = [&letters](std::size_t k) { return static_cast<char>(letters[k] - 'a' + 'A'); };
    std::string text = std::string("; ") + name(0);
    if (letters.size() > 2)
        text += std::string(", ") + name(1) + " and " + name(2) + " are the x, y and z of normals";
    else
        text += std::string(" and ") + name(1) + " have the slopes of a surface, as x and y";
    return text + " (--swizzle " + letters + ")";
}

}  // namespace tex::inline v1
