// SPDX-License-Identifier: Apache-2.0

#include <tex/mip.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/mip.h"
#include "unit/chains.h"
#include "unit/fields.h"
#include "unit/normal_maps.h"

namespace {

using tex::Extent;
using tex::Fade;
using tex::kDomains;
using tex::kWraps;
using tex::MipChain;
using tex::MipDomain;
using tex::MipFilter;
using tex::MipOptions;
using tex::NormalMap;
using tex::Wrap;
using tex::fields::noise;
using tex::fields::noise_normals;
using tex::fields::same_bytes;
constexpr Extent kExtents[] = {{1, 1}, {1, 300}, {300, 1}, {5, 7}, {253, 253}, {1025, 1025}};

double length_at(const NormalMap& map, int i, int j) {
    return std::sqrt(static_cast<double>(map.x.at(i, j)) * static_cast<double>(map.x.at(i, j)) +
                     static_cast<double>(map.y.at(i, j)) * static_cast<double>(map.y.at(i, j)) +
                     static_cast<double>(map.z.at(i, j)) * static_cast<double>(map.z.at(i, j)));
}

double tilt_in_degrees(const NormalMap& map, int i, int j) {
    return std::atan2(std::hypot(static_cast<double>(map.x.at(i, j)), static_cast<double>(map.y.at(i, j))),
                      static_cast<double>(map.z.at(i, j))) *
           180.0 / 3.14159265358979323846;
}

// -- levels ------------------------------------------------------------------------------------------------

TEST(Mip, LevelsHaveTheSizesOfTheGraphicsInterfaces) {
    for (const Extent extent : kExtents) {
        const MipChain chain = chain_of(noise_normals(extent));
        ASSERT_EQ(static_cast<int>(chain.levels.size()), tex::level_count(extent));
        for (std::size_t k = 0; k < chain.levels.size(); ++k) {
            const Extent level = chain.levels[k].extent();
            EXPECT_EQ(level.width, std::max(1, extent.width >> k));
            EXPECT_EQ(level.height, std::max(1, extent.height >> k));
        }
    }
}

TEST(Mip, EveryTexelOfEveryLevelHasUnitLengthAndLooksOutwards) {
    for (const Extent extent : kExtents) {
        for (const auto& filter : tex::kMipFilterNames) {
            for (const MipDomain domain : kDomains) {
                const MipChain chain = chain_of(noise_normals(extent), options_of(filter.value, domain, Wrap::repeat));
                for (const NormalMap& level : chain.levels) {
                    for (int j = 0; j < level.extent().height; ++j) {
                        for (int i = 0; i < level.extent().width; ++i) {
                            ASSERT_NEAR(length_at(level, i, j), 1.0, 3e-7);
                            ASSERT_GE(level.z.at(i, j), 0.0f);
                        }
                    }
                }
            }
        }
    }
}

TEST(Mip, ALargeMapHasAllItsLevelsAtUnitLength) {
    const MipChain chain = chain_of(noise_normals({4096, 4096}), MipOptions{});
    ASSERT_EQ(chain.levels.size(), 13u);
    for (std::size_t k = 1; k < chain.levels.size(); ++k) {
        const NormalMap& level = chain.levels[k];
        ASSERT_EQ(level.extent(), (Extent{4096 >> k, 4096 >> k}));
        for (int j = 0; j < level.extent().height; ++j) {
            for (int i = 0; i < level.extent().width; ++i) ASSERT_NEAR(length_at(level, i, j), 1.0, 3e-7);
        }
    }
}

TEST(Mip, AsManyLevelsAsWantedAndNoMoreThanThereAre) {
    const NormalMap base = noise_normals({16, 4});
    MipOptions options;
    for (const auto& [wanted, got] :
         std::vector<std::pair<int, std::size_t>>{{0, 5}, {1, 1}, {3, 3}, {5, 5}, {6, 5}, {99, 5}}) {
        options.levels = wanted;
        EXPECT_EQ(chain_of(base, options).levels.size(), got);
    }
    // A chain with fewer levels consists of the first levels of the complete chain.
    options.levels = 3;
    EXPECT_TRUE(same_bytes(chain_of(base, options).levels[2], chain_of(base).levels[2]));
}

// Levels and fading count from the first level that is kept.
TEST(Mip, LargeLevelsAreLeftOut) {
    const NormalMap base = noise_normals({70, 33});
    const MipChain whole = chain_of(base);
    MipOptions options;
    for (const auto& [most, first] : std::vector<std::pair<int, std::size_t>>{
             {0, 0}, {200, 0}, {70, 0}, {69, 1}, {35, 1}, {34, 2}, {4, 4}, {2, 5}, {1, 6}}) {
        options.max_side = most;
        const MipChain chain = chain_of(base, options);
        ASSERT_EQ(chain.levels.size(), whole.levels.size() - first) << most;
        EXPECT_TRUE(same_bytes(chain.levels.front(), whole.levels[first])) << most;
        EXPECT_TRUE(same_bytes(chain.levels.back(), whole.levels.back())) << most;
    }
    options.max_side = 35;
    options.levels = 2;
    EXPECT_EQ(chain_of(base, options).levels.size(), 2u);
    options.fade = tex::Fade{0, 1};
    const MipChain faded = chain_of(base, options);
    EXPECT_TRUE(same_bytes(faded.levels[0], whole.levels[1]));
    EXPECT_EQ(faded.levels[1].z.at(3, 3), 1.0f);
}

TEST(Mip, TheBaseLevelIsStoredAsGiven) {
    const NormalMap base = noise_normals({33, 20});
    for (const MipDomain domain : kDomains) {
        MipOptions options = options_of(MipFilter::kaiser, domain, Wrap::clamp);
        options.fade = Fade{0, 3};
        EXPECT_TRUE(same_bytes(chain_of(base, options).levels[0], base));
    }
}

// -- averages ----------------------------------------------------------------------------------------------

TEST(Mip, AConstantVectorStays) {
    for (const Extent extent : {Extent{64, 64}, Extent{253, 100}, Extent{5, 7}}) {
        for (const auto& filter : tex::kMipFilterNames) {
            for (const MipDomain domain : kDomains) {
                for (const Wrap wrap : kWraps) {
                    const MipChain chain =
                        chain_of(tex::uniform_map(extent, 0.36f, -0.48f, 0.8f), options_of(filter.value, domain, wrap));
                    const NormalMap& last = chain.levels.back();
                    EXPECT_NEAR(last.x.at(0, 0), 0.36f, 1e-6f);
                    EXPECT_NEAR(last.y.at(0, 0), -0.48f, 1e-6f);
                    EXPECT_NEAR(last.z.at(0, 0), 0.8f, 1e-6f);
                }
            }
        }
    }
}

TEST(Mip, HalfFlatAndHalfSteepDiffersByDomain) {
    // tan 53.13 degrees = 4/3. The mean of this vector and a flat one leans by half the angle, 26.57 degrees. The mean
    // slope is 2/3, 33.69 degrees, which is the slope of the averaged heights.
    NormalMap base = tex::uniform_map({2, 1}, 0.0f, 0.0f, 1.0f);
    base.x.at(0, 0) = 0.8f;
    base.z.at(0, 0) = 0.6f;
    EXPECT_NEAR(
        tilt_in_degrees(chain_of(base, options_of(MipFilter::box, MipDomain::vector, Wrap::repeat)).levels[1], 0, 0),
        26.5651, 1e-4);
    EXPECT_NEAR(
        tilt_in_degrees(chain_of(base, options_of(MipFilter::box, MipDomain::slope, Wrap::repeat)).levels[1], 0, 0),
        33.6901, 1e-4);
}

TEST(Mip, EveryLevelIsTheAverageOfTheBaseNotOfNormalisedLevels) {
    // Two opposite steep vectors cancel to a short one. It must have less weight than the two vectors that agree.
    NormalMap base = tex::uniform_map({4, 1}, 0.0f, 0.0f, 1.0f);
    base.x.at(0, 0) = 0.96f;
    base.z.at(0, 0) = 0.28f;
    base.x.at(1, 0) = -0.96f;
    base.z.at(1, 0) = 0.28f;
    base.x.at(2, 0) = base.x.at(3, 0) = 0.6f;
    base.z.at(2, 0) = base.z.at(3, 0) = 0.8f;
    const MipChain chain = chain_of(base);
    // mean x = 1.2 / 4, mean z = (0.56 + 1.6) / 4
    EXPECT_NEAR(tilt_in_degrees(chain.levels[2], 0, 0), std::atan2(1.2, 2.16) * 180.0 / 3.14159265358979323846, 1e-4);
}

TEST(Mip, TheBoxIsTheExactAverageOfOddSizes) {
    // In the slope domain the averages can be computed from the stored levels. At every level, their mean by area
    // equals that of the base level.
    for (const Extent extent : {Extent{5, 7}, Extent{253, 253}, Extent{1, 300}, Extent{300, 1}, Extent{1025, 33}}) {
        const NormalMap base = noise_normals(extent);
        const MipChain chain = chain_of(base, options_of(MipFilter::box, MipDomain::slope, Wrap::repeat));
        const auto mean_slope = [](const NormalMap& map) {
            double sum = 0.0;
            for (int j = 0; j < map.extent().height; ++j) {
                for (int i = 0; i < map.extent().width; ++i) {
                    sum += static_cast<double>(map.x.at(i, j)) / static_cast<double>(map.z.at(i, j));
                }
            }
            return sum / static_cast<double>(map.extent().texels());
        };
        const double whole = mean_slope(base);
        for (const NormalMap& level : chain.levels) EXPECT_NEAR(mean_slope(level), whole, 2e-6);
    }
}

TEST(Mip, ASymmetricBumpStaysCentred) {
    for (const Extent extent : {Extent{64, 64}, Extent{65, 63}, Extent{37, 101}}) {
        NormalMap base(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const double p = (2.0 * i - (extent.width - 1)) / extent.width;
                const double q = ((extent.height - 1) - 2.0 * j) / extent.height;
                const double length = std::sqrt(p * p + q * q + 1.0);
                base.x.at(i, j) = static_cast<float>(p / length);
                base.y.at(i, j) = static_cast<float>(q / length);
                base.z.at(i, j) = static_cast<float>(1.0 / length);
            }
        }
        for (const auto& filter : tex::kMipFilterNames) {
            for (const Wrap wrap : kWraps) {
                for (const NormalMap& level :
                     chain_of(base, options_of(filter.value, MipDomain::vector, wrap)).levels) {
                    const auto [width, height] = level.extent();
                    for (int j = 0; j < height; ++j) {
                        for (int i = 0; i < width; ++i) {
                            ASSERT_NEAR(level.x.at(i, j), -level.x.at(width - 1 - i, j), 2e-6f);
                            ASSERT_NEAR(level.y.at(i, j), -level.y.at(i, height - 1 - j), 2e-6f);
                        }
                    }
                }
            }
        }
    }
}

