// SPDX-License-Identifier: Apache-2.0
// Rate-distortion optimisation of ASTC: the promise, as libastcenc decodes the blocks, and the size after zstd.
// rdo_bytes_test.cpp compares instruction sets.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "blocks/astc_decode.h"
#include "blocks/astc_plan.h"
#include "blocks/astc_weights.h"
#include "blocks/extent.h"
#include "kernels/astc_copies.h"
#include "rows/zstd_size.h"
#include "unit/astcenc.h"
#include "unit/packing.h"
#include "unit/rdo_maps.h"

namespace tex {
namespace {

constexpr Encoding kAstcEncodings[] = {Encoding::astc_4x4, Encoding::astc_6x5, Encoding::astc_8x8};

Extent block_of(Encoding encoding) { return format_info(encoding_info(encoding).format).block; }

// The angles of all texels of the first level.
std::vector<double> astc_angles_of(const NormalMap& map, const std::vector<std::byte>& blocks,
                                   const PackOptions& options) {
    const Extent extent = map.extent(), block = block_of(options.encoding);
    const Extent whole{whole_blocks(extent.width, block.width), whole_blocks(extent.height, block.height)};
    const std::vector<float> rgba = Astcenc(block).decode(blocks.data(), blocks.size(), whole);
    const double sign = options.y_axis == YAxis::down ? -1.0 : 1.0;
    std::vector<double> angles;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float* const texel = rgba.data() + 4 * static_cast<std::size_t>(j * whole.width + i);
            const double n[2] = {double{map.x.at(i, j)}, sign * double{map.y.at(i, j)}};
            const double m[2] = {2.0 * double{texel[0]} - 1.0, 2.0 * double{texel[3]} - 1.0};
            angles.push_back(angle_between(n, m));
        }
    }
    return angles;
}

TEST(RdoAstc, KeepsThePromiseAndReportsIt) {
    NormalMap maps[] = {packing::bumpy({37, 22}, 5), noise({37, 22}), spikes({37, 22}), rim({37, 22})};
    for (NormalMap& map : maps) {
        const double rounding = &map == &maps[3] ? 2e-3 : 1e-4;  // of means; z magnifies close to the rim
        const MipChain chain = packing::chain_of(std::move(map));
        for (const Encoding encoding : kAstcEncodings) {
            PackOptions options{encoding, encoding == Encoding::astc_6x5 ? YAxis::down : YAxis::up, Effort::fast};
            const std::vector<double> plain =
                astc_angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
            options.rdo = {0.5f, 4.0f, 1024};
            const Result<PackedTexture> texture = pack(chain, options, {1, {}});
            ASSERT_TRUE(texture);
            const std::vector<double> angles = astc_angles_of(chain.levels[0], texture->levels[0].bytes, options);
            expect_promise(texture->rdo, plain, angles, rounding);
        }
    }
}

TEST(RdoAstc, BlocksAreSmallerAfterZstd) {
    const MipChain chain = packing::chain_of(packing::bumpy({96, 96}, 5));
    for (const Encoding encoding : kAstcEncodings) {
        PackOptions options{encoding, YAxis::up, Effort::fast};
        const std::vector<std::byte> plain = packing::pack_bytes(chain, options);
        options.rdo.mean = static_cast<float>(0.3 * mean_of(astc_angles_of(chain.levels[0], plain, options)));
        EXPECT_LT(zstd_size(packing::pack_bytes(chain, options)), zstd_size(plain) * 9 / 10)
            << static_cast<int>(encoding);
    }
}

