// SPDX-License-Identifier: Apache-2.0
// Rate-distortion optimisation: the promise, and the size after zstd. Angles are computed here from decoded blocks, in
// double. rdo_bytes_test.cpp compares instruction sets.

#include "rows/rdo_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "rows/zstd_size.h"
#include "unit/packing.h"
#include "unit/rdo_maps.h"
#include "unit/streams.h"
#include "unit/textures.h"

namespace tex {
namespace {

constexpr Encoding kEncodings[] = {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm, Encoding::eac_rg11,
                                   Encoding::eac_rg11_snorm};

// The library computes in float. Close to the rim, z magnifies the difference.
constexpr double kMeanRounding = 2e-3;  // of the mean, if all texels are at the rim

// The angles of all texels of the first level.
std::vector<double> angles_of(const NormalMap& map, const std::vector<std::byte>& blocks, const PackOptions& options) {
    const Extent extent = map.extent();
    const int across = (extent.width + 3) / 4;
    const double sign = options.y_axis == YAxis::down ? -1.0 : 1.0;
    std::vector<double> angles;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            float x[16], y[16];
            packing::decode_codes(blocks.data() + 16 * (j / 4 * across + i / 4), options.encoding, x, y);
            const int k = j % 4 * 4 + i % 4;
            const double n[2] = {double{map.x.at(i, j)}, sign * double{map.y.at(i, j)}};
            const double m[2] = {double{x[k]} / 127.5 - 1.0, double{y[k]} / 127.5 - 1.0};
            angles.push_back(angle_between(n, m));
        }
    }
    return angles;
}

TEST(Rdo, KeepsThePromiseForEveryEncodingAndReportsIt) {
    const Extent extent{37, 22};  // blocks that lie partly outside
    NormalMap maps[] = {packing::bumpy(extent, 5), noise(extent), spikes(extent), rim(extent)};
    for (NormalMap& map : maps) {
        const double rounding = &map == &maps[3] ? kMeanRounding : 1e-4;
        const MipChain chain = packing::chain_of(std::move(map));
        for (const Encoding encoding : kEncodings) {
            for (const YAxis y : {YAxis::up, YAxis::down}) {
                PackOptions options{encoding, y};
                const std::vector<double> plain =
                    angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
                options.rdo = {0.5f, 4.0f, 1024};
                const Result<PackedTexture> texture = pack(chain, options, {1, {}});
                ASSERT_TRUE(texture);
                const std::vector<double> angles = angles_of(chain.levels[0], texture->levels[0].bytes, options);
                expect_promise(texture->rdo, plain, angles, rounding);
            }
        }
    }
}

// Measured as compare-normals does: by reading the packed texture again.
TEST(Rdo, SteepNormalsKeepThePromiseAfterReading) {
    TEX_NEEDS_SHARED_DATA();
    const auto source = read_normals((shared_data() / "trial3/steep64.dds").string(), {}, true);
    ASSERT_TRUE(source);
    for (const Encoding encoding : kEncodings) {
        PackOptions options{encoding};
        RdoReport report;
        const auto measured = [&] {
            const Result<PackedTexture> texture = pack(source->chain, options, {1, {}});
            report = texture->rdo;
            return compare(source->chain.levels[0], unpack(*texture)->levels[0]).value();
        };
        const Comparison plain = measured();
        options.rdo = {0.5f, 1.9f, 65536};
        const Comparison small = measured();
        EXPECT_NEAR(report.plain_mean, plain.error.mean, kMeanRounding) << static_cast<int>(encoding);
        EXPECT_NEAR(report.mean, small.error.mean, kMeanRounding) << static_cast<int>(encoding);
        for (int j = 0; j < source->chain.levels[0].extent().height; ++j) {
            for (int i = 0; i < source->chain.levels[0].extent().width; ++i) {
                const float most = std::max(1.9f, plain.degrees.at(i, j));
                EXPECT_LE(small.degrees.at(i, j), most + 1e-3f) << i << " " << j;
            }
        }
    }
}

// The usual limit is four times the mean that is allowed, and 180 is none.
TEST(Rdo, SmoothMapsStaySmoothUnlessThereIsNoLimit) {
    const MipChain chain = packing::chain_of(packing::bumpy({64, 64}, 40));
    PackOptions options{Encoding::bc5};
    const std::vector<double> plain = angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
    const auto most_of = [&](float max) {
        options.rdo = {static_cast<float>(0.5 * mean_of(plain)), max, 4096};
        return pack(chain, options, {1, {}})->rdo.most_raised;
    };
    const double usual = 4.0 * 1.5 * mean_of(plain);
    EXPECT_LE(most_of(0.0f), usual + 1e-6);
    EXPECT_GT(most_of(0.0f), 0.5 * usual);
    EXPECT_GT(most_of(180.0f), usual);
}

// Slopes that change slowly, on which a raking light shows every step.
NormalMap smooth(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double u = 0.35 * std::sin(0.05 * i + 0.02 * j);
            const double v = 0.35 * std::cos(0.04 * j - 0.01 * i);
            const double length = std::sqrt(u * u + v * v + 1.0);
            map.x.at(i, j) = static_cast<float>(u / length);
            map.y.at(i, j) = static_cast<float>(v / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

double p999_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() * 999 / 1000];
}

