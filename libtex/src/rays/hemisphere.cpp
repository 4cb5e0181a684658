// SPDX-License-Identifier: Apache-2.0

#include "rays/hemisphere.h"

#include <cmath>
#include <cstddef>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr double kUnit = 0x1p-32;

std::uint32_t reversed(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00U) >> 8) | ((x & 0x00ff00ffU) << 8);
    x = ((x & 0xf0f0f0f0U) >> 4) | ((x & 0x0f0f0f0fU) << 4);
    x = ((x & 0xccccccccU) >> 2) | ((x & 0x33333333U) << 2);
    return ((x & 0xaaaaaaaaU) >> 1) | ((x & 0x55555555U) << 1);
}

// Each bit changes by a hash of the bits below it alone. (Burley 2020, with the constants of Laine and Karras.)
std::uint32_t permuted(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    return x ^ (x * 0x8d22f6e6U);
}

// MurmurHash3's finish (Appleby 2011).
std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x85ebca6bU;
    x = (x ^ (x >> 13)) * 0xc2b2ae35U;
    return x ^ (x >> 16);
}

// The second coordinate of Sobol's sequence, whose matrix is Pascal's triangle modulo 2.
std::uint32_t sobol_second(std::uint32_t k) {
    std::uint32_t sum = 0;
    for (std::uint32_t column = 0x80000000U; k != 0; k >>= 1, column ^= column >> 1) {
        if ((k & 1) != 0) sum ^= column;
    }
    return sum;
}

}  // namespace

Hemisphere::Hemisphere(int count) {
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k)
        points_.push_back({k, reversed(sobol_second(k))});
    for (int k = 0; k < 256; ++k) {
        const double coarse = math::kPi * k / 128.0, fine = math::kPi * (k + 0.5) / 32768.0;
        coarse_[k] = {math::cos(coarse), math::sin(coarse)};
        fine_[k] = {math::cos(fine), math::sin(fine)};
    }
}

std::uint32_t Hemisphere::seed_of(int i, int j, std::uint32_t place) {
    const std::uint32_t row = mixed(static_cast<std::uint32_t>(j) + 0x9e3779b9U);
    return mixed(mixed(static_cast<std::uint32_t>(i) ^ row) + 0x9e3779b9U * place);
}

// The basis is that of Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6 (1), 2017.
void Hemisphere::about(Vector3 axis, Vector3 face, std::uint32_t seed, Vector3* directions) const {
    const double sign = axis.z < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + axis.z), b = axis.x * axis.y * a;
    const Vector3 x{1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    const Vector3 y{b, sign + axis.y * axis.y * a, -axis.y};
    const std::uint32_t other = mixed(seed + 0x632be5abU);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const double u = (reversed(permuted(points_[k].u, seed)) + 0.5) * kUnit;
        const std::uint32_t v = reversed(permuted(points_[k].v, other));
        const Turn &coarse = coarse_[v >> 24], &fine = fine_[(v >> 16) & 0xff];
        const double r = std::sqrt(u);
        const double right = r * (coarse.cos * fine.cos - coarse.sin * fine.sin),
                     up = r * (coarse.sin * fine.cos + coarse.cos * fine.sin);
        Vector3 d = right * x + up * y + std::sqrt(1.0 - u) * axis;
        const double below = dot(d, face);
        if (below < 0.0) d = d - 2.0 * below * face;
        directions[k] = d;
    }
}

}  // namespace tex::inline v1
