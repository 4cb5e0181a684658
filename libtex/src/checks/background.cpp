// SPDX-License-Identifier: Apache-2.0

#include "checks/background.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "checks/findings.h"
#include "checks/texel_counts.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr double kTogether = 0.5;  // of the texels: the share whose left and upper neighbours have the value, too
constexpr float kShortest = 0.5f, kLongest = 1.25f;  // of what may be a normal that was filtered or compressed
constexpr float kOutside = 1.3f;                     // the same for x and y, if z is not stored
constexpr int kMixReach = 2;                         // of filters across the border, in texels
constexpr int kRingReach = 8;                        // of JPEG's blocks, whose errors stay inside them
constexpr float kAlike = 0.3f;                       // what JPEG of low quality makes of the value there

// A grid of bins over the cube of stored values from -1 to 1. Black, grey and white lie in the middle of a bin.
constexpr int kGridBins = 65;
constexpr float kBinsPerUnit = 32.0f;
constexpr float kSame = 5.0f / 127.5f;  // codes of 8 bits, as block codecs and JPEG leave them

struct StoredVector {
    float x, y, z;
    [[nodiscard]] float square() const { return x * x + y * y + z * z; }
};

class StoredVectors {
public:
    explicit StoredVectors(const Stored& stored)
        : stored_(stored), x_(stored.channel(Component::x)), y_(stored.channel(Component::y)),
          z_(stored.channel(Component::z)) {}

    [[nodiscard]] StoredVector at(int i, int j) const {
        return {stored_.component(x_, i, j), stored_.component(y_, i, j), z_ < 0 ? 0.0f : stored_.component(z_, i, j)};
    }
    // Whether no filter and no codec makes this of normals. False for NaN.
    [[nodiscard]] bool is_no_normal(const StoredVector& v) const {
        const float square = v.square();
        if (is_bleached(v)) return true;
        if (z_ < 0) return square > kOutside * kOutside;
        return square < kShortest * kShortest || square > kLongest * kLongest;
    }
    // Whether this may be a mixture of normals and background.
    [[nodiscard]] bool is_off(const StoredVector& v) const {
        const float square = v.square();
        if (z_ < 0) return square > 1.0f;
        const float most = 1.0f + kTwoCodes, least = 1.0f - kTwoCodes;
        return v.z < 0.0f || square > most * most || square < least * least;
    }

private:
    // Whether this is black or white, normalised by some program on the way.
    [[nodiscard]] bool is_bleached(const StoredVector& v) const {
        constexpr float kThird = 0.57735f, kCode = 1.5f / 127.5f;
        const auto is = [&](float c) { return std::abs(std::abs(c) - kThird) < kCode && c * v.x > 0.0f; };
        return is(v.x) && is(v.y) && (z_ < 0 || is(v.z));
    }

    const Stored& stored_;
    const int x_, y_, z_;
};

std::size_t bin_of(float c) {
    return static_cast<std::size_t>(std::clamp(c * kBinsPerUnit + kBinsPerUnit + 0.5f, 0.0f, kGridBins - 1.0f));
}

// The most frequent value among the vectors that are no normals.
std::optional<std::array<float, 3>> most_frequent(const StoredVectors& map, Extent extent) {
    std::vector<std::uint32_t> counts(std::size_t{kGridBins} * kGridBins * kGridBins);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const StoredVector v = map.at(i, j);
            if (map.is_no_normal(v)) ++counts[(bin_of(v.x) * kGridBins + bin_of(v.y)) * kGridBins + bin_of(v.z)];
        }
    }
    const auto most = std::max_element(counts.begin(), counts.end());
    if (*most < kLeastBackground * static_cast<double>(extent.texels())) return {};
    const auto bin = static_cast<std::size_t>(most - counts.begin());
    const auto value = [](std::size_t k) { return static_cast<float>(k) / kBinsPerUnit - 1.0f; };
    return std::array{value(bin / (std::size_t{kGridBins} * kGridBins)), value(bin / kGridBins % kGridBins),
                      value(bin % kGridBins)};
}

