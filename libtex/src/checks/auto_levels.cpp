// SPDX-License-Identifier: Apache-2.0

#include "checks/auto_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "checks/tone.h"
#include "checks/tone_texels.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr double kNoFit = std::numeric_limits<double>::max();

// Stored z as a straight line over the z that x and y imply.
struct ZLine {
    double slope = 0.5, at_zero = 0.5;
    double error = kNoFit;  // the mean distance in codes from the sphere, with texels that leave the unit circle
};

// Texels as distances from the middle of x and y, which flat ground has.
class SpanSearch {
public:
    SpanSearch(const ToneTexels& texels, const Centre& centre) {
        constexpr std::size_t kMost = 2048;
        const std::size_t step = 1 + texels.size() / kMost;
        for (std::size_t k = 0; k < texels.size(); k += step) {
            const auto& [x, y, z] = texels[k];
            texels_.push_back({2.0 * (x - centre.x), 2.0 * (y - centre.y), z});
        }
    }

    // The line of z if x and y were stretched by 1 / span_x and 1 / span_y: least squares.
    [[nodiscard]] ZLine line(double span_x, double span_y) const {
        constexpr double kLeastSlope = 0.45;  // z was stretched, or stayed as it was
        double weights = 0.0, sum = 0.0, sum_z = 0.0, squares = 0.0, products = 0.0;
        for (const auto& [x, y, z] : texels_) {
            const double root = root_of(span_x * x, span_y * y), weight = weight_of(z) * weight_of(z);
            weights += weight;
            sum += weight * root;
            sum_z += weight * z;
            squares += weight * root * root;
            products += weight * root * z;
        }
        ZLine line;
        const double variance = squares - sum * sum / weights;
        if (!(weights > 0.0 && variance > 1e-9 * weights)) return line;
        line.slope = std::max(kLeastSlope, (products - sum * sum_z / weights) / variance);
        line.at_zero = (sum_z - line.slope * sum) / weights;
        double error = 0.0;
        for (const auto& [x, y, z] : texels_) {
            const double a = span_x * x, b = span_y * y, root = root_of(a, b);
            error += weight_of(z) * std::abs(line.slope * root + line.at_zero - z) +
                     0.5 * std::max(0.0, a * a + b * b - 1.0);
        }
        line.error = 255.0 * error / static_cast<double>(texels_.size());
        return line;
    }

private:
    static double root_of(double a, double b) { return std::sqrt(std::max(0.0, 1.0 - a * a - b * b)); }
    // Where vectors are steep, an error of x or y makes one of z that grows as 1 / z.
    static double weight_of(double z) { return std::min(1.0, 4.0 * z); }

    std::vector<ToneTexel> texels_;
};

struct Spans {
    double x = 1.0, y = 1.0;
    ZLine z;
};

constexpr double kNarrowestSpan = 0.1, kWidestSpan = 1.02;  // levels that are stretched make none wider

Spans best_spans(const SpanSearch& search) {
    constexpr int kSteps = 24;
    Spans best;
    const auto take = [&](double x, double y) {
        const ZLine line = search.line(x, y);
        if (line.error >= best.z.error) return false;
        best = {x, y, line};
        return true;
    };
    const auto span = [](int k) {
        return kNarrowestSpan * math::pow(kWidestSpan / kNarrowestSpan, static_cast<double>(k) / kSteps);
    };
    for (int k = 0; k <= kSteps; ++k) {
        for (int l = 0; l <= kSteps; ++l) take(span(k), span(l));
    }
    for (double step = 1.06; step > 1.001; step = std::sqrt(step)) {
        bool is_better = true;
        for (int turn = 0; is_better && turn < 32; ++turn) {
            is_better = false;
            const double x = best.x, y = best.y;
            for (const auto& [by_x, by_y] : {std::pair{step, 1.0}, {1.0, step}, {step, step}, {step, 1.0 / step}}) {
                is_better |= take(x * by_x, y * by_y);
                is_better |= take(x / by_x, y / by_y);
            }
        }
    }
    return best;
}

// A value c of x or y was black + (white - black) c, and its middle one half.
ToneCurve of_component(double span, double middle) { return {0.5 - span * middle, 0.5 + span * (1.0 - middle), 1.0}; }

// And a value of z (z + 1) / 2.
ToneCurve of_z(const ZLine& line) {
    const double at_black = -line.at_zero / line.slope, at_white = (1.0 - line.at_zero) / line.slope;
    return {0.5 + 0.5 * at_black, 0.5 + 0.5 * at_white, 1.0};
}

bool reaches_both_ends(const CheckContext& context) {
    constexpr float kEnd = 2.5f / 255.0f;
    return std::ranges::all_of(std::array{Component::x, Component::y, Component::z}, [&](Component component) {
        const auto channel = static_cast<std::size_t>(context.stored.channel(component));
        return context.counts.low[channel] <= kEnd && context.counts.high[channel] >= 1.0f - kEnd;
    });
}

}  // namespace

std::optional<AutoLevels> find_auto_levels(const CheckContext& context, const Centre& centre) {
    constexpr std::int64_t kLeastTexels = 64 * 64;
    constexpr std::size_t kLeastUncut = 1024;
    constexpr double kLeastError = 2.0, kMostError = 0.8;  // codes as stored, and before
    constexpr double kLead = 3.0, kLeadOverOne = 0.7;      // ratios of errors
    constexpr double kMostWhole = 0.97, kLeastOfZ = 0.05, kMostOfZ = 0.9;
    if (context.stored.extent().texels() < kLeastTexels || !reaches_both_ends(context)) return std::nullopt;
    const Background* const background = context.background ? &*context.background : nullptr;
    ToneTexels texels = tone_texels(context.stored, background);
    AutoLevels found;
    found.as_stored = error_of({}, texels);
    if (found.as_stored < kLeastError) return std::nullopt;
    const double of_one_curve = least_tone_error(centre, texels);
    std::erase_if(texels, [](const ToneTexel& texel) {
        return std::any_of(texel.begin(), texel.end(), [](double c) { return c <= 0.0 || c >= 1.0; });
    });
    if (texels.size() < kLeastUncut) return std::nullopt;
    const Spans best = best_spans(SpanSearch(texels, centre));
    found.error = best.z.error;
    found.curves = {of_component(best.x, centre.x), of_component(best.y, centre.y), of_z(best.z)};
    if (found.error > found.as_stored / kLead || found.error > kLeadOverOne * of_one_curve) return std::nullopt;
    if (std::min(best.x, best.y) < kNarrowestSpan || std::max(best.x, best.y) > kWidestSpan) return std::nullopt;
    // Where only z was changed, N221 says how it is stored; where z is as it was, x and y may be steeper on purpose.
    const double span_of_z = found.curves[2].white - found.curves[2].black;
    if (std::min(best.x, best.y) > kMostWhole || span_of_z > kMostOfZ || span_of_z < kLeastOfZ) return std::nullopt;
    if (found.error * span_of_z > kMostError) return std::nullopt;
    return found;
}

}  // namespace tex::inline v1
