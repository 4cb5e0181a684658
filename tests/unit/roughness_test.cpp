// SPDX-License-Identifier: Apache-2.0

#include <tex/mip.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/pack.h>

#include "reference/roughness.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using tex::Extent;
using tex::Format;
using tex::MipOptions;
using tex::NormalMap;
using tex::Plane;
using tex::RoughnessChain;
using tex::RoughnessModel;
using tex::Wrap;
using tex::fields::noise_normals;
using tex::fields::same_bytes;

constexpr RoughnessModel kModels[] = {RoughnessModel::toksvig, RoughnessModel::vmf};

RoughnessChain chain_of(const NormalMap& base, const Plane<float>& roughness, RoughnessModel model,
                        const MipOptions& options = {}, int threads = 1) {
    return std::move(tex::build_roughness_chain(base, roughness, model, options, {threads, {}}).value());
}

RoughnessChain chain_of(const NormalMap& base, float roughness, RoughnessModel model) {
    return chain_of(base, Plane<float>(base.extent(), roughness), model);
}

Plane<float> noise_roughness(Extent extent) {
    return tex::fields::plane_of(extent, [](int i, int j) { return tex::fields::noise(i, j, 7); });
}

NormalMap normals_of(Extent extent, const std::function<tex::reference::Vector()>& next) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const tex::reference::Vector v = next();
            map.x.at(i, j) = static_cast<float>(v.x);
            map.y.at(i, j) = static_cast<float>(v.y);
            map.z.at(i, j) = static_cast<float>(v.z);
        }
    }
    return map;
}

double alpha2_of(const RoughnessChain& chain) {
    return std::pow(static_cast<double>(chain.levels.back().at(0, 0)), 4.0);
}

// Reproducible with every standard library: the results of mt19937 are standardised, those of the distributions are
// not.
class Random {
public:
    double uniform() { return (static_cast<double>(engine_()) + 0.5) / 4294967296.0; }
    double gaussian() { return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform()); }

private:
    std::mt19937 engine_{20051};
};

// -- what the numbers mean ---------------------------------------------------------------------------------

TEST(Roughness, VonMisesFisherSamplesGiveBackTheirConcentration) {
    for (const double kappa : {3.0, 10.0, 50.0, 400.0}) {
        Random random;
        const NormalMap map = normals_of({256, 256}, [&] {
            const double u = random.uniform(), turn = 2.0 * std::numbers::pi * random.uniform();
            const double z = 1.0 + std::log(u + (1.0 - u) * std::exp(-2.0 * kappa)) / kappa;  // Ulrich 1984
            const double side = std::sqrt(std::max(0.0, 1.0 - z * z));
            return tex::reference::Vector{side * std::cos(turn), side * std::sin(turn), z};
        });
        EXPECT_NEAR(alpha2_of(chain_of(map, 0.0f, RoughnessModel::vmf)) * 2.0 * kappa, 1.0, 0.05) << kappa;
        const double own = std::pow(0.4, 4.0);
        EXPECT_NEAR((alpha2_of(chain_of(map, 0.4f, RoughnessModel::vmf)) - own) * 2.0 * kappa, 1.0, 0.05) << kappa;
    }
}

TEST(Roughness, ToksvigTurnsAMirrorOfRandomSlopesIntoTheirBeckmannDistribution) {
    // Beckmann: slopes are Gaussian, with the variance alpha^2 / 2 on each axis.
    for (const double alpha : {0.03, 0.06, 0.1}) {
        Random random;
        const NormalMap map = normals_of({256, 256}, [&] {
            return tex::reference::normalised(
                {alpha * std::sqrt(0.5) * random.gaussian(), alpha * std::sqrt(0.5) * random.gaussian(), 1.0});
        });
        const RoughnessChain chain = chain_of(map, 0.0f, RoughnessModel::toksvig);
        EXPECT_NEAR(std::sqrt(alpha2_of(chain)) / alpha, 1.0, 0.02) << alpha;
        // On a rough surface the two variances add up.
        const double rough = alpha2_of(chain_of(map, 0.3f, RoughnessModel::toksvig));
        EXPECT_NEAR(rough / (std::pow(0.3, 4.0) + alpha * alpha), 1.0, 0.06) << alpha;
        // The header's statement about the other model: a quarter.
        EXPECT_NEAR(alpha2_of(chain_of(map, 0.0f, RoughnessModel::vmf)) / alpha2_of(chain), 0.25, 0.01) << alpha;
    }
}

