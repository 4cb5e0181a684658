// SPDX-License-Identifier: Apache-2.0

#include "repairs/smooth_heights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <tex/height.h>

#include "checks/stored.h"
#include "repairs/whole_heights.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr float kUnit = 1.0f / 4096.0f;  // of the heights of deband(): one step
constexpr float kOnLattice = 0.35f;      // of a step of slopes: how far rounding may move them
constexpr float kMostSlope = 2.0f;       // steeper ones are rounded to more than that
constexpr double kLeastClosing = 0.8;    // see closing_share(): slopes of another kernel or of no surface have 0.5
constexpr float kMostMoved = 1.6f;       // steps: two heights move by half a step each, and rounding counts, too
constexpr double kLeastChanged = 0.5;    // share of texels that were baked again
constexpr double kSameBorder = 0.8;      // share of border texels that fit a wrap

// How near slopes are to multiples of 1 / rate: the mean cosine.
double comb_of(const std::vector<float>& slopes, double rate) {
    double sum = 0.0;
    for (const float slope : slopes) sum += math::cos(2.0 * math::kPi * rate * static_cast<double>(slope));
    return slopes.empty() ? 0.0 : sum / static_cast<double>(slopes.size());
}

// The step, to a hundredth of the number of steps in 1. The rule finds half of a great step as well.
double refined_step(const Slopes& slopes, double about) {
    constexpr float kLeast = 0.02f, kGentle = 0.5f;
    constexpr std::size_t kMostSlopes = 1 << 14;
    constexpr double kAlike = 0.9;
    std::vector<float> some;
    const auto [width, height] = slopes.extent();
    const std::int64_t every = slopes.extent().texels() / static_cast<std::int64_t>(kMostSlopes / 2) | 1;
    for (std::int64_t t = 0; t < slopes.extent().texels(); t += every) {
        const int i = static_cast<int>(t % width), j = static_cast<int>(t / width);
        const float p = slopes.p.at(i, j), q = slopes.q.at(i, j);
        if (std::abs(p) > kLeast && std::abs(p) < kGentle && std::abs(q) < kGentle) some.push_back(p);
        if (std::abs(q) > kLeast && std::abs(q) < kGentle && std::abs(p) < kGentle) some.push_back(q);
    }
    double best = 0.0, step = about;
    for (const double part : {1.0, 0.5}) {
        double most = 0.0, rate = part / about;
        for (int k = -30; k <= 30; ++k) {
            const double one = part / about + 0.01 * k, comb = comb_of(some, one);
            if (comb <= most) continue;
            most = comb;
            rate = one;
        }
        if (most < (part < 1.0 ? kAlike * best : 0.0)) continue;
        best = std::max(best, most);
        step = 1.0 / rate;
    }
    return step;
}

// Rows run down, so that the slope upwards counts the other way round; with y down, as it stands.
WholeSlopes whole_slopes(const Slopes& slopes, double step, float y_sign) {
    WholeSlopes whole{slopes.extent(), {}, {}};
    const auto count = static_cast<std::size_t>(slopes.extent().texels());
    whole.across.assign(count, WholeSlopes::kUnknown);
    whole.down.assign(count, WholeSlopes::kUnknown);
    const auto per = static_cast<float>(1.0 / step);
    for (int j = 0; j < whole.extent.height; ++j) {
        for (int i = 0; i < whole.extent.width; ++i) {
            const float p = slopes.p.at(i, j), q = y_sign * slopes.q.at(i, j);
            if (!(std::abs(p) < kMostSlope && std::abs(q) < kMostSlope)) continue;
            const float m = std::floor(p * per + 0.5f), n = std::floor(q * per + 0.5f);
            if (std::abs(p * per - m) > kOnLattice || std::abs(q * per - n) > kOnLattice) continue;
            whole.across[whole.at(i, j)] = static_cast<std::int16_t>(m);
            whole.down[whole.at(i, j)] = static_cast<std::int16_t>(n);
        }
    }
    return whole;
}

enum class Border { unknown, repeats, ends };

// Whether the first and the last line take the height beyond the border from the other side, or from themselves.
Border border_of(const WholeSlopes& slopes, const std::vector<std::optional<std::int32_t>>& heights, bool across) {
    const int length = across ? slopes.extent.width : slopes.extent.height;
    const int lines = across ? slopes.extent.height : slopes.extent.width;
    double all = 0.0, repeats = 0.0, ends = 0.0;
    for (int line = 0; line < lines && length > 2; ++line) {
        const auto at = [&](int k) { return across ? slopes.at(k, line) : slopes.at(line, k); };
        const auto rise = (across ? slopes.across : slopes.down)[at(0)];
        const auto &next = heights[at(1)], &self = heights[at(0)], &other = heights[at(length - 1)];
        if (!next || !self || !other) continue;
        all += 1.0;
        repeats += rise != WholeSlopes::kUnknown && *next - *other == rise ? 1.0 : 0.0;
        ends += rise != WholeSlopes::kUnknown && *next - *self == rise ? 1.0 : 0.0;
    }
    if (all == 0.0) return Border::unknown;
    return repeats >= kSameBorder * all ? Border::repeats : ends >= kSameBorder * all ? Border::ends : Border::unknown;
}

