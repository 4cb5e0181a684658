// SPDX-License-Identifier: Apache-2.0

#include "checks/turn.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "checks/curl.h"
#include "rows/math.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

void add_pair(TurnSums& sums, float weight, float curl, float divergence) {
    sums.curl += static_cast<double>(weight * curl) * curl;
    sums.divergence += static_cast<double>(weight * divergence) * divergence;
    sums.product += static_cast<double>(weight * curl) * divergence;
}

TurnScale sum_scale(const Slopes& s) {
    TurnScale sums;
    const Extent extent = s.extent();
    for (int j = 1; j + 1 < extent.height; ++j) {
        const float *pu = s.p.row(j - 1), *pd = s.p.row(j + 1), *p = s.p.row(j);
        const float *qu = s.q.row(j - 1), *qd = s.q.row(j + 1), *q = s.q.row(j);
        for (int i = 1; i + 1 < extent.width; ++i) {
            const float px = p[i + 1] - p[i - 1], py = pu[i] - pd[i];
            const float qx = q[i + 1] - q[i - 1], qy = qu[i] - qd[i];
            const float p_square = px * px + py * py, q_square = qx * qx + qy * qy;
            if (!(p_square + q_square == p_square + q_square)) continue;  // a neighbour has no normal
            const float w = 1.0f / (2.0f * kSlopeJump * kSlopeJump + p_square + q_square);
            add_pair(sums.up, w, py - qx, px + qy);
            add_pair(sums.down, w, py + qx, px - qy);
            sums.weight += static_cast<double>(w);
            sums.p_square += static_cast<double>(w * p_square);
            sums.q_square += static_cast<double>(w * q_square);
            sums.p_q += static_cast<double>(w * (px * qx + py * qy));
        }
    }
    return sums;
}

double safe_ratio(double value, double by) { return by > 0.0 ? value / by : 0.0; }

}  // namespace

void TurnSums::add(const TurnSums& other) {
    curl += other.curl;
    divergence += other.divergence;
    product += other.product;
}

double TurnSums::share() const { return safe_ratio(curl, curl + divergence); }

// Half the angle of (difference, 2 product).
double TurnSums::angle() const {
    const double difference = divergence - curl, y = 2.0 * product;
    const double x = difference + std::sqrt(difference * difference + y * y);
    return x > 0.0 ? 180.0 / math::kPi * math::atan(y / x) : curl > 0.0 ? 90.0 : 0.0;
}

double TurnSums::strength() const {
    const double difference = divergence - curl;
    return safe_ratio(std::sqrt(difference * difference + 4.0 * product * product), curl + divergence);
}

void TurnScale::add(const TurnScale& other) {
    up.add(other.up);
    down.add(other.down);
    weight += other.weight;
    p_square += other.p_square;
    q_square += other.q_square;
    p_q += other.p_q;
}

const TurnSums& TurnScale::clearest() const { return down.strength() > up.strength() ? down : up; }

double TurnScale::curl_share() const { return std::min(up.share(), down.share()); }

double TurnScale::rms() const { return std::sqrt(safe_ratio(p_square + q_square, 2.0 * weight)); }

double TurnScale::shared() const { return safe_ratio(p_q * p_q, p_square * q_square); }

Result<Turn> measure_turn(const Stored& stored, const Execution& execution) {
    const std::vector<Rect> windows = sample_windows(stored.extent());
    std::vector<Turn> parts(windows.size());
    const auto body = [&](int begin, int end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
            Slopes slopes = slopes_of(stored, windows[k]);
            for (int scale = 0; scale < Turn::kScales; ++scale) {
                parts[k].scale[scale] = sum_scale(slopes);
                if (scale + 1 < Turn::kScales) slopes = halved(slopes);
            }
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, static_cast<int>(windows.size()), 1, body); !done) return done.error();
    Turn turn;
    for (const Turn& part : parts) {
        for (int scale = 0; scale < Turn::kScales; ++scale) turn.scale[scale].add(part.scale[scale]);
    }
    return turn;
}

}  // namespace tex::inline v1
