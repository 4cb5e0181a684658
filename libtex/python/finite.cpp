// SPDX-License-Identifier: Apache-2.0
#include "finite.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <future>
#include <thread>
#include <vector>

namespace tex::python {
namespace {

// Reading is limited by memory, which a few threads use up.
constexpr int kMostThreads = 4;
constexpr std::int64_t kTexelsPerThread = 1 << 20;  // 4 MB take as long as starting a few threads

bool rows_are_finite(PlaneView<const float> plane, int begin, int end) {
    constexpr std::uint32_t kInfinity = 0x7f800000U;
    for (int j = begin; j < end; ++j) {
        const float* const row = plane.row(j);
        std::uint32_t found = 0;  // all bits, once an exponent has all bits; every instruction set has this in vectors
        for (int i = 0; i < plane.extent.width; ++i) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, row + i, sizeof bits);
            found |= (bits & kInfinity) == kInfinity ? ~0U : 0U;
        }
        if (found != 0) return false;
    }
    return true;
}

int threads_for(Extent extent) {
    const auto wanted = static_cast<int>(std::min<std::int64_t>(extent.texels() / kTexelsPerThread, kMostThreads));
    return std::max(1, std::min(wanted, static_cast<int>(std::thread::hardware_concurrency())));
}

}  // namespace

bool is_finite(PlaneView<const float> plane) {
    const int height = plane.extent.height, threads = threads_for(plane.extent);
    const auto first_row = [&](int part) { return static_cast<int>(std::int64_t{height} * part / threads); };
    std::vector<std::future<bool>> others;
    for (int part = 1; part < threads; ++part) {
        others.push_back(std::async(rows_are_finite, plane, first_row(part), first_row(part + 1)));
    }
    bool finite = rows_are_finite(plane, 0, first_row(1));
    for (std::future<bool>& other : others) finite = other.get() && finite;
    return finite;
}

bool looks_like_colours(const NormalMap& map) {
    double as_components = 0.0, as_colours = 0.0;  // the distances from unit length
    const auto distance = [](float x, float y, float z) { return std::abs(std::sqrt(x * x + y * y + z * z) - 1.0f); };
    const Extent extent = map.extent();
    for (int j = 0; j < extent.height; ++j) {
        const float *const x = map.x.row(j), *const y = map.y.row(j), *const z = map.z.row(j);
        for (int i = 0; i < extent.width; ++i) {
            if (x[i] < 0.0f || y[i] < 0.0f) return false;  // most maps end here, in their first rows
            const float as_component = distance(x[i], y[i], z[i]);
            if (!std::isfinite(as_component)) continue;
            as_components += static_cast<double>(as_component);
            as_colours += static_cast<double>(distance(2.0f * x[i] - 1.0f, 2.0f * y[i] - 1.0f, 2.0f * z[i] - 1.0f));
        }
    }
    return as_components > 0.1 * static_cast<double>(extent.texels()) && as_colours < 0.5 * as_components;
}

}  // namespace tex::python
