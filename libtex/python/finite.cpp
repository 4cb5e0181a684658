// SPDX-License-Identifier: Apache-2.0
#include "finite.h"

#include <algorithm>
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

}  // namespace tex::python
