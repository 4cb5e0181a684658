// SPDX-License-Identifier: Apache-2.0
// Rate-distortion optimisation of BC7 and UASTC: the promise, of directions, and the size after zstd.
// rdo_bytes_test.cpp compares instruction sets.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "blocks/bc7.h"
#include "blocks/block_entries.h"
#include "blocks/uastc.h"
#include "kernels/entry_search.h"
#include "rows/zstd_size.h"
#include "unit/packing.h"
#include "unit/rdo_maps.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr Encoding kRgbEncodings[] = {Encoding::bc7, Encoding::uastc, Encoding::uastc_rrrg, Encoding::bc7_rxgb};

bool is_bc7(Encoding encoding) { return encoding == Encoding::bc7 || encoding == Encoding::bc7_rxgb; }

void decode_either(Encoding encoding, const std::byte* block, std::uint8_t rgba[16][4]) {
    if (is_bc7(encoding)) return decode_bc7(block, rgba);
    std::uint8_t channels[4][16];
    decode_uastc(block, channels);
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 4; ++c) rgba[k][c] = channels[c][k];
    }
}

BlockEntries entries_of(Encoding encoding, const std::byte* block) {
    return is_bc7(encoding) ? read_bc7_entries(block) : read_uastc_entries(block);
}

// What texels have by their numbers.
std::vector<std::uint8_t> picked(const BlockEntries& entries, const std::uint8_t numbers[16]) {
    std::vector<std::uint8_t> codes;
    for (int k = 0; k < 16; ++k) {
        const std::uint8_t* const code = entries.code[entries.subset[k] * entries.count + numbers[k]];
        codes.insert(codes.end(), code, code + 4);
    }
    return codes;
}

std::vector<std::uint8_t> decoded(Encoding encoding, const std::byte* block) {
    std::uint8_t rgba[16][4];
    decode_either(encoding, block, rgba);
    return {rgba[0], rgba[0] + 64};
}

// Random blocks of all modes: the entries are those of the decoder, and blocks with other numbers decode to these.
TEST(RdoRgb, EntriesAreWhatDecodersMake) {
    std::mt19937 random(7);
    for (const Encoding encoding : kRgbEncodings) {
        for (int n = 0; n < 4000; ++n) {
            std::byte block[16], other[16];
            for (std::byte& byte : block) byte = static_cast<std::byte>(random() % 256);
            if (is_bc7(encoding)) block[0] = static_cast<std::byte>(1u << n % 8 | (random() << (n % 8 + 1)));
            const BlockEntries entries = entries_of(encoding, block);
            ASSERT_LE(entries.total(), BlockEntries::kMost);
            std::uint8_t numbers[16];
            read_entry_numbers(entries, block, numbers);
            ASSERT_EQ(picked(entries, numbers), decoded(encoding, block)) << n;
            for (unsigned k = 0; k < 16; ++k) {
                do {
                    numbers[k] = static_cast<std::uint8_t>(random() % static_cast<unsigned>(entries.count));
                } while ((entries.anchors >> k & 1u) != 0 && entries.is_high(numbers[k]));
            }
            write_entry_numbers(entries, block, numbers, other);
            EXPECT_EQ(std::memcmp(block, other, static_cast<std::size_t>(entries.front_bytes())), 0);
            ASSERT_EQ(picked(entries, numbers), decoded(encoding, other)) << n;
        }
    }
}

// Beside plain loops in double.
TEST(RdoRgb, ClosestEntriesAreFound) {
    std::mt19937 random(11);
    const auto number = [&] { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; };
    float texels[4][16], entries[4][32], distances[2][16] = {};
    for (auto& row : texels) std::generate(row, row + 16, number);
    for (auto& row : entries) std::generate(row, row + 32, number);
    unsigned char rows[32];
    for (int e = 0; e < 32; ++e) rows[e] = static_cast<unsigned char>(e % 3 == 0 ? 1 : 0);
    for (int k = 0; k < 16; k += 5) distances[1][k] = kNoEntry;
    on_every_target([&] {
        float squares[16], found[16];
        closest_entries({texels, entries, 29, rows, distances}, squares, found);
        for (int k = 0; k < 16; ++k) {
            double least = 1e30;
            int closest = -1;
            for (int e = 0; e < 29; ++e) {
                if (rows[e] == 1 && k % 5 == 0) continue;
                double square = 0.0;
                for (int c = 0; c < 4; ++c) square += std::pow(double{texels[c][k]} - double{entries[c][e]}, 2.0);
                if (square >= least) continue;
                least = square;
                closest = e;
            }
            EXPECT_EQ(static_cast<int>(found[k]), closest) << k;
            EXPECT_NEAR(squares[k], least, 1e-5);
        }
    });
}

// The vector that codes stand for.
void set_decoded(Encoding encoding, const std::uint8_t code[4], double m[3]) {
    const auto component = [&](int c) { return 2.0 * code[c] / 255.0 - 1.0; };
    for (int c = 0; c < 3; ++c) m[c] = component(c);
    if (encoding == Encoding::bc7_rxgb) m[0] = component(3);
    if (encoding != Encoding::uastc_rrrg) return;
    m[1] = component(3);
    m[2] = std::sqrt(std::max(0.0, 1.0 - m[0] * m[0] - m[1] * m[1]));
}

