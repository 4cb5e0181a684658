// SPDX-License-Identifier: Apache-2.0

#include "stream/y_witness.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "checks/curl.h"

namespace tex {
namespace {

constexpr int kWindow = 128;
constexpr int kLeastSide = 32;  // smaller maps show nothing

}  // namespace

YWitness::YWitness(Extent extent) : extent_(extent) {
    if (std::min(extent.width, extent.height) < kLeastSide) return;
    windows_ = sample_windows(extent, kWindow);
    for (const Rect& window : windows_) {
        const Extent size{window.width, window.height};
        slopes_.push_back({Plane<float>(size), Plane<float>(size)});
    }
}

void YWitness::add_row(int j, const VectorRow& row) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t k = 0; k < windows_.size(); ++k) {
        const Rect& window = windows_[k];
        if (j < window.y || j >= window.y + window.height) continue;
        float* const p = slopes_[k].p.row(j - window.y);
        float* const q = slopes_[k].q.row(j - window.y);
        for (int i = 0; i < window.width; ++i) {
            const float z = row.z[window.x + i];
            const bool usable = z >= kLeastZ;
            p[i] = usable ? -row.x[window.x + i] / z : kNone;
            q[i] = usable ? -row.y[window.x + i] / z : kNone;
        }
    }
}

std::optional<YAxis> YWitness::y() {
    if (windows_.empty()) return std::nullopt;
    for (Slopes& slopes : slopes_) widen_holes(slopes);
    return clear_y(measure_curl(extent_, windows_, [&](std::size_t k) { return std::move(slopes_[k]); }));
}

std::optional<YAxis> shown_y(const NormalMap& map) {
    YWitness witness(map.extent());
    for (int j = 0; j < map.extent().height; ++j) witness.add_row(j, {map.x.row(j), map.y.row(j), map.z.row(j)});
    return witness.y();
}

}  // namespace tex