struct Surface {
    HeightField field;
    Border across, down;

    // The difference of the neighbours along an axis, in steps; NaN if one is unknown.
    [[nodiscard]] float rise(int i, int j, bool is_across) const {
        const Extent extent = field.height.extent();
        const int length = is_across ? extent.width : extent.height, at = is_across ? i : j;
        const Border border = is_across ? across : down;
        int before = at - 1, after = at + 1;
        if (before < 0 || after >= length) {
            if (border == Border::unknown) return std::numeric_limits<float>::quiet_NaN();
            const bool repeats = border == Border::repeats;
            before = before >= 0 ? before : repeats ? length - 1 : 0;
            after = after < length ? after : repeats ? 0 : length - 1;
        }
        const float a = is_across ? field.height.at(before, j) : field.height.at(i, before);
        const float b = is_across ? field.height.at(after, j) : field.height.at(i, after);
        return (b - a) / kUnit;
    }
};

Result<Surface> smooth_surface(const WholeSlopes& slopes, const Execution& execution) {
    const std::vector<std::optional<std::int32_t>> heights = whole_heights(slopes);
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    for (const auto& height : heights) least = std::min(least, height.value_or(least));
    Surface surface{{Plane<float>(slopes.extent), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp},
                    border_of(slopes, heights, true),
                    border_of(slopes, heights, false)};
    if (surface.across == Border::repeats) surface.field.wrap_x = Wrap::repeat;
    if (surface.down == Border::repeats) surface.field.wrap_y = Wrap::repeat;
    for (int j = 0; j < slopes.extent.height; ++j) {
        for (int i = 0; i < slopes.extent.width; ++i) {
            const auto& height = heights[slopes.at(i, j)];
            // One more, because heights of 0 stay at or above it.
            surface.field.height.at(i, j) =
                height ? kUnit * static_cast<float>(*height - least + 1) : std::numeric_limits<float>::quiet_NaN();
        }
    }
    auto smooth = deband(std::move(surface.field), Deband::on, execution);
    if (!smooth) return smooth.error();
    if (!smooth->report.applied) return Error{ErrorCode::unsupported, {}, "the heights lie on no steps"};
    surface.field = std::move(*smooth);
    return surface;
}

}  // namespace

Result<void> smooth_heights(StoredLevels& levels, double step, const Execution& execution) {
    const Stored stored = levels.stored(0);
    const Extent extent = stored.extent();
    const Slopes slopes = slopes_of(stored, {0, 0, extent.width, extent.height});
    const double fine = refined_step(slopes, step);
    WholeSlopes whole = whole_slopes(slopes, fine, -1.0f), down = whole_slopes(slopes, fine, 1.0f);
    const bool is_down = down.closing_share() > whole.closing_share();
    if (is_down) std::swap(whole, down);
    if (whole.closing_share() < kLeastClosing)
        return Error{ErrorCode::unsupported, {}, "no heights in steps explain the slopes"};
    const auto surface = smooth_surface(whole, execution);
    if (!surface) return surface.error();
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    std::vector<Plane<float>>& planes = levels.levels.front().planes;
    const auto code = [&](float n) { return levels.is_signed ? n : 0.5f * n + 0.5f; };
    const auto scale = static_cast<float>(fine), y_sign = is_down ? 1.0f : -1.0f;
    std::int64_t changed = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float p = scale * surface->rise(i, j, true), q = y_sign * scale * surface->rise(i, j, false);
            const auto is_near = [&](float now, float before) { return std::abs(now - before) <= kMostMoved * scale; };
            if (!is_near(p, slopes.p.at(i, j)) || !is_near(q, slopes.q.at(i, j))) continue;  // nor is NaN
            const float length = std::sqrt(1.0f + p * p + q * q);
            planes[static_cast<std::size_t>(x)].at(i, j) = code(-p / length);
            planes[static_cast<std::size_t>(y)].at(i, j) = code(-q / length);
            if (z >= 0) planes[static_cast<std::size_t>(z)].at(i, j) = code(1.0f / length);
            ++changed;
        }
    }
    if (static_cast<double>(changed) < kLeastChanged * static_cast<double>(extent.texels()))
        return Error{ErrorCode::unsupported, {}, "too few heights are known"};
    return {};
}

}  // namespace tex::inline v1
