// SPDX-License-Identifier: Apache-2.0
// The same bytes with every compiler and on every machine: hashes of results whose inputs come from integers. Other
// tests compare the numbers with tests/reference. These tests show that no compiler, C library or processor changes a
// bit. If a formula changes on purpose, its hash changes too.

#include <tex/bake.h>
#include <tex/height.h>
#include <tex/mip.h>

#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "rows/math.h"
#include "unit/fields.h"

namespace {

using tex::Wrap;
using tex::fields::hash_of;
using tex::fields::noise;

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

TEST(SameBytes, ElementaryFunctions) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (int k = 0; k < 20000; ++k) {
        const double x = noise(k, 1) * 40.0 - 20.0;
        for (const double value : {tex::math::exp(x), tex::math::log(x * x), tex::math::sin(x), tex::math::cos(x),
                                   tex::math::atan(x), tex::math::pow(x * x, 0.4), tex::math::sinc(x)}) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3u;
        }
    }
    EXPECT_EQ(hash, 0xfd790e6f84dc2ef6u);
}

TEST(SameBytes, Bake) {
    const std::uint64_t expected[] = {0xbe0826af7fcb6e59u, 0x484f04572e0106fcu, 0x315ac991e1a92e6cu,
                                      0x4fde50f77e985a19u, 0x01e0efac498d2fe2u, 0x2e6e07c80b112984u,
                                      0x3c1636efe366c018u};
    for (const auto& kernel : tex::kGradientKernelNames) {
        std::uint64_t hash = 0;
        for (const Wrap wrap : kWraps) {
            const auto field = tex::fields::field_of({61, 47}, 7.0f, wrap, [](int i, int j) { return noise(i, j); });
            hash = hash_of(tex::bake(field, {kernel.value, 1.7f}).value(), hash);
        }
        EXPECT_EQ(hash, expected[static_cast<int>(kernel.value)]) << kernel.name;
    }
}

TEST(SameBytes, Mip) {
    const std::uint64_t expected[][2] = {
        {0x7c56a6ad6b9bb7e0u, 0x3196de293e2b6107u}, {0x1b9d52b926750af8u, 0x417e8dbd66101214u},
        {0x4db607233a2768a5u, 0x7b59d9a80e65136bu}, {0xb65f53fb06a6e6eau, 0xb0eb0996759bb6d5u},
        {0xd49578c2cc2e64b2u, 0xab5892c62f7444f6u}, {0xaf7deb93e0b3e40fu, 0x6e376b2045eb42b6u}};
    for (const auto& filter : tex::kMipFilterNames) {
        for (const auto& domain : tex::kMipDomainNames) {
            std::uint64_t hash = 0;
            for (const Wrap wrap : kWraps) {
                tex::MipOptions options;
                options.filter = filter.value;
                options.domain = domain.value;
                options.wrap_x = options.wrap_y = wrap;
                options.fade = tex::Fade{0, 9};
                for (const tex::Extent extent : {tex::Extent{64, 48}, tex::Extent{61, 47}}) {
                    const auto chain = tex::build_mip_chain(tex::fields::noise_normals(extent), options).value();
                    for (const tex::NormalMap& level : chain.levels) hash = hash_of(level, hash);
                }
            }
            EXPECT_EQ(hash, expected[static_cast<int>(filter.value)][static_cast<int>(domain.value)])
                << filter.name << " " << domain.name;
        }
    }
}

TEST(SameBytes, Blur) {
    std::uint64_t hash = 0;
    for (const Wrap wrap : kWraps) {
        tex::Image image;
        for (unsigned k = 0; k < 3; ++k) {
            image.planes.push_back(tex::fields::plane_of({61, 47}, [&](int i, int j) { return noise(i, j, k); }));
        }
        image.names = {"R", "G", "B"};
        tex::HeightOptions options;
        options.blur_sigma = 2.3f;
        options.wrap_x = options.wrap_y = wrap;
        hash = hash_of(tex::height_field(image, options).value().height, hash);
    }
    EXPECT_EQ(hash, 0x3954f531bd260f60u);
}

}  // namespace
