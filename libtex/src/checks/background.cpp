// SPDX-License-Identifier: Apache-2.0

#include "checks/background.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

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
        : is_signed_(stored.is_signed), x_(plane_of(stored, Component::x)), y_(plane_of(stored, Component::y)),
          z_(plane_of(stored, Component::z)) {}

    [[nodiscard]] StoredVector at(int i, int j) const {
        return {component(x_, i, j), component(y_, i, j), z_ == nullptr ? 0.0f : component(z_, i, j)};
    }
    [[nodiscard]] bool has_z() const { return z_ != nullptr; }
    // Marks the texels of a row that may be no normals: all but the plain ones.
    void mark_doubtful(int j, std::vector<std::uint8_t>& marks) const {
        const float *const x = x_->row(j), *const y = y_->row(j), *const z = has_z() ? z_->row(j) : x;
        const float scale = is_signed_ ? 1.0f : 2.0f, shift = is_signed_ ? 0.0f : -1.0f;
        const float z_scale = has_z() ? scale : 0.0f, z_shift = has_z() ? shift : 0.0f;
        const float least = has_z() ? kShortest * kShortest : -1.0f;
        const float most = has_z() ? kLongest * kLongest : kOutside * kOutside;
        std::uint8_t* const to = marks.data();
        for (int i = 0; i < static_cast<int>(marks.size()); ++i) {
            const float a = scale * x[i] + shift, b = scale * y[i] + shift, c = z_scale * z[i] + z_shift;
            const float square = a * a + b * b + c * c;
            const bool is_plain =
                (square >= least) & (square <= most) & (c > kNotOver) & (std::abs(std::abs(a) - kThird) >= kNearThird);
            to[i] = is_plain ? 0 : 1;  // 1 for NaN
        }
    }
    // Whether no filter and no codec makes this of normals. False for NaN.
    [[nodiscard]] bool is_no_normal(const StoredVector& v) const {
        const float square = v.square();
        if (is_bleached(v) || (has_z() && Background::is_turned_over(v.x, v.y, v.z))) return true;
        if (!has_z()) return square > kOutside * kOutside;
        if (is_short_flat(v)) return false;
        return square < kShortest * kShortest || (square > kLongest * kLongest && !is_long_normal(v));
    }
    // Whether this may be a mixture of normals and background.
    [[nodiscard]] bool is_off(const StoredVector& v) const {
        const float square = v.square();
        if (!has_z()) return square > 1.0f;
        const float most = 1.0f + kTwoCodes, least = 1.0f - kTwoCodes;
        return v.z < 0.0f || square > most * most || square < least * least;
    }

private:
    static constexpr float kThird = 0.57735f, kNearThird = 1.5f / 127.5f;  // of normalised black and white
    static constexpr float kNotOver = -0.9f;                               // vectors that are turned over lie below

    // Whether this is black or white, normalised by some program on the way. One that rebuilds z from x and y turns
    // black's z outwards.
    [[nodiscard]] bool is_bleached(const StoredVector& v) const {
        const auto is = [](float c) { return std::abs(std::abs(c) - kThird) < kNearThird; };
        return is(v.x) && is(v.y) && v.x * v.y > 0.0f && (!has_z() || (is(v.z) && (v.z > 0.0f || v.x < 0.0f)));
    }

    // Whether this is flat once it is a unit vector, as the flat texels of a map are whose vectors were all shortened.
    static bool is_short_flat(const StoredVector& v) {
        constexpr float kNear = 3.0f / 127.5f, kLeast = 0.1f;
        return v.z > kLeast && v.z <= 1.0f && std::abs(v.x) < kNear && std::abs(v.y) < kNear;
    }

    // Whether this is what tools make of steep bevels that they do not normalise: it leans, and points outwards.
    static bool is_long_normal(const StoredVector& v) {
        constexpr float kMost = 1.5f, kOutwards = 0.3f, kGrey = 0.1f;
        const auto [least, most] = std::minmax({v.x, v.y, v.z});
        return v.square() < kMost * kMost && v.z > kOutwards && most - least > kGrey;
    }

    static const Plane<float>* plane_of(const Stored& stored, Component component) {
        const int channel = stored.channel(component);
        return channel < 0 ? nullptr : &stored.image->planes[static_cast<std::size_t>(channel)];
    }
    [[nodiscard]] float component(const Plane<float>* plane, int i, int j) const {
        const float c = plane->at(i, j);
        return is_signed_ ? c : 2.0f * c - 1.0f;
    }

    const bool is_signed_;
    const Plane<float>*const x_, *const y_, *const z_;
};

std::size_t bin_of(float c) {
    return static_cast<std::size_t>(std::clamp(c * kBinsPerUnit + kBinsPerUnit + 0.5f, 0.0f, kGridBins - 1.0f));
}

using GridBin = std::uint32_t;

GridBin grid_bin(const StoredVector& v) {
    return static_cast<GridBin>((bin_of(v.x) * kGridBins + bin_of(v.y)) * kGridBins + bin_of(v.z));
}

