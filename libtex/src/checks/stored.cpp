// SPDX-License-Identifier: Apache-2.0

#include "checks/stored.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <tex/types.h>

#include "checks/background.h"
#include "rows/unpack_rows.h"

namespace tex::inline v1 {
namespace {

constexpr int kWindowSize = 256;
constexpr int kWindowsAcross = 4;
constexpr int kPhase = 16;
constexpr int kHoleBorder = 4;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The first texel of window k of kWindowsAcross along an axis of n texels.
int window_begin(int n, int size, int k) {
    const std::int64_t room = n - std::min(n, size);
    return static_cast<int>(room * k / (kWindowsAcross - 1)) / kPhase * kPhase;
}

}  // namespace

void widen_holes(Slopes& slopes) {
    const Extent extent = slopes.extent();
    const auto pass = [&](int length, int lines, auto at) {
        for (int l = 0; l < lines; ++l) {
            int since = kHoleBorder + 1;  // texels since the last hole
            for (int k = 0; k < length; ++k) {
                const bool hole = std::isnan(at(k, l));
                if (!hole && since <= kHoleBorder) at(k, l) = kNan;
                since = hole ? 1 : since + 1;
            }
        }
    };
    auto& p = slopes.p;
    pass(extent.width, extent.height, [&](int k, int l) -> float& { return p.at(k, l); });
    pass(extent.width, extent.height, [&](int k, int l) -> float& { return p.at(extent.width - 1 - k, l); });
    pass(extent.height, extent.width, [&](int k, int l) -> float& { return p.at(l, k); });
    pass(extent.height, extent.width, [&](int k, int l) -> float& { return p.at(l, extent.height - 1 - k); });
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            if (std::isnan(p.at(i, j))) slopes.q.at(i, j) = kNan;
        }
    }
}

int Stored::channel(Component component) const {
    const auto count = std::min(image->planes.size(), swizzle.size());
    for (std::size_t c = 0; c < count; ++c) {
        if (swizzle[c] == component) return static_cast<int>(c);
    }
    return -1;
}

std::vector<Rect> sample_windows(Extent extent) { return sample_windows(extent, kWindowSize); }

std::vector<Rect> sample_windows(Extent extent, int size) {
    constexpr std::int64_t kWindows = std::int64_t{kWindowsAcross} * kWindowsAcross;
    if (extent.texels() <= kWindows * size * size) return {{0, 0, extent.width, extent.height}};
    std::vector<Rect> windows;
    for (int j = 0; j < kWindowsAcross; ++j) {
        for (int i = 0; i < kWindowsAcross; ++i) {
            windows.push_back({window_begin(extent.width, size, i), window_begin(extent.height, size, j),
                               std::min(extent.width, size), std::min(extent.height, size)});
        }
    }
    return windows;
}

bool stores_signed(const Image& image, const Swizzle& swizzle, ValueRange range) {
    if (const std::optional<bool> known = is_unsigned(image.sample, range)) return !*known;
    const Result<Sources> sources = sources_of(swizzle, (1u << image.planes.size()) - 1);
    if (!sources) return false;  // there are no vectors
    const auto row = [&](int channel, int j) {
        return channel < 0 ? nullptr : image.planes[static_cast<std::size_t>(channel)].row(j);
    };
    RangeEvidence evidence;
    for (int j = 0; j < image.extent().height && !evidence.negative; ++j)
        evidence.add(weigh_row(row(sources->x, j), row(sources->y, j), row(sources->z, j), image.extent().width));
    return !evidence.says_unsigned();
}

namespace {

// One row of slopes. Returns whether all are usable. The loop has no branches, so that compilers use vectors.
template <bool kSigned, bool kHasZ>
bool slope_row(const float* stored_x, const float* stored_y, const float* stored_z, float least_square, int width,
               float* p, float* q) {
    const auto component = [](float c) { return kSigned ? c : 2.0f * c - 1.0f; };
    int usable_texels = 0;
    for (int i = 0; i < width; ++i) {
        const float x = component(stored_x[i]), y = component(stored_y[i]);
        const float flat = x * x + y * y;
        const float z = kHasZ ? component(stored_z[i]) : reconstruct_z(x, y);
        const float square = flat + z * z;
        // Written so that NaN makes it false. Each & needs no jump.
        const bool usable = (square >= least_square) & (square <= 4.0f) & (z >= kLeastZ) & (kHasZ | (flat <= 1.04f));
        usable_texels += usable ? 1 : 0;
        const float across = -x / z, up = -y / z;
        p[i] = usable ? across : kNan;
        q[i] = usable ? up : kNan;
    }
    return usable_texels == width;
}

}  // namespace

Slopes slopes_of(const Stored& stored, Rect window) {
    const Extent extent{window.width, window.height};
    Slopes slopes{Plane<float>(extent), Plane<float>(extent)};
    const bool has_z = stored.has_z();
    const auto row_of = [&](Component component, int j) {
        const auto channel = static_cast<std::size_t>(stored.channel(component));
        return stored.image->planes[channel].row(window.y + j) + window.x;
    };
    const auto fill = stored.is_signed ? (has_z ? slope_row<true, true> : slope_row<true, false>)
                                       : (has_z ? slope_row<false, true> : slope_row<false, false>);
    // Blocks with z hold directions; encoders let lengths go where that brings these nearer.
    const float least_square = stored.in_blocks && has_z ? 0.01f : 0.25f;
    bool unusable = false;
    for (int j = 0; j < window.height; ++j) {
        float *const p = slopes.p.row(j), *const q = slopes.q.row(j);
        unusable |= !fill(row_of(Component::x, j), row_of(Component::y, j), has_z ? row_of(Component::z, j) : nullptr,
                          least_square, window.width, p, q);
        if (stored.transparent == nullptr) continue;
        for (int i = 0; i < window.width; ++i) {
            if (!stored.transparent->is_transparent(window.x + i, window.y + j)) continue;
            p[i] = q[i] = kNan;
            unusable = true;
        }
    }
    if (unusable) widen_holes(slopes);
    return slopes;
}

Slopes halved(const Slopes& slopes) {
    const Extent extent{slopes.extent().width / 2, slopes.extent().height / 2};
    Slopes half{Plane<float>(extent), Plane<float>(extent)};
    const auto reduce = [&](const Plane<float>& from, Plane<float>& to) {
        for (int j = 0; j < extent.height; ++j) {
            const float *upper = from.row(2 * j), *lower = from.row(2 * j + 1);
            for (int i = 0; i < extent.width; ++i, upper += 2, lower += 2) {
                to.at(i, j) = (upper[0] + upper[1] + lower[0] + lower[1]) * 0.25f;
            }
        }
    };
    reduce(slopes.p, half.p);
    reduce(slopes.q, half.q);
    return half;
}

}  // namespace tex::inline v1