// Marks the texels that have the value with 1. True if most of them lie together: single ones are damage.
bool mark_value(const StoredVectors& map, Extent extent, Background& background) {
    std::int64_t together = 0;
    const auto near = [](float a, float b) { return std::abs(a - b) <= kSame; };
    const auto& value = background.value;
    for (int j = 0; j < extent.height; ++j) {
        std::uint8_t* const mask =
            background.mask.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width);
        for (int i = 0; i < extent.width; ++i) {
            const StoredVector v = map.at(i, j);
            if (!near(v.x, value[0]) || !near(v.y, value[1]) || !near(v.z, value[2])) continue;
            mask[i] = 1;
            if (background.texels++ == 0) background.column = i, background.row = j;
            together += (i == 0 || mask[i - 1] != 0) && (j == 0 || mask[i - extent.width] != 0) ? 1 : 0;
        }
    }
    return static_cast<double>(background.texels) >= kLeastBackground * static_cast<double>(extent.texels()) &&
           static_cast<double>(together) >= kTogether * static_cast<double>(background.texels);
}

// Marks with 2 what a filter or a block codec mixed with it.
Result<void> mark_mixtures(const StoredVectors& map, Extent extent, int reach, const Execution& execution,
                           Background& background) {
    const auto at = [&](int i, int j) -> std::uint8_t& {
        return background
            .mask[static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i)];
    };
    // Of grey: what is left of it has no direction. Other values may be damage of the whole map.
    const auto [bx, by, bz] = background.value;
    const bool is_short = bx * bx + by * by + bz * bz < kShortest * kShortest;
    const auto is_like = [&](const StoredVector& v) {
        if (!is_short) return false;
        const auto near = [](float a, float b) { return std::abs(a - b) <= kAlike; };
        return near(v.x, background.value[0]) && near(v.y, background.value[1]) && near(v.z, background.value[2]);
    };
    const auto is_near = [&](int i, int j, int within) {
        for (int y = std::max(0, j - within); y <= std::min(extent.height - 1, j + within); ++y) {
            for (int x = std::max(0, i - within); x <= std::min(extent.width - 1, i + within); ++x) {
                if (at(x, y) == 1) return true;
            }
        }
        return false;
    };
    std::vector<std::vector<int>> mixed(static_cast<std::size_t>(extent.height));
    const auto find = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                if (at(i, j) != 0) continue;
                const StoredVector v = map.at(i, j);
                if (map.is_off(v) && (is_near(i, j, reach) || (is_like(v) && is_near(i, j, kRingReach))))
                    mixed[static_cast<std::size_t>(j)].push_back(i);
            }
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, extent.height, kRowsPerPiece, find); !done) return done;
    background.masked = background.texels;
    for (int j = 0; j < extent.height; ++j) {
        for (const int i : mixed[static_cast<std::size_t>(j)]) at(i, j) = 2;
        background.masked += static_cast<std::int64_t>(mixed[static_cast<std::size_t>(j)].size());
    }
    return {};
}

}  // namespace

Result<std::optional<Background>> find_background(const Stored& stored, const Execution& execution) {
    const Extent extent = stored.extent();
    const StoredVectors map(stored);
    const auto value = most_frequent(map, extent);
    if (!value) return std::optional<Background>();
    Background background;
    background.value = *value;
    background.width = extent.width;
    background.mask.resize(static_cast<std::size_t>(extent.texels()));
    if (!mark_value(map, extent, background)) return std::optional<Background>();
    const int reach = stored.in_blocks ? 2 * kMixReach : kMixReach;
    if (auto done = mark_mixtures(map, extent, reach, execution, background); !done) return done.error();
    return std::optional(std::move(background));
}

std::string background_name(const Background& background, const Stored& stored) {
    constexpr float kNear = 0.05f, kThird = 0.57735f;  // of normalised black and white
    const int components = stored.has_z() ? 3 : 2;
    struct Shade {
        float value;
        const char* name;
    };
    for (const Shade& shade : {Shade{-1.0f, "black"}, Shade{-kThird, "black"}, Shade{0.0f, "grey"},
                               Shade{kThird, "white"}, Shade{1.0f, "white"}}) {
        bool all = !stored.is_signed;  // of (n + 1) / 2, the colours that a picture shows
        for (int k = 0; k < components; ++k)
            all = all && std::abs(background.value[static_cast<std::size_t>(k)] - shade.value) < kNear;
        if (all) return shade.name;
    }
    std::string text = "(";
    for (int k = 0; k < components; ++k)
        text += (k > 0 ? ", " : "") + decimal(static_cast<double>(background.value[static_cast<std::size_t>(k)]), 2);
    return text + ")";
}

}  // namespace tex::inline v1
