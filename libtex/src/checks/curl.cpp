// SPDX-License-Identifier: Apache-2.0

#include "checks/curl.h"

#include <algorithm>
#include <cmath>

#include "rows/math.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kWideMap = 512;

// Length of a region's edge in texels: maps of 128 texels and above have 16 regions or more.
int region_size(Extent extent) { return std::min(extent.width, extent.height) >= kWideMap ? 64 : 32; }

// Sums over the inner texels of [x0, x1) x [y0, y1).
CurlSums sum_region(const Slopes& s, int x0, int y0, int x1, int y1) {
    CurlSums sums;
    const Extent extent = s.extent();
    for (int j = std::max(y0, 1); j < std::min(y1, extent.height - 1); ++j) {
        const float *pu = s.p.row(j - 1), *pd = s.p.row(j + 1), *p = s.p.row(j);
        const float *qu = s.q.row(j - 1), *qd = s.q.row(j + 1), *q = s.q.row(j);
        for (int i = std::max(x0, 1); i < std::min(x1, extent.width - 1); ++i) {
            const float py = pu[i] - pd[i], qx = q[i + 1] - q[i - 1];
            const float px = p[i + 1] - p[i - 1], qy = qu[i] - qd[i];
            const float all = py + qx + px + qy;
            if (!(all == all)) continue;  // a neighbour has no normal
            // Jumps (the borders of UV islands, scratches) count as much as moderate changes, not as their square.
            const float w = 1.0f / (kSlopeJump * kSlopeJump + py * py + qx * qx);
            const float v = 1.0f / (kSlopeJump * kSlopeJump + px * px + qy * qy);
            sums.cross += static_cast<double>(w * py) * qx;
            sums.p_square += static_cast<double>(w * py) * py;
            sums.q_square += static_cast<double>(w * qx) * qx;
            sums.exchanged += static_cast<double>(v * px) * qy;
            sums.px_square += static_cast<double>(v * px) * px;
            sums.qy_square += static_cast<double>(v * qy) * qy;
        }
    }
    return sums;
}

// Products of the changes of a slope to the right and upwards, summed over a square.
struct ChangeSums {
    double xx = 0.0, yy = 0.0, xy = 0.0;
};

ChangeSums sum_changes(const Plane<float>& s, int x, int y, int side) {
    ChangeSums sums;
    for (int j = y + 1; j + 1 < y + side; ++j) {
        for (int i = x + 1; i + 1 < x + side; ++i) {
            const double sx = static_cast<double>(s.at(i + 1, j)) - static_cast<double>(s.at(i - 1, j));
            const double sy = static_cast<double>(s.at(i, j - 1)) - static_cast<double>(s.at(i, j + 1));
            if (!(sx + sy == sx + sy)) continue;
            sums.xx += sx * sx;
            sums.yy += sy * sy;
            sums.xy += sx * sy;
        }
    }
    return sums;
}

double count_usable(const Plane<float>& slopes) {
    double count = 0.0;
    for (int j = 0; j < slopes.extent().height; ++j) {
        for (int i = 0; i < slopes.extent().width; ++i) count += std::isnan(slopes.at(i, j)) ? 0.0 : 1.0;
    }
    return count;
}

double ratio(double cross, double a, double b) {
    const double square = a * b;
    return square > 0.0 ? cross / std::sqrt(square) : 0.0;
}

// The sum of the evidence divided by the root of the sum of its squares: the z-score of "both signs are equally
// likely".
double z_score(const std::vector<CurlRegion>& regions, int scale, bool exchanged) {
    double sum = 0.0, squares = 0.0;
    for (const CurlRegion& region : regions) {
        // A region's vote is limited by its own energy, so that a few deep scratches do not outvote the rest.
        const CurlSums& sums = region.scale[scale];
        const double correlation = exchanged ? sums.exchanged_correlation() : sums.correlation();
        const double energy = exchanged ? sums.px_square * sums.qy_square : sums.p_square * sums.q_square;
        const double vote = correlation * std::sqrt(std::sqrt(energy));
        sum += vote;
        squares += vote * vote;
    }
    return squares > 0.0 ? sum / std::sqrt(squares) : 0.0;
}

// The logistic approximation of the normal distribution (error below 0.01).
double confidence_of(double z) { return 1.0 / (1.0 + math::exp(-1.702 * std::abs(z))); }

// What one window shows.
struct CurlWindow {
    std::vector<CurlRegion> regions;
    double texels = 0.0, usable = 0.0;
};

