// SPDX-License-Identifier: Apache-2.0
// fields.h: height fields and normal maps made from formulas, for the tests of kernels.

#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>

#include <tex/height.h>
#include <tex/types.h>

namespace tex::fields {

inline Plane<float> plane_of(Extent extent, const std::function<double(int i, int j)>& value) {
    Plane<float> plane(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) plane.at(i, j) = static_cast<float>(value(i, j));
    }
    return plane;
}

inline HeightField field_of(Extent extent, float bumpiness, Wrap wrap,
                            const std::function<double(int i, int j)>& height) {
    return {plane_of(extent, height), bumpiness, bumpiness, wrap, wrap};
}

// A reproducible value in [0, 1) for a texel, the same in every standard library.
inline double noise(int i, int j, unsigned seed = 0) {
    unsigned x = static_cast<unsigned>(i) * 0x8da6b343u ^ static_cast<unsigned>(j) * 0xd8163841u ^ seed * 0xcb1ab31fu;
    x = (x ^ (x >> 15)) * 0x2c1b3c6du;
    x = (x ^ (x >> 12)) * 0x297a2d39u;
    return static_cast<double>((x ^ (x >> 15)) >> 8) / 16777216.0;
}

// Unit vectors with z > 0 in all directions.
inline NormalMap noise_normals(Extent extent, unsigned seed = 0) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = 4.0 * noise(i, j, seed) - 2.0;
            const double y = 4.0 * noise(i, j, seed + 1) - 2.0;
            const double length = std::sqrt(x * x + y * y + 1.0);
            map.x.at(i, j) = static_cast<float>(x / length);
            map.y.at(i, j) = static_cast<float>(y / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

// True if the texels of two planes (not their padding) have the same bytes.
inline bool same_bytes(const Plane<float>& a, const Plane<float>& b) {
    if (a.extent() != b.extent()) return false;
    for (int j = 0; j < a.extent().height; ++j) {
        if (std::memcmp(a.row(j), b.row(j), static_cast<std::size_t>(a.extent().width) * sizeof(float)) != 0)
            return false;
    }
    return true;
}

inline bool same_bytes(const NormalMap& a, const NormalMap& b) {
    return same_bytes(a.x, b.x) && same_bytes(a.y, b.y) && same_bytes(a.z, b.z);
}

// A number that changes with any bit of the texels (FNV-1a), for results that must be the same with every compiler.
inline std::uint64_t hash_of(const Plane<float>& plane, std::uint64_t hash = 0xcbf29ce484222325u) {
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(plane.at(i, j))) * 0x100000001b3u;
        }
    }
    return hash;
}

inline std::uint64_t hash_of(const NormalMap& map, std::uint64_t hash = 0xcbf29ce484222325u) {
    return hash_of(map.z, hash_of(map.y, hash_of(map.x, hash)));
}

inline std::uint64_t hash_of(const MipChain& chain) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const NormalMap& level : chain.levels) hash = hash_of(level, hash);
    return hash;
}

}  // namespace tex::fields