TEST(Mip, ABumpStaysWhereItIs) {
    // The centre of mass of a round bump, weighted by the squares of its slopes. A drift of half a texel in the step to
    // a level would move it by half a texel of that level.
    for (const Extent extent : {Extent{256, 192}, Extent{253, 187}, Extent{131, 255}}) {
        const double u = 0.37 * extent.width, v = 0.58 * extent.height, sigma = 14.0;
        NormalMap base(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const double x = i + 0.5 - u, y = v - j - 0.5;
                const double rise = 12.0 * std::exp(-(x * x + y * y) / (2.0 * sigma * sigma)) / (sigma * sigma);
                const double length = std::sqrt(rise * rise * (x * x + y * y) + 1.0);
                base.x.at(i, j) = static_cast<float>(rise * x / length);
                base.y.at(i, j) = static_cast<float>(rise * y / length);
                base.z.at(i, j) = static_cast<float>(1.0 / length);
            }
        }
        for (const auto& filter : tex::kMipFilterNames) {
            for (const MipDomain domain : kDomains) {
                const MipChain chain = chain_of(base, options_of(filter.value, domain, Wrap::repeat));
                for (std::size_t k = 0; k < 4; ++k) {
                    const NormalMap& level = chain.levels[k];
                    const double wide = static_cast<double>(extent.width) / level.extent().width;
                    const double high = static_cast<double>(extent.height) / level.extent().height;
                    double mass = 0.0, sum_x = 0.0, sum_y = 0.0;
                    for (int j = 0; j < level.extent().height; ++j) {
                        for (int i = 0; i < level.extent().width; ++i) {
                            const double weight = std::pow(tilt_in_degrees(level, i, j), 2.0);
                            mass += weight;
                            sum_x += weight * (i + 0.5) * wide;
                            sum_y += weight * (j + 0.5) * high;
                        }
                    }
                    ASSERT_NEAR(sum_x / mass, u, 0.02 * wide) << filter.name << " level " << k;
                    ASSERT_NEAR(sum_y / mass, v, 0.02 * high) << filter.name << " level " << k;
                }
            }
        }
    }
}