TEST(Roughness, VectorsThatAgreeKeepTheRoughness) {
    for (const RoughnessModel model : kModels) {
        for (const Extent extent : {Extent{64, 64}, Extent{53, 7}}) {
            const NormalMap tilted = normals_of(extent, [] { return tex::reference::Vector{0.36, -0.48, 0.8}; });
            for (const Plane<float>& level : chain_of(tilted, 0.0f, model).levels) EXPECT_EQ(level.at(0, 0), 0.0f);
            for (const Plane<float>& level : chain_of(tilted, 0.5f, model).levels)
                EXPECT_NEAR(level.at(0, 0), 0.5f, 1e-6f);
        }
    }
}

TEST(Roughness, SquaresOfAlphaAreAveraged) {
    const NormalMap flat = normals_of({2, 1}, [] { return tex::reference::Vector{0.0, 0.0, 1.0}; });
    Plane<float> roughness(Extent{2, 1}, 0.0f);
    roughness.at(1, 0) = 1.0f;
    for (const RoughnessModel model : kModels)
        EXPECT_NEAR(chain_of(flat, roughness, model).levels[1].at(0, 0), std::pow(0.5, 0.25), 1e-6);
}

TEST(Roughness, NothingIsRougherThanVectorsThatCancel) {
    NormalMap opposite(Extent{2, 1});
    for (int i = 0; i < 2; ++i) {
        opposite.x.at(i, 0) = i == 0 ? 1.0f : -1.0f;
        opposite.y.at(i, 0) = opposite.z.at(i, 0) = 0.0f;
    }
    for (const RoughnessModel model : kModels) {
        for (const float roughness : {0.0f, 0.5f, 1.0f})
            EXPECT_NEAR(chain_of(opposite, roughness, model).levels[1].at(0, 0), 1.0f, 1e-6f);
    }
}

TEST(Roughness, TheBaseLevelIsWhatWasGivenCutToItsRange) {
    const NormalMap base = noise_normals({4, 1});
    Plane<float> roughness(Extent{4, 1}, 0.25f);
    roughness.at(1, 0) = -3.0f;
    roughness.at(2, 0) = 7.0f;
    roughness.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
    tex::on_every_target([&] {
        const RoughnessChain chain = chain_of(base, roughness, RoughnessModel::vmf);
        EXPECT_EQ(chain.levels[0].at(0, 0), 0.25f);
        EXPECT_EQ(chain.levels[0].at(1, 0), 0.0f);
        EXPECT_EQ(chain.levels[0].at(2, 0), 1.0f);
        EXPECT_EQ(chain.levels[0].at(3, 0), 0.0f);
        EXPECT_TRUE(chain.levels[2].at(0, 0) > 0.0f);
    });
}

TEST(Roughness, MapsOfOtherExtentsAreStretched) {
    const NormalMap base = noise_normals({24, 20});
    for (const Extent extent : {Extent{1, 1}, Extent{12, 10}, Extent{31, 9}, Extent{48, 40}, Extent{99, 101}}) {
        const RoughnessChain even = chain_of(base, Plane<float>(extent, 0.4f), RoughnessModel::vmf);
        const RoughnessChain same = chain_of(base, 0.4f, RoughnessModel::vmf);
        for (std::size_t k = 0; k < same.levels.size(); ++k) {
            ASSERT_EQ(even.levels[k].extent(), same.levels[k].extent());
            EXPECT_NEAR(even.levels[k].at(0, 0), same.levels[k].at(0, 0), 1e-6);
        }
    }
    // From a map twice as large, alpha^2 is averaged. From a map half as large, it is interpolated between texels.
    const auto alpha2 = [](double roughness) { return std::pow(roughness, 4.0); };
    const Plane<float> large = noise_roughness({48, 40}), small = noise_roughness({12, 10});
    const Plane<float> from_large = chain_of(base, large, RoughnessModel::vmf).levels[0].clone();
    const Plane<float> from_small = chain_of(base, small, RoughnessModel::vmf).levels[0].clone();
    double mean = 0.0, between = 0.0;
    for (int k = 0; k < 4; ++k) {
        mean += alpha2(large.at(6 + k % 2, 8 + k / 2)) / 4.0;
        between += alpha2(small.at(3 + k % 2, 4 + k / 2)) * (k % 2 == 0 ? 0.75 : 0.25) * (k / 2 == 0 ? 0.75 : 0.25);
    }
    EXPECT_NEAR(alpha2(from_large.at(3, 4)), mean, 1e-5);
    EXPECT_NEAR(alpha2(from_small.at(7, 9)), between, 1e-5);
}