CurlWindow sum_window(Extent extent, const Rect& window, Slopes slopes) {
    CurlWindow part;
    const int size = region_size(extent);
    for (int y = 0; y < window.height; y += size) {
        for (int x = 0; x < window.width; x += size) {
            CurlRegion region;
            region.rect = {window.x + x, window.y + y, std::min(size, window.width - x),
                           std::min(size, window.height - y)};
            part.regions.push_back(region);
        }
    }
    part.texels = static_cast<double>(slopes.extent().texels());
    part.usable = count_usable(slopes.p);
    for (int k = 0; k < kCurlScales; ++k) {
        for (CurlRegion& region : part.regions) {
            const int x = (region.rect.x - window.x) >> k, y = (region.rect.y - window.y) >> k;
            region.scale[k] = sum_region(slopes, x, y, x + (region.rect.width >> k), y + (region.rect.height >> k));
        }
        if (k + 1 < kCurlScales) slopes = halved(slopes);
    }
    return part;
}

Curl join(const std::vector<CurlWindow>& parts) {
    Curl curl;
    double all = 0.0, usable = 0.0;
    for (const CurlWindow& part : parts) {
        all += part.texels;
        usable += part.usable;
        for (const CurlRegion& region : part.regions) {
            for (int k = 0; k < kCurlScales; ++k) curl.scale[k].add(region.scale[k]);
            curl.regions.push_back(region);
        }
    }
    int best = 0;
    const auto strength = [&](int k) {
        return std::max(std::abs(curl.scale[k].correlation()), std::abs(curl.scale[k].exchanged_correlation()));
    };
    for (int k = 1; k < kCurlScales; ++k) {
        if (strength(k) > strength(best)) best = k;
    }
    curl.best_scale = best;
    curl.correlation = curl.scale[best].correlation();
    curl.exchanged = curl.scale[best].exchanged_correlation();
    curl.confidence = confidence_of(z_score(curl.regions, best, false));
    curl.exchanged_confidence = confidence_of(z_score(curl.regions, best, true));
    curl.usable = all > 0.0 ? usable / all : 0.0;
    return curl;
}

}  // namespace

void CurlSums::add(const CurlSums& other) {
    cross += other.cross;
    p_square += other.p_square;
    q_square += other.q_square;
    exchanged += other.exchanged;
    px_square += other.px_square;
    qy_square += other.qy_square;
}

bool CurlSums::changes_across() const {
    return p_square * q_square > kLeastAcross * kLeastAcross * px_square * qy_square;
}

double CurlSums::correlation() const { return changes_across() ? ratio(cross, p_square, q_square) : 0.0; }
double CurlSums::exchanged_correlation() const {
    const bool changes_along = px_square * qy_square > kLeastAcross * kLeastAcross * p_square * q_square;
    return changes_along ? ratio(exchanged, px_square, qy_square) : 0.0;
}

double diagonal_share(const Stored& stored) {
    std::vector<Slopes> parts;
    for (const Rect& window : sample_windows(stored.extent())) parts.push_back(slopes_of(stored, window));
    return diagonal_share(parts);
}

double diagonal_share(const std::vector<Slopes>& parts) {
    constexpr int kSide = 16;  // texels of a region: so small that a structure has one direction in it
    double along = 0.0, all = 0.0;
    for (const Slopes& part : parts) {
        const Slopes slopes = halved(halved(part));
        const auto [width, height] = slopes.extent();
        for (int y = 0; y + kSide <= height; y += kSide) {
            for (int x = 0; x + kSide <= width; x += kSide) {
                for (const Plane<float>* plane : {&slopes.p, &slopes.q}) {
                    const ChangeSums sums = sum_changes(*plane, x, y, kSide);
                    along += std::abs(sums.xy);
                    all += std::sqrt(sums.xx * sums.yy);
                }
            }
        }
    }
    return all > 0.0 ? along / all : 0.0;
}

Curl measure_curl(const Stored& stored) {
    const std::vector<Rect> windows = sample_windows(stored.extent());
    return measure_curl(stored.extent(), windows, [&](std::size_t k) { return slopes_of(stored, windows[k]); });
}

Curl measure_curl(Extent extent, const std::vector<Rect>& windows, const std::function<Slopes(std::size_t)>& take) {
    std::vector<CurlWindow> parts;
    for (std::size_t k = 0; k < windows.size(); ++k) parts.push_back(sum_window(extent, windows[k], take(k)));
    return join(parts);
}

Result<Curl> measure_curl(const Stored& stored, const Execution& execution) {
    const std::vector<Rect> windows = sample_windows(stored.extent());
    std::vector<CurlWindow> parts(windows.size());
    const auto body = [&](int begin, int end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            parts[k] = sum_window(stored.extent(), windows[k], slopes_of(stored, windows[k]));
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, static_cast<int>(windows.size()), 1, body); !done) return done.error();
    return join(parts);
}

}  // namespace tex::inline v1
