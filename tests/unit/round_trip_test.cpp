// SPDX-License-Identifier: Apache-2.0
//
// pack() and unpack() in sequence: how far normals move in each encoding.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "unit/textures.h"

namespace tex {
namespace {

// Normals that lean in all directions, by up to about 60 degrees, with features of a few texels.
NormalMap waves(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = std::sin(0.31 * i + 0.07 * j) + 0.3 * std::sin(1.7 * i);
            const double y = std::cos(0.23 * j - 0.11 * i) + 0.3 * std::cos(1.3 * j + 0.5 * i);
            const double length = std::sqrt(x * x + y * y + 1);
            map.x.at(i, j) = static_cast<float>(x / length);
            map.y.at(i, j) = static_cast<float>(y / length);
            map.z.at(i, j) = static_cast<float>(1 / length);
        }
    }
    return map;
}

MipChain chain_of(Extent extent, int levels) {
    MipChain chain;
    for (int k = 0; k < levels; ++k) chain.levels.push_back(waves(level_extent(extent, k)));
    return chain;
}

Result<MipChain> through(const MipChain& chain, Encoding encoding, YAxis y_axis = YAxis::up,
                         Effort effort = Effort::normal) {
    PackOptions options;
    options.encoding = encoding;
    options.y_axis = y_axis;
    options.effort = effort;
    const auto texture = pack(chain, options);
    if (!texture) return texture.error();
    return unpack(*texture);
}

// Bounds for each component before z is reconstructed. A code of k bits is at most half a step, 1 / (2^k - 1), from n;
// snorm 1 / (2^k - 2); half 2^-12 below 1/2 and 2^-11 ... of the value; float only rounds lengths. If z is stored,
// renormalising moves a vector by no more than its error: the angle is at most asin(sqrt(3) bound). If z is
// reconstructed, the error grows by 1 / z.
struct Bound {
    Encoding encoding;
    double component;  // of x and y as stored
    bool has_z;
};

TEST(RoundTrip, StaysWithinTheQuantisationOfEachEncoding) {
    const Bound bounds[] = {
        {Encoding::rgb8, 1.0 / 255, true},  {Encoding::rgba8, 1.0 / 255, true},   {Encoding::rgb16, 1.0 / 65535, true},
        {Encoding::half, 1.0 / 4096, true}, {Encoding::float_, 1e-7, true},       {Encoding::ag8, 1.0 / 255, false},
        {Encoding::rg8, 1.0 / 255, false},  {Encoding::rg16, 1.0 / 65535, false},
    };
    const MipChain chain = chain_of({61, 43}, 6);
    for (const Bound& bound : bounds) {
        for (const YAxis y_axis : {YAxis::up, YAxis::down}) {
            const auto back = through(chain, bound.encoding, y_axis);
            ASSERT_TRUE(back);
            ASSERT_EQ(back->levels.size(), chain.levels.size());
            for (std::size_t k = 0; k < chain.levels.size(); ++k) {
                const NormalMap& before = chain.levels[k];
                const NormalMap& after = back->levels[k];
                const auto angles = compare(before, after);
                ASSERT_TRUE(angles);
                for (int j = 0; j < before.extent().height; ++j) {
                    for (int i = 0; i < before.extent().width; ++i) {
                        const double z = static_cast<double>(before.z.at(i, j));
                        const double limit = bound.has_z ? std::sqrt(3.0) * bound.component
                                                         : std::sqrt(2.0) * bound.component / (z - 2 * bound.component);
                        // A millionth of a radian for the rounding of float itself.
                        const double degrees = (std::asin(limit) + 1e-6) * 180 / 3.14159265358979;
                        ASSERT_LE(static_cast<double>(angles->degrees.at(i, j)), degrees)
                            << name_of(kEncodingNames, bound.encoding) << " level " << k << " " << i << "," << j;
                    }
                }
            }
        }
    }
}

