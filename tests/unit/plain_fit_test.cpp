// SPDX-License-Identifier: Apache-2.0
// Compares the block encoders of pack() with a plain fit of each block, which tests/reference implements again in
// double.

#include <tex/pack.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "reference/plain_fit.h"
#include "reference/real_maps.h"
#include "unit/packing.h"
#include "unit/textures.h"

namespace {

using packing::bumpy;
using packing::chain_of;
using packing::decode_codes;
using packing::pack_bytes;
using tex::Effort;
using tex::Encoding;
using tex::MipChain;
using tex::reference::BlockValues;
using tex::reference::Palette;
using tex::reference::plain_fit;

// The root mean square error of the exact palette with `steps` spacings between the extremes, which are moved inwards
// by a part of the range; and the range.
struct Unrefined {
    double error, range;
};
Unrefined unrefined(const BlockValues& values, int steps, double part) {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const double range = *greatest - *least;
    const double spacing = range * (1 - 2 * part) / steps;
    double sum = 0;
    for (const double value : values) {
        const double from = value - *least - part * range;
        const double index = spacing > 0 ? std::clamp(std::floor(from / spacing + 0.5), 0.0, 1.0 * steps) : 0;
        sum += (from - index * spacing) * (from - index * spacing);
    }
    return {std::sqrt(sum / 16), range};
}

// The errors of the two channels of every block, those of the plain fit, and those of the palettes between the
// extremes.
struct Errors {
    double x = 0, y = 0, plain_x = 0, plain_y = 0;
    Unrefined unrefined_x{}, unrefined_y{};
};
std::vector<Errors> block_errors(const MipChain& chain, Effort effort) {
    const int across = chain.levels[0].extent().width / 4;
    const int down = chain.levels[0].extent().height / 4;
    const auto bytes = pack_bytes(chain, {Encoding::dxt5nm, tex::YAxis::up, effort});
    const double unit = effort == Effort::best ? tex::kCodeUnit : 128.0;  // encoders first round to this part of a code
    std::vector<Errors> errors;
    for (int block = 0; block < across * down; ++block) {
        BlockValues x, y;
        float decoded_x[16], decoded_y[16];
        decode_codes(bytes.data() + 16 * block, Encoding::dxt5nm, decoded_x, decoded_y);
        Errors e;
        for (int k = 0; k < 16; ++k) {
            const int i = block % across * 4 + k % 4;
            const int j = block / across * 4 + k / 4;
            const auto t = static_cast<std::size_t>(k);
            x[t] = std::floor((chain.levels[0].x.at(i, j) * 127.5 + 127.5) * unit + 0.5) / unit;
            y[t] = std::floor((chain.levels[0].y.at(i, j) * 127.5 + 127.5) * unit + 0.5) / unit;
            e.x += (x[t] - decoded_x[k]) * (x[t] - decoded_x[k]);
            e.y += (y[t] - decoded_y[k]) * (y[t] - decoded_y[k]);
        }
        e.plain_x = plain_fit(x, Palette::bc4_unorm);
        e.plain_y = plain_fit(y, Palette::green);
        e.unrefined_x = unrefined(x, 7, 0);
        e.unrefined_y = unrefined(y, 3, 1.0 / 16);
        errors.push_back(e);
    }
    return errors;
}

TEST(Pack, NoBlockIsWorseThanAPlainFitWithLeastSquaresOrInFastThanOneWithout) {
    for (const float steepness : {0.02f, 0.3f, 1.0f}) {
        MipChain chain = chain_of(bumpy({256, 256}, 21));
        for (int j = 0; j < 256; ++j) {
            for (int i = 0; i < 256; ++i) {
                chain.levels[0].x.at(i, j) *= steepness;
                chain.levels[0].y.at(i, j) *= steepness;
            }
        }
        // fast may be worse, but by no more than fit.h says.
        for (const Errors& e : block_errors(chain, Effort::fast)) {
            const double alpha_rounding = e.unrefined_x.range < 1 ? 1.0 : 0.5;
            ASSERT_LE(std::sqrt(e.x / 16), e.unrefined_x.error + alpha_rounding + e.unrefined_x.range / 400);
            ASSERT_LE(std::sqrt(e.y / 16), e.unrefined_y.error + 2.8 + e.unrefined_y.range / 400);
        }
        for (const Effort effort : {Effort::normal, Effort::best}) {
            for (const Errors& e : block_errors(chain, effort)) {
                ASSERT_LE(e.x, 1.001 * e.plain_x + 0.01) << tex::name_of(tex::kEffortNames, effort) << " " << steepness;
                ASSERT_LE(e.y, 1.001 * e.plain_y + 0.01) << tex::name_of(tex::kEffortNames, effort) << " " << steepness;
            }
        }
    }
}

TEST(Pack, NormalIsBetterThanAPlainFitAndFastHardlyWorse) {
    const MipChain chain = chain_of(bumpy({256, 64}, 21));
    for (const Effort effort : {Effort::fast, Effort::normal}) {
        Errors sum;
        for (const Errors& e : block_errors(chain, effort)) {
            sum.x += e.x, sum.y += e.y, sum.plain_x += e.plain_x, sum.plain_y += e.plain_y;
        }
        const double limit = effort == Effort::normal ? 0.95 : 1.1;
        EXPECT_LT(sum.x, limit * sum.plain_x);
        EXPECT_LT(sum.y, limit * sum.plain_y);
    }
}

// Both channels of a block and what they are encoded to, in codes of the encoding, without rounding.
struct Channel {
    Palette palette;
    BlockValues values;
    BlockValues decoded;