TEST(Roughness, NeitherDomainNorFadeMatters) {
    const NormalMap base = noise_normals({31, 16});
    const Plane<float> roughness = noise_roughness({31, 16});
    MipOptions other;
    other.domain = tex::MipDomain::slope;
    other.fade = tex::Fade{0, 2};
    const RoughnessChain a = chain_of(base, roughness, RoughnessModel::vmf);
    const RoughnessChain b = chain_of(base, roughness, RoughnessModel::vmf, other);
    for (std::size_t k = 0; k < a.levels.size(); ++k) EXPECT_TRUE(same_bytes(a.levels[k], b.levels[k]));
}

// -- against the reference ---------------------------------------------------------------------------------

TEST(Roughness, AgreesWithTheReferenceForEveryModelFilterWrapAndSize) {
    for (const Extent extent :
         {Extent{1, 1}, Extent{2, 2}, Extent{3, 5}, Extent{17, 33}, Extent{1, 30}, Extent{40, 20}}) {
        const NormalMap base = noise_normals(extent);
        const Plane<float> roughness = noise_roughness(extent);
        for (const RoughnessModel model : kModels) {
            for (const auto& filter : tex::kMipFilterNames) {
                for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
                    MipOptions options;
                    options.filter = filter.value;
                    options.wrap_x = wrap;
                    const RoughnessChain chain = chain_of(base, roughness, model, options);
                    const auto truth = tex::reference::build_roughness_chain(
                        tex::reference::grid_of(base), tex::reference::grid_of(roughness), model, options);
                    ASSERT_EQ(chain.levels.size(), truth.size());
                    for (std::size_t k = 0; k < truth.size(); ++k) {
                        const Extent level = chain.levels[k].extent();
                        ASSERT_EQ(level, truth[k].extent);
                        for (int j = 0; j < level.height; ++j) {
                            for (int i = 0; i < level.width; ++i)
                                ASSERT_NEAR(chain.levels[k].at(i, j), truth[k].at(i, j), 1e-5) << filter.name << k;
                        }
                    }
                }
            }
        }
    }
}

TEST(Roughness, AsManyLevelsAsTheNormalsHave) {
    MipOptions options;
    options.levels = 3;
    EXPECT_EQ(chain_of(noise_normals({16, 4}), noise_roughness({16, 4}), RoughnessModel::vmf, options).levels.size(),
              3u);
}

// -- the same bytes, progress ------------------------------------------------------------------------------

TEST(Roughness, GivesTheSameBytesOnEveryTargetAndForEveryNumberOfThreads) {
    for (const Extent extent : {Extent{512, 300}, Extent{53, 123}}) {
        const NormalMap base = noise_normals(extent);
        const Plane<float> roughness = noise_roughness(extent);
        for (const RoughnessModel model : kModels) {
            std::optional<RoughnessChain> first;
            tex::on_every_target([&] {
                for (const int threads : {1, 3}) {
                    RoughnessChain chain = chain_of(base, roughness, model, {}, threads);
                    if (!first)
                        first = std::move(chain);
                    else
                        for (std::size_t k = 0; k < chain.levels.size(); ++k)
                            EXPECT_TRUE(same_bytes(first->levels[k], chain.levels[k])) << k;
                }
            });
        }
    }
}

TEST(Roughness, ReportsProgressAndCanBeCancelled) {
    const NormalMap base = noise_normals({300, 301});
    const Plane<float> roughness = noise_roughness({300, 301});
    std::vector<double> seen = {0.0};
    const auto chain = tex::build_roughness_chain(base, roughness, RoughnessModel::vmf, {}, {1, [&](double done) {
                                                                                                 seen.push_back(done);
                                                                                                 return true;
                                                                                             }});
    ASSERT_TRUE(chain);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1.0);
    const auto none =
        tex::build_roughness_chain(base, roughness, RoughnessModel::vmf, {}, {1, [](double) { return false; }});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, tex::ErrorCode::cancelled);
}

// -- packing -----------------------------------------------------------------------------------------------