// Blocks: an encoder is never worse than endpoints at the extremes of a block, rounded to their codes. With n values
// between them, a texel is then at most (max - min) / (2 (n - 1)) + half a step of the endpoints away. The encoder
// minimises squares, so this holds for the root mean square of each block.
TEST(RoundTrip, StaysWithinTheFitOfTheExtremesInEachBlock) {
    struct BlockBound {
        Encoding encoding;
        double x_values, x_step, y_values, y_step;
    };
    const BlockBound bounds[] = {
        {Encoding::dxt5nm, 8, 2.0 / 255, 4, 2.0 / 63},
        {Encoding::bc5, 8, 2.0 / 255, 8, 2.0 / 255},
        {Encoding::bc5_snorm, 8, 1.0 / 127, 8, 1.0 / 127},
    };
    const MipChain chain = chain_of({61, 43}, 1);
    const NormalMap& before = chain.levels[0];
    for (const BlockBound& bound : bounds) {
        const auto back = through(chain, bound.encoding);
        ASSERT_TRUE(back);
        const NormalMap& after = back->levels[0];
        const auto check = [&](const Plane<float>& from, const Plane<float>& to, double values, double step, int left,
                               int top) {
            double least = 1, most = -1, squares = 0;
            int count = 0;
            for (int j = top; j < std::min(top + 4, 43); ++j) {
                for (int i = left; i < std::min(left + 4, 61); ++i, ++count) {
                    const double n = static_cast<double>(from.at(i, j));
                    least = std::min(least, n);
                    most = std::max(most, n);
                    squares += (static_cast<double>(to.at(i, j)) - n) * (static_cast<double>(to.at(i, j)) - n);
                }
            }
            EXPECT_LE(std::sqrt(squares / count), (most - least) / (2 * (values - 1)) + step / 2 + 1e-6)
                << name_of(kEncodingNames, bound.encoding) << " " << left << "," << top;
        };
        for (int top = 0; top < 43; top += 4) {
            for (int left = 0; left < 61; left += 4) {
                check(before.x, after.x, bound.x_values, bound.x_step, left, top);
                check(before.y, after.y, bound.y_values, bound.y_step, left, top);
            }
        }
    }
}

// The encoding that stores the same values as `texture`, if there is one.
std::optional<Encoding> encoding_of(const Texture& texture) {
    const bool has_z = std::find(texture.swizzle.begin(), texture.swizzle.end(), Component::z) != texture.swizzle.end();
    for (const auto& row : kEncodingNames) {
        if (encoding_info(row.value).format != texture.format || row.value == Encoding::ag8) continue;
        const bool wants_z = row.value == Encoding::rgb8 || row.value == Encoding::rgba8;
        if (has_z == wants_z) return row.value;
    }
    return std::nullopt;
}

// A texture that is unpacked and packed again stays the same; at the default effort, within 0.05 degrees on average,
// because the encoder finds the blocks' own values again. Vectors keep their stored length. If z is not stored, this
// matters only outside the unit circle.
TEST(RoundTrip, RepacksEveryRealTextureWithoutFurtherLoss) {
    TEX_NEEDS_SHARED_DATA();
    int repacked = 0;
    for (const char* folder : {"dds", "dds/reference"}) {
        for (const auto& path : files_in(folder, ".dds")) {
            const auto texture = read_texture(path.string());
            ASSERT_TRUE(texture) << texture.error().message();
            const auto encoding = encoding_of(*texture);
            if (!encoding) continue;
            ++repacked;
            UnpackOptions keep;
            keep.keep_length = true;
            const auto kept = unpack(*texture, keep);
            const auto once = unpack(*texture);
            ASSERT_TRUE(kept && once);
            for (const auto& [effort, limit] : {std::pair{Effort::normal, 0.05}, {Effort::best, 0.0005}}) {
                const auto twice = through(*kept, *encoding, YAxis::up, effort);
                ASSERT_TRUE(twice);
                for (std::size_t k = 0; k < once->levels.size(); ++k) {
                    const auto angles = compare(once->levels[k], twice->levels[k]);
                    ASSERT_TRUE(angles);
                    EXPECT_LE(angles->error.mean, limit) << path.stem() << " " << name_of(kEffortNames, effort)
                                                         << " level " << k << " max " << angles->error.max;
                }
            }
        }
    }
    EXPECT_EQ(repacked, 17);
}

}  // namespace
}  // namespace tex
