// SPDX-License-Identifier: Apache-2.0
// Compares build_mip_chain() with the double-precision reference, on every target and with every number of threads.

#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/mip.h"
#include "unit/chains.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace tex {
namespace {

using fields::noise_normals;
using fields::same_bytes;

// -- against the reference ---------------------------------------------------------------------------------

TEST(Mip, AgreesWithTheReferenceForEveryFilterDomainWrapAndSize) {
    for (const auto& filter : kMipFilterNames) {
        for (const MipDomain domain : kDomains) {
            for (const Wrap wrap : kWraps) {
                for (const Extent extent : {Extent{1, 1}, Extent{2, 2}, Extent{3, 5}, Extent{15, 16}, Extent{17, 33},
                                            Extent{1, 30}, Extent{64, 36}}) {
                    const NormalMap base = noise_normals(extent);
                    MipOptions options = options_of(filter.value, domain, wrap);
                    options.fade = Fade{2, 9};
                    const MipChain chain = chain_of(base, options);
                    const auto truth = reference::build_mip_chain(reference::grid_of(base), options);
                    ASSERT_EQ(chain.levels.size(), truth.size());
                    for (std::size_t k = 0; k < truth.size(); ++k) {
                        ASSERT_LT(largest_angle(chain.levels[k], truth[k]), 0.01)
                            << filter.name << " " << name_of(kMipDomainNames, domain) << " "
                            << name_of(kWrapNames, wrap) << " " << extent.width << "x" << extent.height << " level "
                            << k;
                    }
                }
            }
        }
    }
}

TEST(Mip, AxesMayWrapDifferently) {
    const NormalMap base = noise_normals({20, 27});
    for (const Wrap wrap_x : kWraps) {
        for (const Wrap wrap_y : kWraps) {
            MipOptions options = options_of(MipFilter::lanczos3, MipDomain::vector, wrap_x);
            options.wrap_y = wrap_y;
            const auto truth = reference::build_mip_chain(reference::grid_of(base), options);
            EXPECT_LT(largest_angle(chain_of(base, options).levels[1], truth[1]), 0.01);
        }
    }
}

// -- the same bytes ----------------------------------------------------------------------------------------

// The chain must be the same on every target and with each number of threads.
void expect_same_bytes(const NormalMap& base, const MipOptions& options, const std::vector<int>& threads) {
    std::optional<MipChain> first;
    on_every_target([&] {
        for (const int count : threads) {
            MipChain chain = chain_of(base, options, count);
            if (!first)
                first = std::move(chain);
            else
                for (std::size_t k = 0; k < chain.levels.size(); ++k) {
                    EXPECT_TRUE(same_bytes(first->levels[k], chain.levels[k]))
                        << "level " << k << ", " << count << " threads";
                }
        }
    });
}

TEST(Mip, GivesTheSameBytesOnEveryTarget) {
    for (const Extent extent : {Extent{64, 96}, Extent{53, 123}, Extent{140, 33}}) {
        for (const auto& filter : kMipFilterNames) {
            for (const MipDomain domain : kDomains) {
                MipOptions options = options_of(filter.value, domain, Wrap::mirror);
                options.fade = Fade{1, 20};
                expect_same_bytes(noise_normals(extent), options, {1});
            }
        }
    }
}

TEST(Mip, GivesTheSameBytesForEveryNumberOfThreads) {
    // Several strips of rows in the first levels.
    for (const Extent extent : {Extent{512, 512}, Extent{513, 411}}) {
        for (const MipFilter filter : {MipFilter::box, MipFilter::mitchell}) {
            for (const MipDomain domain : kDomains) {
                expect_same_bytes(noise_normals(extent), options_of(filter, domain, Wrap::repeat), {1, 2, 3, 8});
            }
        }
    }
}

TEST(Mip, ReportsProgressUpwardsThroughAllLevels) {
    std::vector<double> seen = {0.0};
    const auto chain =
        build_mip_chain(noise_normals({301, 300}), options_of(MipFilter::mitchell, MipDomain::slope, Wrap::clamp),
                        {1, [&](double fraction) {
                             seen.push_back(fraction);
                             return true;
                         }});
    ASSERT_TRUE(chain);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_GT(seen.size(), 4u);
    EXPECT_EQ(seen.back(), 1.0);
}

TEST(Mip, CanBeCancelled) {
    const auto result = build_mip_chain(noise_normals({512, 512}), {}, {1, [](double) { return false; }});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