// With its own endpoints, a block gets weights that are about as good as those that it had.
TEST(RdoAstc, WeightsSuitEndpointsThatAreGiven) {
    const NormalMap map = packing::bumpy({48, 48}, 3);
    for (const Encoding encoding : kAstcEncodings) {
        const Extent block = block_of(encoding);
        const int texels = block.width * block.height, across = blocks_across(48, block.width);
        const std::vector<std::byte> blocks =
            packing::pack_bytes(packing::chain_of(packing::bumpy({48, 48}, 3)), {encoding});
        double before = 0.0, after = 0.0;
        Astcenc astcenc(block);
        for (int n = 0; n < static_cast<int>(blocks.size()) / kAstcBlockBytes; ++n) {
            const std::byte* const from = blocks.data() + std::ptrdiff_t{kAstcBlockBytes} * n;
            const std::optional<AstcLines> lines = read_astc_lines(block, from);
            if (!lines) continue;
            float codes[2][kAstcMostPlanned];
            for (int k = 0; k < texels; ++k) {
                const int i = std::min(47, n % across * block.width + k % block.width);
                const int j = std::min(47, n / across * block.height + k / block.width);
                codes[0][k] = 127.5f * (map.x.at(i, j) + 1.0f);
                codes[1][k] = 127.5f * (map.y.at(i, j) + 1.0f);
            }
            const auto& grids = astc_plans(block).grids;
            const auto grid = std::find_if(grids.begin(), grids.end(),
                                           [&](const auto& made) { return made->extent == lines->mode.grid; });
            ASSERT_NE(grid, grids.end());
            std::byte made[kAstcBlockBytes];
            write_astc_weights(**grid, *lines, codes[0], codes[1], from, made);
            const int same = (128 - lines->mode.weight_bits()) / 8;
            EXPECT_TRUE(std::equal(from, from + same, made));
            const auto error = [&](const std::byte* bytes) {
                const std::vector<float> rgba = astcenc.decode(bytes, kAstcBlockBytes, block);
                double sum = 0.0;
                for (std::size_t k = 0; k < static_cast<std::size_t>(texels); ++k) {
                    const double x = 255.0 * double{rgba[4 * k]} - double{codes[0][k]};
                    const double y = 255.0 * double{rgba[4 * k + 3]} - double{codes[1][k]};
                    sum += x * x + y * y;
                }
                return sum;
            };
            before += error(from);
            after += error(made);
        }
        EXPECT_LT(after, 1.05 * before) << static_cast<int>(encoding);
    }
}

// The mean square of how far numbers between off - reach and off + reach are outside [-half, half].
double square_outside(double off, double reach, double half) {
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
        const double at = off + reach * ((2.0 * k + 1.0) / kSteps - 1.0);
        const double outside = std::max(0.0, std::abs(at) - half);
        sum += outside * outside / kSteps;
    }
    return sum;
}

// Beside formulas in double, and an integral.
TEST(RdoAstc, CostsAreThoseOfTheFormulas) {
    constexpr int kCount = 37;
    constexpr float kScale = 30.0f, kLiteral = 0.7f;
    std::mt19937 random(9);
    const auto number = [&] { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; };
    std::vector<float> columns[kAstcCoarse + 8], prices;
    for (std::vector<float>& column : columns) {
        for (int k = 0; k < kCount + 32; ++k) column.push_back(number());
    }
    for (int k = 0; k < kCount + 32; ++k) {
        const double angle = 3.0 * static_cast<double>(number());
        columns[6][static_cast<std::size_t>(k)] = static_cast<float>(std::cos(angle));
        columns[7][static_cast<std::size_t>(k)] = static_cast<float>(std::sin(angle));
        for (std::size_t c = 10; c < 14; ++c)
            columns[c][static_cast<std::size_t>(k)] = std::fabs(columns[c][static_cast<std::size_t>(k)]);
        prices.push_back(number() + 1.0f);
    }
    AstcCopyTable table{};
    for (std::size_t c = 0; c < kAstcCoarse; ++c) table.coarse[c] = columns[c].data();
    table.cos = columns[6].data();
    table.sin = columns[7].data();
    for (std::size_t a = 0; a < 2; ++a) {
        table.middle[a] = columns[8 + a].data();
        table.half[a] = columns[10 + a].data();
    }
    table.noise = columns[12].data();
    table.literals = columns[13].data();
    const AstcCopyTexels block{16.0f, {0.3f, -0.2f}, 2.0f, -0.7f, 1.0f, {0.1f, 0.2f, -0.4f, 0.5f, -0.1f, 0.0f}};
    std::vector<float> wholes(kCount + 32), fronts(kCount + 32);
    astc_copy_costs(table, block, prices.data(), kScale, kLiteral, kCount, wholes.data(), fronts.data());
    for (std::size_t k = 0; k < kCount; ++k) {
        double square = 0.0;
        for (std::size_t c = 0; c < kAstcCoarse; ++c)
            square += std::pow(double{columns[c][k]} - double{block.coarse[c]}, 2.0);
        EXPECT_NEAR(wholes[k], 30.0 * std::sqrt(square) + double{prices[k]}, 1e-3);
        const double axes[2][2] = {{columns[6][k], columns[7][k]}, {-columns[7][k], columns[6][k]}};
        double error = columns[12][k];
        for (std::size_t a = 0; a < 2; ++a) {
            const double u = axes[a][0], v = axes[a][1];
            const double variance = (2.0 * u * u - 2.0 * 0.7 * u * v + v * v) / 16.0;
            const double off = 0.3 * u - 0.2 * v - double{columns[8 + a][k]};
            error += 16.0 * square_outside(off, std::sqrt(3.0 * variance), double{columns[10 + a][k]});
        }
        EXPECT_NEAR(fronts[k], 30.0 * std::sqrt(error) + double{prices[k]} + 0.7 * double{columns[13][k]}, 1e-3);
    }
}

}  // namespace
}  // namespace tex