// 0.999 of the texels stay within the promise for single texels, which for a smooth map is a fraction of a degree.
TEST(Rdo, SmoothSlopesGetNoVisibleSteps) {
    const MipChain chain = packing::chain_of(smooth({96, 64}));
    PackOptions options{Encoding::bc5};
    const std::vector<double> plain = angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
    for (const double growth : {0.1, 0.3}) {
        options.rdo.mean = static_cast<float>(growth * mean_of(plain));
        const std::vector<double> angles = angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
        EXPECT_LE(p999_of(angles), kRdoMaxOfMean * (1.0 + growth) * mean_of(plain) + 1e-3);
        EXPECT_LE(p999_of(angles), 1.75 * p999_of(plain)) << growth << " " << p999_of(angles);
        EXPECT_LE(p999_of(angles), 0.75) << growth;
    }
}

TEST(Rdo, FilesAreSmallerAfterZstd) {
    for (const Encoding encoding : kEncodings) {
        const MipChain chain = packing::chain_of(packing::bumpy({64, 64}, 5));
        PackOptions options{encoding};
        const auto size = [&] {
            WriteOptions write;
            write.zstd = 19;
            const Result<PackedTexture> texture = pack(chain, options);
            const auto bytes = encode_file(*texture, Container::ktx2, write);
            return bytes->size();
        };
        const std::vector<double> plain = angles_of(chain.levels[0], packing::pack_bytes(chain, options), options);
        const std::size_t whole = size();
        options.rdo.mean = static_cast<float>(0.3 * mean_of(plain));
        EXPECT_LT(size(), whole * 9 / 10) << static_cast<int>(encoding);
    }
}

// Ripples of water: the angles are small, so that few copies are allowed, and they save less than they cost.
TEST(Rdo, FilesNeverGrow) {
    TEX_NEEDS_SHARED_DATA();
    const auto texture = read_texture(shared_data() / "normal/water1_256.tga");
    ASSERT_TRUE(texture);
    const auto chain = unpack(*texture);
    ASSERT_TRUE(chain);
    PackOptions options{Encoding::bc5, YAxis::up, Effort::fast};
    const auto blocks = packing::pack_bytes(*chain, options);
    options.rdo.mean = static_cast<float>(0.3 * mean_of(angles_of(chain->levels[0], blocks, options)));
    EXPECT_LE(zstd_size(packing::pack_bytes(*chain, options)), zstd_size(blocks));
}

TEST(Rdo, ChangesNothingUnlessItIsAskedFor) {
    const MipChain chain = packing::chain_of(packing::bumpy({64, 64}, 5));
    PackOptions options{Encoding::bc5};
    const std::vector<std::byte> plain = packing::pack_bytes(chain, options);
    options.rdo = {0.0f, 1.0f, 64};
    EXPECT_EQ(packing::pack_bytes(chain, options), plain);
    EXPECT_EQ(pack(chain, options, {1, {}})->rdo.plain_mean, 0.0);
    options = {Encoding::rgb8};
    const std::vector<std::byte> colors = packing::pack_bytes(chain, options);
    options.rdo.mean = 1.0f;
    EXPECT_EQ(packing::pack_bytes(chain, options), colors);
}

TEST(Rdo, BandsDependOnTheWidthOfTheBaseLevelAlone) {
    PackOptions options{Encoding::bc5};
    EXPECT_EQ(rdo_band_rows(options, 4096), 4);
    options.rdo.mean = 0.1f;
    EXPECT_EQ(rdo_band_rows(options, 4096), 64);
    EXPECT_EQ(rdo_band_rows(options, 512), 512);
    EXPECT_EQ(rdo_band_rows(options, 500), 1024);
    EXPECT_EQ(rdo_band_rows(options, 1), 65536);
    EXPECT_EQ(rdo_band_rows(options, 65536), 64) << "not lower: each square has a budget";
    options.encoding = Encoding::astc_6x6;
    EXPECT_EQ(rdo_band_rows(options, 512), 6 * 256);
    options.encoding = Encoding::rgb8;
    EXPECT_EQ(rdo_band_rows(options, 512), 4);
}

class RdoStream : public StreamTest {};

// Two bands in the base level, of which the second one is small, and a smaller level.
TEST_F(RdoStream, ThreeThreadsStreamWhatOneWritesInMemory) {
    MipOptions mip;
    mip.levels = 2;
    const Result<MipChain> chain = build_mip_chain(spikes({512, 516}), mip);
    ASSERT_TRUE(chain);
    const Result<PackedTexture> floats = pack(*chain, {Encoding::float_});
    ASSERT_TRUE(floats);
    ASSERT_TRUE(write_texture(path("in.ktx2"), *floats));
    PackFileOptions options;
    options.pack = [](const SourceInfo& info) {
        PackOptions with{Encoding::bc5, info.y_axis, Effort::fast};
        with.rdo = {0.2f, 180.0f, 64};
        return with;
    };
    const Result<Source> source = read_normals(path("in.ktx2"));
    ASSERT_TRUE(source);
    const Result<PackedTexture> texture = pack(source->chain, options.pack(source->info), {1, {}});
    ASSERT_TRUE(texture);
    const RdoReport& report = texture->rdo;
    const auto wanted = encode_file(*texture, Container::dds);
    ASSERT_TRUE(wanted);
    const auto packed = pack_file(path("in.ktx2"), path("out.dds"), Container::dds, options, {3, {}});
    ASSERT_TRUE(packed);
    std::ifstream file(path("out.dds"), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    ASSERT_EQ(bytes.size(), wanted->size());
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), wanted->begin(),
                           [](char a, std::byte b) { return static_cast<std::byte>(a) == b; }));
    ASSERT_TRUE(packed->rdo);
    EXPECT_EQ(packed->rdo->mean, report.mean);
    EXPECT_EQ(packed->rdo->most_growth, report.most_growth);
}

}  // namespace
}  // namespace tex