    [[nodiscard]] double error() const {
        double sum = 0;
        for (std::size_t k = 0; k < 16; ++k) sum += (values[k] - decoded[k]) * (values[k] - decoded[k]);
        return sum;
    }
};

int top_of(Encoding encoding) { return encoding == Encoding::bc5_snorm ? 254 : 255; }

// Calls visit(channel) for each channel of each whole block, with values rounded to 1/unit of a code.
template <class Visit>
void for_channels(const tex::Plane<float>& x, const tex::Plane<float>& y, Encoding encoding, Effort effort, double unit,
                  Visit visit) {
    const int across = x.extent().width / 4;
    std::vector<std::byte> row(16 * static_cast<std::size_t>((x.extent().width + 3) / 4));
    for (int j = 0; j + 4 <= x.extent().height; j += 4) {
        const tex::Extent extent{x.extent().width, 4};
        EXPECT_TRUE(tex::encode_blocks({x.row(j), extent, x.stride()}, {y.row(j), extent, y.stride()},
                                       {encoding, tex::YAxis::up, effort}, row.data(), row.size()));
        for (int block = 0; block < across; ++block) {
            float decoded[2][16];
            decode_codes(row.data() + 16 * static_cast<std::ptrdiff_t>(block), encoding, decoded[0], decoded[1]);
            for (int c = 0; c < 2; ++c) {
                Channel channel{encoding == Encoding::bc5_snorm          ? Palette::bc4_snorm
                                : c == 1 && encoding == Encoding::dxt5nm ? Palette::green
                                                                         : Palette::bc4_unorm,
                                {},
                                {}};
                for (int k = 0; k < 16; ++k) {
                    const auto t = static_cast<std::size_t>(k);
                    const double half = 0.5 * top_of(encoding);
                    const double n = (c == 0 ? x : y).at(4 * block + k % 4, j + k / 4);
                    channel.values[t] = std::floor((n * half + half) * unit + 0.5) / unit;
                    // Sevenths, fifths and thirds of a code.
                    const double decoded_code = static_cast<double>(decoded[c][k]) * top_of(encoding) / 255.0;
                    channel.decoded[t] = std::floor(decoded_code * 105 + 0.5) / 105;
                }
                visit(channel);
            }
        }
    }
}

// How many channels are worse than their plain fit, and how many there are.
struct Count {
    int worse = 0;
    int channels = 0;
};

// Rounding of errors is allowed: none if all values are whole codes of a range of up to 127, and range^2 / 10^6.
Count count_worse(const tex::Plane<float>& x, const tex::Plane<float>& y, Encoding encoding) {
    Count count;
    for_channels(x, y, encoding, Effort::normal, 128, [&](const Channel& channel) {
        const auto [least, greatest] = std::minmax_element(channel.values.begin(), channel.values.end());
        const bool whole = std::all_of(channel.values.begin(), channel.values.end(),
                                       [](double value) { return value == std::floor(value); });
        const double range = *greatest - *least;
        const double rounding = whole && range <= 127 ? 0 : 1e-6 * range * range;
        const double plain = plain_fit(channel.values, channel.palette);
        ++count.channels;
        if (channel.error() <= plain + rounding + 1e-9) return;
        ++count.worse;
        EXPECT_FALSE(whole) << channel.error() << " > " << plain << testing::PrintToString(channel.values);
    });
    return count;
}

// A plane of blocks, from value(block, texel) in codes of the encoding.
template <class Value>
tex::Plane<float> plane_of(int blocks, Encoding encoding, Value value) {
    tex::Plane<float> plane({4 * blocks, 4});
    for (int block = 0; block < blocks; ++block) {
        for (int k = 0; k < 16; ++k) {
            const double code = std::clamp<double>(value(block, k), 0.0, top_of(encoding));
            plane.at(4 * block + k % 4, k / 4) = static_cast<float>(2 * code / top_of(encoding) - 1);
        }
    }
    return plane;
}

// 0 to count - 1.
double draw(std::mt19937& random, unsigned count) { return static_cast<double>(random() % count); }

constexpr Encoding kInBlocks[] = {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm};

TEST(PlainFit, IsExactWhereCodesLieInTheMiddleBetweenTwoValues) {
    const BlockValues values{127, 119, 134, 138, 129, 112, 125, 137, 123, 114, 118, 125, 125, 123, 119, 115};
    EXPECT_NEAR(plain_fit(values, Palette::bc4_unorm), 453.0 / 49.0, 1e-12);  // 9.245
    for (const Encoding encoding : kInBlocks) {
        const auto at = [&](int, int k) { return values[static_cast<std::size_t>(k)]; };
        EXPECT_EQ(count_worse(plane_of(1, encoding, at), plane_of(1, encoding, at), encoding).worse, 0);
    }
}

TEST(PlainFit, IsNeverBetterThanNormalOnWholeCodes) {
    for (const Encoding encoding : kInBlocks) {
        std::mt19937 random(7);
        double base = 0, range = 0, outlier = 0;
        int at = 0;
        const auto next_block = [&](int k) {
            if (k != 0) return;
            base = draw(random, 256);
            range = std::exp2(draw(random, 800) / 100);
            outlier = draw(random, 256);
            at = static_cast<int>(random() % 16);
        };
        const auto noise = [&](int, int k) {
            next_block(k);
            return std::floor(base + range * (draw(random, 10001) / 10000 - 0.5) + 0.5);
        };
        const auto one_outlier = [&](int, int k) {
            next_block(k);
            return k == at ? outlier : base;
        };
        EXPECT_EQ(count_worse(plane_of(20000, encoding, noise), plane_of(20000, encoding, noise), encoding).worse, 0);
        EXPECT_EQ(
            count_worse(plane_of(5000, encoding, one_outlier), plane_of(5000, encoding, one_outlier), encoding).worse,
            0);
    }
}

TEST(PlainFit, IsSeldomBetterThanNormalOnOtherValues) {
    for (const Encoding encoding : kInBlocks) {
        std::mt19937 random(7);
        double base = 0, range = 0;
        const auto noise = [&](int, int k) {
            if (k == 0) base = draw(random, 256), range = std::exp2(draw(random, 800) / 100);
            return base + range * (draw(random, 10001) / 10000 - 0.5);
        };
        const Count count = count_worse(plane_of(20000, encoding, noise), plane_of(20000, encoding, noise), encoding);
        EXPECT_LT(1000 * count.worse, count.channels);
    }
}

TEST(PlainFit, IsNeverBetterThanNormalOnRealMapsOf8Bits) {
    TEX_NEEDS_SHARED_DATA();
    Count sum;
    for (const tex::reference::RealMap& real : tex::reference::real_maps()) {
        if (!real.path.starts_with("normal/") && !real.path.starts_with("pairs/")) continue;
        if (real.path.ends_with(".exr")) continue;
        const auto image = tex::read_image((tex::shared_data() / real.path).string());
        ASSERT_TRUE(image) << image.error().message();
        tex::Plane<float> planes[2] = {tex::Plane<float>(image->extent()), tex::Plane<float>(image->extent())};
        for (std::size_t c = 0; c < 2; ++c) {
            for (int j = 0; j < image->extent().height; ++j) {
                for (int i = 0; i < image->extent().width; ++i)
                    planes[c].at(i, j) = 2.0f * image->planes[c].at(i, j) - 1.0f;
            }
        }
        for (const Encoding encoding : {Encoding::dxt5nm, Encoding::bc5}) {
            SCOPED_TRACE(real.path);
            const Count count = count_worse(planes[0], planes[1], encoding);
            EXPECT_EQ(count.worse, 0);
            sum.channels += count.channels;
        }
    }
    EXPECT_GT(sum.channels, 500'000);
}

// All pairs of endpoints are tried, on values that are not whole codes.
TEST(PlainFit, BestIsWithinItsRoundingOfTheLeastErrorOfAllBlocks) {
    for (const Encoding encoding : {Encoding::dxt5nm, Encoding::bc5_snorm}) {
        std::mt19937 random(3);
        double base = 0, range = 0;
        const auto noise = [&](int, int k) {
            if (k == 0) base = draw(random, 256), range = std::exp2(draw(random, 600) / 100 - 2);
            return base + range * (draw(random, 10001) / 10000 - 0.5);
        };
        const tex::Plane<float> x = plane_of(24, encoding, noise);
        const tex::Plane<float> y = plane_of(24, encoding, noise);
        for_channels(x, y, encoding, Effort::best, 1 << 20, [](const Channel& channel) {
            const double least = tex::reference::least_error(channel.values, channel.palette);
            EXPECT_LE(std::sqrt(channel.error() / 16), std::sqrt(least / 16) + 1.0 / 900);
            EXPECT_GE(channel.error(), least - 1e-9);
        });
    }
}

}  // namespace