// Finds the bin that occurs most often; of several, the first of the grid.
class BinCounts {
public:
    struct Most {
        GridBin bin = 0;
        std::size_t texels = 0;
    };

    void add(GridBin bin) {
        if (!counts_.empty()) {
            ++counts_[bin];
            return;
        }
        few_.push_back(bin);
        if (few_.size() < kFew) return;
        counts_.resize(std::size_t{kGridBins} * kGridBins * kGridBins);
        for (const GridBin each : few_) ++counts_[each];
    }
    Most most() {
        if (!counts_.empty()) {
            const auto found = std::max_element(counts_.begin(), counts_.end());
            return {static_cast<GridBin>(found - counts_.begin()), *found};
        }
        std::sort(few_.begin(), few_.end());
        Most most;
        for (std::size_t k = 0, next = 0; k < few_.size(); k = next) {
            while (next < few_.size() && few_[next] == few_[k]) ++next;
            if (next - k > most.texels) most = {few_[k], next - k};
        }
        return most;
    }

private:
    static constexpr std::size_t kFew = 1 << 14;  // below, clearing and searching a table takes longer

    std::vector<GridBin> few_;
    std::vector<std::uint32_t> counts_;
};

// The most frequent value among the vectors that are no normals.
std::optional<std::array<float, 3>> most_frequent(const StoredVectors& map, Extent extent,
                                                  const std::optional<Background>& transparent) {
    BinCounts bins;
    std::vector<std::uint8_t> is_doubtful(static_cast<std::size_t>(extent.width));
    for (int j = 0; j < extent.height; ++j) {
        map.mark_doubtful(j, is_doubtful);
        for (int i = 0; i < extent.width; ++i) {
            if (is_doubtful[static_cast<std::size_t>(i)] == 0) continue;
            const StoredVector v = map.at(i, j);
            if (!map.is_no_normal(v) || (transparent && transparent->holds(i, j))) continue;
            bins.add(grid_bin(v));
        }
    }
    const BinCounts::Most most = bins.most();
    if (static_cast<double>(most.texels) < kLeastBackground * static_cast<double>(extent.texels())) return {};
    const std::size_t bin = most.bin;
    const auto value = [](std::size_t k) { return static_cast<float>(k) / kBinsPerUnit - 1.0f; };
    return std::array{value(bin / (std::size_t{kGridBins} * kGridBins)), value(bin / kGridBins % kGridBins),
                      value(bin % kGridBins)};
}

// Marks the texels that have the value. True if most of them lie together: single ones are damage.
bool mark_value(const StoredVectors& map, Extent extent, Background& background) {
    std::int64_t together = 0;
    const auto near = [](float a, float b) { return std::abs(a - b) <= kSame; };
    const auto& value = background.value;
    for (int j = 0; j < extent.height; ++j) {
        std::uint8_t* const mask =
            background.mask.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width);
        for (int i = 0; i < extent.width; ++i) {
            if (mask[i] != 0) continue;
            const StoredVector v = map.at(i, j);
            if (!near(v.x, value[0]) || !near(v.y, value[1]) || !near(v.z, value[2])) continue;
            mask[i] = Background::kValue;
            if (background.texels++ == 0) background.column = i, background.row = j;
            together += (i == 0 || mask[i - 1] != 0) && (j == 0 || mask[i - extent.width] != 0) ? 1 : 0;
        }
    }
    return static_cast<double>(background.texels) >= kLeastBackground * static_cast<double>(extent.texels()) &&
           static_cast<double>(together) >= kTogether * static_cast<double>(background.texels);
}

// Marks what a filter or a block codec mixed with it.
Result<void> mark_mixtures(const StoredVectors& map, Extent extent, int reach, const Execution& execution,
                           Background& background) {
    const auto at = [&](int i, int j) -> std::uint8_t& {
        return background
            .mask[static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i)];
    };
    // What is left of grey has no direction. Other values may be damage of the whole map.
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
                if (at(x, y) == Background::kValue) return true;
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
    background.masked = background.texels + background.transparent;
    for (int j = 0; j < extent.height; ++j) {
        for (const int i : mixed[static_cast<std::size_t>(j)]) at(i, j) = Background::kMixed;
        background.masked += static_cast<std::int64_t>(mixed[static_cast<std::size_t>(j)].size());
    }
    return {};
}

// A value that points straight into the surface is background if the other vectors do not, but for those that a filter
// mixed with it. In object space, and where blue is inverted, they do.
bool others_point_outwards(const StoredVectors& map, Extent extent, const Background& background) {
    constexpr float kBehind = -0.1f;
    constexpr double kMostBehind = 0.01, kLeastOthers = 0.005;
    std::int64_t behind = 0, others = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            if (background.holds(i, j)) continue;
            ++others;
            behind += map.at(i, j).z < kBehind ? 1 : 0;
        }
    }
    return static_cast<double>(behind) <= kMostBehind * static_cast<double>(others) &&
           static_cast<double>(others) >= kLeastOthers * static_cast<double>(extent.texels());
}

