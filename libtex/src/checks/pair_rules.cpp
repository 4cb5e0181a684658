// SPDX-License-Identifier: Apache-2.0

#include "checks/pair_rules.h"

#include <algorithm>
#include <cmath>

namespace tex::inline v1 {
namespace {

constexpr int kReach = 3;           // the greatest shift to look for, in texels
constexpr double kBetterBy = 0.05;  // a shift must be better than no shift by this much

// Sums over texels that compare slopes (p, q) with differences (u, v) of the heights.
struct Fit {
    double pp = 0.0, qq = 0.0, uu = 0.0, vv = 0.0, pu = 0.0, qv = 0.0;

    [[nodiscard]] double x() const { return pp * uu > 0.0 ? pu / std::sqrt(pp * uu) : 0.0; }
    [[nodiscard]] double y() const { return qq * vv > 0.0 ? qv / std::sqrt(qq * vv) : 0.0; }
    [[nodiscard]] double correlation() const { return (std::abs(x()) + std::abs(y())) / 2.0; }
};

// Adds a window in which the normals lie dx texels to the right of the heights and dy texels below them.
void add_window(const Slopes& slopes, Rect window, const Plane<float>& height, int dx, int dy, Fit& fit) {
    const Extent extent = height.extent();
    for (int j = 0; j < window.height; ++j) {
        const int y = window.y + j - dy;
        if (y < 1 || y + 1 >= extent.height) continue;
        for (int i = 0; i < window.width; ++i) {
            const int x = window.x + i - dx;
            if (x < 1 || x + 1 >= extent.width) continue;
            const double p = slopes.p.at(i, j), q = slopes.q.at(i, j);
            const double u = 0.5 * (static_cast<double>(height.at(x + 1, y)) - height.at(x - 1, y));
            const double v = 0.5 * (static_cast<double>(height.at(x, y - 1)) - height.at(x, y + 1));
            const double all = p + q + u + v;
            if (!(std::abs(all) < 1e9)) continue;  // also if NaN
            fit.pp += p * p;
            fit.qq += q * q;
            fit.uu += u * u;
            fit.vv += v * v;
            fit.pu += p * u;
            fit.qv += q * v;
        }
    }
}

// Where green ought to point, if anything says so. Where it does not, red or green is mirrored, and not the heights
// (N401, N404).
std::optional<YAxis> wanted_y(const CheckContext& context) {
    if (context.options.require.y) return context.options.require.y;
    return context.texture.y_known ? std::optional(context.texture.y_axis) : std::nullopt;
}

}  // namespace

std::optional<PairEvidence> check_pair_rules(const CheckContext& context, Findings& findings) {
    const HeightField* field = context.options.height;
    if (field == nullptr || !context.has_vectors || context.constant) return std::nullopt;
    const Extent extent = context.stored.extent();
    if (field->height.extent() != extent) {
        findings.add("N601", "the height map is " + extent_text(field->height.extent()) + ", the normal map " +
                                 extent_text(extent));
        return std::nullopt;
    }
    Fit fits[2 * kReach + 1][2 * kReach + 1];
    for (const Rect& window : sample_windows(extent)) {
        const Slopes slopes = slopes_of(context.stored, window);
        for (int dy = -kReach; dy <= kReach; ++dy) {
            for (int dx = -kReach; dx <= kReach; ++dx) {
                add_window(slopes, window, field->height, dx, dy, fits[dy + kReach][dx + kReach]);
            }
        }
    }
    const double centred = fits[kReach][kReach].correlation();
    PairEvidence pair;
    const Fit* best = &fits[kReach][kReach];
    for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const Fit& fit = fits[dy + kReach][dx + kReach];
            if (fit.correlation() <= std::max(best->correlation(), centred + kBetterBy)) continue;
            best = &fit;
            pair.offset_x = dx;
            pair.offset_y = dy;
        }
    }
    pair.correlation = best->correlation();
    pair.strength = best->uu > 0.0 ? best->pu / best->uu : 0.0;
    pair.y = best->x() * best->y() >= 0.0 ? YAxis::up : YAxis::down;

    const std::string fitted = "correlation " + decimal(pair.correlation, 2) + ", strength " +
                               decimal(pair.strength, 2) + ", y " + direction(pair.y) + ", offset " +
                               std::to_string(pair.offset_x) + ", " + std::to_string(pair.offset_y);
    const auto add = [&](std::string_view id, const std::string& what) {
        Finding& finding = findings.add(id, what + " (" + fitted + ")");
        finding.figure = pair.correlation;
        finding.unit = "correlation";
        finding.confidence = 0.95;
    };
    if (pair.correlation < kHeightsFollow) {
        add("N601", "slopes do not follow the heights");
    } else if (pair.offset_x != 0 || pair.offset_y != 0) {
        add("N601", "slopes follow the heights only when shifted");
    } else if (pair.strength < 0.0 && pair.y == wanted_y(context).value_or(pair.y)) {
        add("N602", "slopes follow the inverted heights");
    }
    return pair;
}

}  // namespace tex::inline v1