TEST(Mip, VectorsThatCancelBecomeFlat) {
    NormalMap base = tex::uniform_map({2, 1}, 1.0f, 0.0f, 0.0f);
    base.x.at(1, 0) = -1.0f;
    const MipChain chain = chain_of(base);
    EXPECT_EQ(chain.levels[1].x.at(0, 0), 0.0f);
    EXPECT_EQ(chain.levels[1].y.at(0, 0), 0.0f);
    EXPECT_EQ(chain.levels[1].z.at(0, 0), 1.0f);
}

TEST(Mip, VectorsThatLookInwardsAreLaidFlat) {
    const MipChain chain = chain_of(tex::uniform_map({2, 2}, 0.6f, 0.0f, -0.8f));
    EXPECT_EQ(chain.levels[1].x.at(0, 0), 1.0f);
    EXPECT_EQ(chain.levels[1].z.at(0, 0), 0.0f);
}

// -- fading ------------------------------------------------------------------------------------------------

TEST(Mip, FadingMovesLevelsToFlat) {
    MipOptions options;
    options.fade = Fade{1, 3};
    const NormalMap base = tex::uniform_map({32, 32}, 0.8f, 0.0f, 0.6f);
    const MipChain chain = chain_of(base, options);
    EXPECT_NEAR(chain.levels[1].x.at(0, 0), 0.8f, 1e-6f);
    // Halfway in vector space: (0.4, 0, 0.8), normalised.
    EXPECT_NEAR(chain.levels[2].x.at(0, 0), 0.4f / std::sqrt(0.8f), 1e-6f);
    EXPECT_NEAR(chain.levels[2].z.at(0, 0), 0.8f / std::sqrt(0.8f), 1e-6f);
    for (std::size_t k = 3; k < chain.levels.size(); ++k) {
        EXPECT_EQ(chain.levels[k].x.at(0, 0), 0.0f);
        EXPECT_EQ(chain.levels[k].z.at(0, 0), 1.0f);
    }
}

}  // namespace