TEST(Roughness, PacksIntoEveryFormatOfOneChannel) {
    RoughnessChain chain;
    chain.levels.push_back(noise_roughness({13, 6}));
    chain.levels.push_back(noise_roughness({6, 3}));
    const std::pair<Format, double> bounds[] = {
        {Format::r8_unorm, 0.5 / 255 + 1e-7}, {Format::r16_unorm, 0.5 / 65535 + 1e-7},
        {Format::r16_float, 1.0 / 4096},      {Format::r32_float, 0.0},
        {Format::astc_4x4_unorm, 1.0 / 40},   {Format::uastc_4x4_unorm, 1.0 / 29},  // noise from 0 to 1: fifteenths,
        {Format::bc4_unorm, 1.0 / 10}};                                             // and sevenths
    for (const auto& [format, bound] : bounds) {
        const auto texture = tex::pack_roughness(chain, format);
        ASSERT_TRUE(texture);
        EXPECT_FALSE(texture->swizzle_known);
        ASSERT_EQ(texture->levels.size(), 2u);
        for (int k = 0; k < 2; ++k) {
            const auto image = tex::decode(*texture, k);
            ASSERT_TRUE(image);
            const Plane<float>& level = chain.levels[static_cast<std::size_t>(k)];
            ASSERT_EQ(image->extent(), level.extent());
            for (int j = 0; j < level.extent().height; ++j) {
                for (int i = 0; i < level.extent().width; ++i)
                    ASSERT_NEAR(image->planes[0].at(i, j), level.at(i, j), bound) << name_of(tex::kFormatNames, format);
            }
        }
    }
    EXPECT_EQ(tex::pack_roughness(chain, Format::rg8_unorm).error().code, tex::ErrorCode::bad_option);
}

// Luminance alone leaves more bits for weights than luminance and alpha, and threads divide levels between blocks.
TEST(Roughness, AstcIsLuminanceAndBetterThanTwoChannels) {
    RoughnessChain chain;
    Plane<float>& level = chain.levels.emplace_back(Extent{301, 203});
    for (int j = 0; j < 203; ++j) {
        for (int i = 0; i < 301; ++i)
            level.at(i, j) =
                static_cast<float>(0.5 + 0.3 * std::sin(0.21 * i) * std::cos(0.17 * j) + 0.03 * std::sin(2.1 * i * j));
    }
    tex::MipChain normals;
    NormalMap& map = normals.levels.emplace_back(Extent{301, 203});
    for (int j = 0; j < 203; ++j) {
        for (int i = 0; i < 301; ++i) {
            map.x.at(i, j) = 2.0f * level.at(i, j) - 1.0f;
            map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = 1.0f;
        }
    }
    for (const auto& [format, encoding] : {std::pair{Format::astc_5x5_unorm, tex::Encoding::astc_5x5},
                                           {Format::astc_8x6_unorm, tex::Encoding::astc_8x6}}) {
        const auto texture = tex::pack_roughness(chain, format, tex::Effort::normal, {1, {}});
        const auto both = tex::pack(normals, {.encoding = encoding});
        ASSERT_TRUE(texture && both);
        EXPECT_EQ(texture->levels[0].bytes,
                  tex::pack_roughness(chain, format, tex::Effort::normal, {4, {}})->levels[0].bytes);
        const auto image = tex::decode(*texture, 0), image_of_both = tex::decode(*both, 0);
        ASSERT_TRUE(image && image_of_both);
        double error = 0, error_of_both = 0;
        for (int j = 0; j < 203; ++j) {
            for (int i = 0; i < 301; ++i) {
                const float v = image->planes[0].at(i, j);
                EXPECT_EQ(image->planes[2].at(i, j), v);
                EXPECT_EQ(image->planes[3].at(i, j), 1.0f);
                error += std::pow(v - level.at(i, j), 2);
                error_of_both += std::pow(image_of_both->planes[0].at(i, j) - level.at(i, j), 2);
            }
        }
        EXPECT_LT(error, error_of_both);
    }
}

TEST(Roughness, LargeLevelsAreLeftOut) {
    const NormalMap base = noise_normals({40, 24});
    const Plane<float> own = noise_roughness({40, 24});
    const RoughnessChain whole = chain_of(base, own, RoughnessModel::vmf);
    MipOptions options;
    options.max_side = 20;
    options.levels = 3;
    const RoughnessChain some = chain_of(base, own, RoughnessModel::vmf, options);
    ASSERT_EQ(some.levels.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        for (int j = 0; j < some.levels[k].extent().height; ++j) {
            for (int i = 0; i < some.levels[k].extent().width; ++i)
                ASSERT_EQ(some.levels[k].at(i, j), whole.levels[k + 1].at(i, j)) << k;
        }
    }
}

}  // namespace