// A short vector is no background if the others are short as well, as after a contrast: then it is one of them.
bool are_others_as_short(const StoredVectors& map, Extent extent, const Background& background) {
    constexpr float kLeast = 0.15f;               // shorter ones are as good as grey
    constexpr float kMost = kShortest + 0.0625f;  // `value` is that of a bin
    constexpr double kLeastOfMean = 0.6;          // of their mean length
    const auto [x, y, z] = background.value;
    const float square = x * x + y * y + z * z;
    if (!map.has_z() || square < kLeast * kLeast || square > kMost * kMost || z < kLeast) return false;
    double sum = 0.0;
    std::int64_t others = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            if (background.holds(i, j)) continue;
            ++others;
            sum += std::sqrt(map.at(i, j).square());
        }
    }
    return std::sqrt(square) * static_cast<double>(others) >= kLeastOfMean * sum;
}

// Whether alpha 0 hides texels: alpha is a cut-out, nearly 1 in half of the others or more, or no normals are below it.
// In heights, 0 is the deepest place, and its normals are seen.
bool hides_something(const Stored& stored, const Background& transparent) {
    constexpr float kOpaque = 0.98f, kUnit = 0.12f;
    constexpr double kCutOut = 0.5, kNormals = 0.9;
    const StoredVectors map(stored);
    const Extent extent = stored.extent();
    std::int64_t opaque = 0, units = 0;
    for (int j = 0; j < extent.height; ++j) {
        const float* const alpha = stored.image->planes[3].row(j);
        for (int i = 0; i < extent.width; ++i) {
            opaque += alpha[i] >= kOpaque ? 1 : 0;
            if (transparent.holds(i, j)) units += std::abs(std::sqrt(map.at(i, j).square()) - 1.0f) < kUnit ? 1 : 0;
        }
    }
    const auto all = static_cast<double>(extent.texels()), hidden = static_cast<double>(transparent.transparent);
    return static_cast<double>(opaque) >= kCutOut * (all - hidden) ||
           (map.has_z() && static_cast<double>(units) < kNormals * hidden);
}

}  // namespace

std::optional<Background> find_transparent(const Stored& stored) {
    constexpr std::size_t kAlpha = 3;
    constexpr double kLeastSeen = 0.02;  // share of the texels: alpha that is 0 nearly everywhere is no cut-out
    const auto& planes = stored.image->planes;
    const Component held = stored.swizzle[kAlpha];
    if (planes.size() <= kAlpha || held == Component::x || held == Component::y || held == Component::z) return {};
    const Extent extent = stored.extent();
    std::optional<Background> found;
    for (int j = 0; j < extent.height; ++j) {
        const float* const alpha = planes[kAlpha].row(j);
        const std::int64_t zeros = std::count(alpha, alpha + extent.width, 0.0f);
        if (zeros == 0) continue;
        if (!found) {
            found.emplace();
            found->width = extent.width;
            found->mask.resize(static_cast<std::size_t>(extent.texels()));
        }
        std::uint8_t* const mask =
            found->mask.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width);
        for (int i = 0; i < extent.width; ++i) mask[i] = alpha[i] == 0.0f ? Background::kTransparent : 0;
        found->transparent += zeros;
    }
    if (!found) return found;
    if (!hides_something(stored, *found)) return {};
    found->masked = found->transparent;
    const auto seen = static_cast<double>(extent.texels() - found->transparent);
    if (seen < kLeastSeen * static_cast<double>(extent.texels())) return {};
    return found;
}

Result<std::optional<Background>> find_background(const Stored& stored, const Execution& execution,
                                                  std::optional<Background> transparent) {
    const Extent extent = stored.extent();
    const StoredVectors map(stored);
    const auto value = most_frequent(map, extent, transparent);
    if (!value) return transparent;
    Background background = transparent ? *transparent : Background();
    background.value = *value;
    background.width = extent.width;
    background.mask.resize(static_cast<std::size_t>(extent.texels()));
    if (!mark_value(map, extent, background) || are_others_as_short(map, extent, background)) return transparent;
    const int reach = stored.in_blocks ? 2 * kMixReach : kMixReach;
    if (auto done = mark_mixtures(map, extent, reach, execution, background); !done) return done.error();
    if (background.is_turned_over() && !others_point_outwards(map, extent, background)) return transparent;
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
    const auto is_third = [&](std::size_t k, float sign) {
        return std::abs(background.value[k] - sign * kThird) < kNear;
    };
    if (!stored.is_signed && components == 3 && is_third(0, -1.0f) && is_third(1, -1.0f) && is_third(2, 1.0f))
        return "black, normalised";
    std::string text = "(";
    for (int k = 0; k < components; ++k)
        text += (k > 0 ? ", " : "") + decimal(static_cast<double>(background.value[static_cast<std::size_t>(k)]), 2);
    return text + ")";
}

}  // namespace tex::inline v1