// The angles of all texels of the first level, in double.
std::vector<double> rgb_angles_of(const NormalMap& map, const std::vector<std::byte>& blocks,
                                  const PackOptions& options) {
    const Extent extent = map.extent();
    const int across = (extent.width + 3) / 4;
    const double sign = options.y_axis == YAxis::down ? -1.0 : 1.0;
    std::vector<double> angles;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            std::uint8_t rgba[16][4];
            decode_either(options.encoding, blocks.data() + 16 * (j / 4 * across + i / 4), rgba);
            const std::uint8_t* const code = rgba[j % 4 * 4 + i % 4];
            double n[3] = {map.x.at(i, j), sign * double{map.y.at(i, j)}, map.z.at(i, j)};
            if (options.encoding == Encoding::uastc_rrrg)
                n[2] = std::sqrt(std::max(0.0, 1.0 - n[0] * n[0] - n[1] * n[1]));
            double m[3], inner = 0.0, squares[2] = {};
            set_decoded(options.encoding, code, m);
            for (int c = 0; c < 3; ++c) {
                squares[0] += n[c] * n[c];
                squares[1] += m[c] * m[c];
            }
            for (int c = 0; c < 3; ++c)
                inner += std::pow(n[c] / std::sqrt(squares[0]) - m[c] / std::sqrt(squares[1]), 2.0);
            angles.push_back(2.0 * std::asin(std::min(1.0, std::sqrt(inner) / 2.0)) * 180.0 / 3.14159265358979323846);
        }
    }
    return angles;
}

TEST(RdoRgb, KeepsThePromiseAndReportsIt) {
    NormalMap maps[] = {packing::bumpy({37, 22}, 5), noise({37, 22}), spikes({37, 22}), rim({37, 22})};
    for (NormalMap& map : maps) {
        const MipChain chain = packing::chain_of(std::move(map));
        for (const Encoding encoding : kRgbEncodings) {
            PackOptions options{encoding, encoding == Encoding::uastc ? YAxis::down : YAxis::up, Effort::fast};
            const std::vector<double> plain =
                rgb_angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
            // At the rim, z of x and y hangs on their last bits.
            const double rounding = encoding == Encoding::uastc_rrrg ? 1e-3 : 1e-4;
            options.rdo = {0.5f, 4.0f, 1024};
            const Result<PackedTexture> texture = pack(chain, options, {1, {}});
            ASSERT_TRUE(texture);
            expect_promise(texture->rdo, plain, rgb_angles_of(chain.levels[0], texture->levels[0].bytes, options),
                           rounding);
        }
    }
}

TEST(RdoRgb, BlocksAreSmallerAfterZstd) {
    const MipChain chain = packing::chain_of(packing::bumpy({96, 96}, 5));
    for (const Encoding encoding : kRgbEncodings) {
        PackOptions options{encoding, YAxis::up, Effort::fast};
        const std::vector<std::byte> plain = packing::pack_bytes(chain, options);
        options.rdo.mean = static_cast<float>(0.1 * mean_of(rgb_angles_of(chain.levels[0], plain, options)));
        EXPECT_LT(zstd_size(packing::pack_bytes(chain, options)), zstd_size(plain) * 95 / 100)
            << static_cast<int>(encoding);
    }
}

// A code of alpha counts as one of x: what is copied does not change it much more than normals change.
TEST(RdoRgb, AlphaIsKeptAsNormalsAre) {
    NormalMap map = packing::bumpy({64, 64}, 5);
    map.alpha = Plane<float>({64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i)
            map.alpha.at(i, j) = 0.5f + 0.4f * std::sin(0.11f * static_cast<float>(i + j)) * (i < 32 ? 1.0f : 0.2f);
    }
    const MipChain chain = packing::chain_of(std::move(map));
    const auto worst_alpha = [&](const std::vector<std::byte>& blocks) {
        double most = 0.0;
        for (int j = 0; j < 64; ++j) {
            for (int i = 0; i < 64; ++i) {
                std::uint8_t rgba[16][4];
                decode_bc7(blocks.data() + 16 * (j / 4 * 16 + i / 4), rgba);
                const double code = rgba[j % 4 * 4 + i % 4][3];
                most = std::max(most, std::abs(code - 255.0 * double{chain.levels[0].alpha.at(i, j)}));
            }
        }
        return most;
    };
    PackOptions options{Encoding::bc7, YAxis::up, Effort::fast};
    const std::vector<std::byte> plain = packing::pack_bytes(chain, options);
    options.rdo = {0.5f, 4.0f, 65536};
    const std::vector<std::byte> small = packing::pack_bytes(chain, options);
    EXPECT_LT(zstd_size(small), zstd_size(plain));
    // A chord of 4 degrees is 0.0698, twice alpha.
    EXPECT_LE(worst_alpha(small), std::max(worst_alpha(plain), 255.0 * 0.0698 / 2.0 + 0.01));
}

}  // namespace
}  // namespace tex
