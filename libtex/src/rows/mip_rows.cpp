// SPDX-License-Identifier: Apache-2.0

#include "rows/mip_rows.h"

#include <algorithm>

#include "kernels/mip.h"

namespace tex {

float fade_at(const std::optional<Fade>& fade, int level) {
    if (!fade) return 0.0f;
    const float t = static_cast<float>(level - fade->first) / static_cast<float>(fade->last - fade->first);
    return std::clamp(t, 0.0f, 1.0f);
}

void finish_row(NormalRow row, int width, MipDomain domain, float fade) {
    const auto finish = domain == MipDomain::vector ? finish_vectors : finish_slopes;
    finish(row.x, row.y, row.z, width, fade);
}

MipRows::MipRows(const AxisFilter& x, const AxisFilter& y, Wrap wrap_x, int width)
    : y_(y), width_(width), across_(x, wrap_x, width), weights_(static_cast<std::size_t>(y.taps)) {}

void MipRows::make(const float* const* rows, int j, float* out) {
    for (int k = 0; k < y_.taps; ++k) weights_[static_cast<std::size_t>(k)] = y_.weight(k, j);
    filter_rows(rows, weights_.data(), y_.taps, width_, across_.row());
    across_.run(out);
}

}  // namespace tex
