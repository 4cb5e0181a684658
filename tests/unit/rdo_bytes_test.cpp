// SPDX-License-Identifier: Apache-2.0
// Rate-distortion optimisation: the same bytes with every instruction set, compiler and machine. The picture is small
// because emulated processors run this file. rdo_test.cpp tests everything else.

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "unit/packing.h"
#include "unit/targets.h"

namespace tex {
namespace {

struct Expected {
    Encoding encoding;
    std::uint64_t hash;
};

// The sources are rounded to codes, so that no C library's sine can change them. A formula that changes on purpose
// changes these hashes too.
constexpr Expected kExpected[] = {
    {Encoding::dxt5nm, 0xf28f829dad9fadc2u},         {Encoding::bc5, 0x1dcaebd907439a6fu},
    {Encoding::bc5_snorm, 0x2ee90aff61fdb2f5u},      {Encoding::eac_rg11, 0x31ca4401b5a74cb6u},
    {Encoding::eac_rg11_snorm, 0x2f76bd9419b50ab7u}, {Encoding::astc_4x4, 0x1b552871cffe222eu},
    {Encoding::astc_6x6, 0x77f656e77007186bu},       {Encoding::bc7, 0x4acf621ae537993au},
    {Encoding::uastc, 0x70dfec0070338b5au},          {Encoding::uastc_rrrg, 0xae9bfa54c63b965cu},
    {Encoding::bc7_rxgb, 0x5a7c2fc0c8376208u}};

NormalMap rounded(NormalMap map) {
    for (Plane<float>* plane : {&map.x, &map.y}) {
        for (int j = 0; j < map.extent().height; ++j) {
            for (int i = 0; i < map.extent().width; ++i) plane->at(i, j) = std::round(60.0f * plane->at(i, j)) / 60.0f;
        }
    }
    return map;
}

std::uint64_t hash_of(const std::vector<std::byte>& bytes) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
}

TEST(RdoBytes, SameBytesOnEveryTarget) {
    const MipChain chain = packing::chain_of(rounded(packing::bumpy({48, 24}, 8)));
    for (const Expected& expected : kExpected) {
        PackOptions options{expected.encoding};
        const std::vector<std::byte> plain = packing::pack_bytes(chain, options);
        options.rdo = {0.3f, 5.0f, 1024};
        on_every_target([&] {
            const std::vector<std::byte> bytes = packing::pack_bytes(chain, options);
            EXPECT_NE(bytes, plain);
            EXPECT_EQ(hash_of(bytes), expected.hash) << "0x" << std::hex << hash_of(bytes);
        });
    }
}

}  // namespace
}  // namespace tex
