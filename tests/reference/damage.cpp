// SPDX-License-Identifier: Apache-2.0

#include "reference/damage.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <iterator>
#include <numbers>
#include <utility>

namespace tex::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;

template <class Curve>
Codes map_codes(const Codes& codes, Curve&& curve) {
    Codes result = codes;
    for (unsigned char& value : result.values) value = rounded_code(255.0 * curve(value / 255.0));
    return result;
}

using Complex = std::complex<double>;

// The discrete Fourier transform along both axes, by its definition; sign -1 forward, +1 back (and divided by the
// count).
std::vector<Complex> transform(std::vector<Complex> data, Extent extent, double sign) {
    const auto pass = [&](int count, int lines, auto index) {
        std::vector<Complex> roots(static_cast<std::size_t>(count)), line(static_cast<std::size_t>(count));
        for (int k = 0; k < count; ++k)
            roots[static_cast<std::size_t>(k)] = std::polar(1.0, sign * 2.0 * kPi * k / count);
        std::vector<Complex> samples(static_cast<std::size_t>(count));
        for (int l = 0; l < lines; ++l) {
            for (int n = 0; n < count; ++n) samples[static_cast<std::size_t>(n)] = data[index(n, l)];
            for (int k = 0; k < count; ++k) {
                double real = 0.0, imaginary = 0.0;  // operator* would look for infinities each time
                for (int n = 0; n < count; ++n) {
                    const Complex a = samples[static_cast<std::size_t>(n)],
                                  b = roots[static_cast<std::size_t>(static_cast<long>(k) * n % count)];
                    real += a.real() * b.real() - a.imag() * b.imag();
                    imaginary += a.real() * b.imag() + a.imag() * b.real();
                }
                line[static_cast<std::size_t>(k)] = {real, imaginary};
            }
            for (int k = 0; k < count; ++k) data[index(k, l)] = line[static_cast<std::size_t>(k)];
        }
    };
    const auto at = [&](int i, int j) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
    };
    pass(extent.width, extent.height, [&](int n, int l) { return at(n, l); });
    pass(extent.height, extent.width, [&](int n, int l) { return at(l, n); });
    if (sign > 0.0) {
        for (Complex& value : data) value /= static_cast<double>(extent.texels());
    }
    return data;
}

void set_slopes(NormalMap& map, int i, int j, double p, double q) {
    const double length = std::sqrt(p * p + q * q + 1.0);
    map.x.at(i, j) = static_cast<float>(-p / length);
    map.y.at(i, j) = static_cast<float>(-q / length);
    map.z.at(i, j) = static_cast<float>(1.0 / length);
}

double slope_x(const NormalMap& map, int i, int j) { return -map.x.at(i, j) / std::max(map.z.at(i, j), 0.1f); }
double slope_y(const NormalMap& map, int i, int j) { return -map.y.at(i, j) / std::max(map.z.at(i, j), 0.1f); }

}  // namespace

Codes codes_of(const NormalMap& map) {
    Codes codes{map.extent(), 3, {}};
    codes.values.resize(static_cast<std::size_t>(map.extent().texels()) * 3);
    for (int j = 0; j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) {
            codes.at(i, j, 0) = rounded_code((map.x.at(i, j) + 1.0) / 2.0 * 255.0);
            codes.at(i, j, 1) = rounded_code((map.y.at(i, j) + 1.0) / 2.0 * 255.0);
            codes.at(i, j, 2) = rounded_code((map.z.at(i, j) + 1.0) / 2.0 * 255.0);
        }
    }
    return codes;
}

Texture texture_of(const std::vector<Codes>& levels) {
    Texture texture;
    texture.format = levels.front().channels == 3 ? Format::rgb8_unorm : Format::rgba8_unorm;
    texture.swizzle = {Component::x, Component::y, Component::z, Component::other};
    for (const Codes& codes : levels) {
        Level level{codes.extent, {}};
        level.bytes.resize(codes.values.size());
        std::memcpy(level.bytes.data(), codes.values.data(), codes.values.size());
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

Texture texture_of(const Codes& codes) { return texture_of(std::vector<Codes>{codes}); }

Codes flip_green(const Codes& codes) {
    Codes result = codes;
    for (std::size_t k = 1; k < result.values.size(); k += static_cast<std::size_t>(codes.channels)) {
        result.values[k] = static_cast<unsigned char>(255 - result.values[k]);
    }
    return result;
}

Codes exchange(const Codes& codes, int a, int b) {
    Codes result = codes;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) std::swap(result.at(i, j, a), result.at(i, j, b));
    }
    return result;
}

Codes with_palette(const Codes& codes, double apart) {
    constexpr double kMiddle = 127.5, kCos = 0.8, kSin = 0.6;
    const auto on_lattice = [apart](double c) { return apart * std::floor(c / apart + 0.5); };
    Codes result = codes;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            const double x = codes.at(i, j, 0) - kMiddle, y = codes.at(i, j, 1) - kMiddle;
            const double u = on_lattice(kCos * x + kSin * y), v = on_lattice(kCos * y - kSin * x);
            const double a = kCos * u - kSin * v, b = kSin * u + kCos * v;
            result.at(i, j, 0) = rounded_code(a + kMiddle);
            result.at(i, j, 1) = rounded_code(b + kMiddle);
            result.at(i, j, 2) = rounded_code(std::sqrt(std::max(0.0, kMiddle * kMiddle - a * a - b * b)) + kMiddle);
        }
    }
    return result;
}

Codes srgb_encode(const Codes& codes) {
    return map_codes(codes,
                     [](double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055; });
}

Codes srgb_decode(const Codes& codes) {
    return map_codes(codes, [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); });
}

Codes with_alpha(const Codes& codes, bool premultiplied) {
    Codes result{codes.extent, 4, {}};
    result.values.resize(static_cast<std::size_t>(codes.extent.texels()) * 4);
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            const double alpha = std::clamp(0.6 + 0.6 * std::sin(0.07 * i + 1.0) * std::sin(0.05 * j), 0.0, 1.0);
            result.at(i, j, 3) = rounded_code(255.0 * alpha);
            for (int c = 0; c < 3; ++c) {
                const double factor = premultiplied ? result.at(i, j, 3) / 255.0 : 1.0;
                result.at(i, j, c) = rounded_code(codes.at(i, j, c) * factor);
            }
        }
    }
    return result;
}

double Heights::range() const {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
}

Heights integrate(const NormalMap& map) {
    const Extent extent = map.extent();
    const auto count = static_cast<std::size_t>(extent.texels());
    std::vector<Complex> p(count), q(count), h(count);
    std::size_t k = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i, ++k) {
            p[k] = slope_x(map, i, j);
            q[k] = -slope_y(map, i, j);  // downwards, as rows go
        }
    }
    p = transform(std::move(p), extent, -1.0);
    q = transform(std::move(q), extent, -1.0);
    k = 0;
    for (int v = 0; v < extent.height; ++v) {
        for (int u = 0; u < extent.width; ++u, ++k) {
            // The central difference multiplies a wave by i sin(w).
            const double su = std::sin(2.0 * kPi * u / extent.width), sv = std::sin(2.0 * kPi * v / extent.height);
            const double square = su * su + sv * sv;
            h[k] = square < 1e-3 ? Complex(0.0) : Complex(0.0, -1.0) * (su * p[k] + sv * q[k]) / square;
        }
    }
    h = transform(std::move(h), extent, 1.0);
    Heights heights{extent, {}};
    for (const Complex& value : h) heights.values.push_back(value.real());
    return heights;
}

NormalMap from_heights(const Heights& heights, int levels) {
    const Extent extent = heights.extent;
    std::vector<double> h = heights.values;
    const double low = *std::min_element(h.begin(), h.end()), range = heights.range();
    if (levels > 1 && range > 0.0) {
        const double step = range / (levels - 1);
        for (double& value : h) value = std::floor((value - low) / step + 0.5) * step;
    }
    const auto at = [&](int i, int j) {
        const int x = (i + extent.width) % extent.width, y = (j + extent.height) % extent.height;
        return h[static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(x)];
    };
    NormalMap result(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            set_slopes(result, i, j, (at(i + 1, j) - at(i - 1, j)) / 2.0, (at(i, j - 1) - at(i, j + 1)) / 2.0);
        }
    }
    return result;
}

NormalMap crop(const NormalMap& map, int x, int y, Extent extent) {
    NormalMap result(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            result.x.at(i, j) = map.x.at(x + i, y + j);
            result.y.at(i, j) = map.y.at(x + i, y + j);
            result.z.at(i, j) = map.z.at(x + i, y + j);
        }
    }
    return result;
}

NormalMap turn_picture(const NormalMap& map, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    const Extent from = map.extent();
    const int side = static_cast<int>((std::min(from.width, from.height) - 2) / (std::abs(c) + std::abs(s)));
    NormalMap result(Extent{side, side});
    for (int k = 0; k < side * side; ++k) {
        // To the right of the centre, and down.
        const double x = k % side - (side - 1) / 2.0, y = k / side - (side - 1) / 2.0;
        const double column = c * x - s * y + (from.width - 1) / 2.0, row = s * x + c * y + (from.height - 1) / 2.0;
        const int i = static_cast<int>(column), j = static_cast<int>(row);
        const double u = column - i, v = row - j;
        const auto sampled = [&](const Plane<float>& plane) {
            return (plane.at(i, j) * (1.0 - u) + plane.at(i + 1, j) * u) * (1.0 - v) +
                   (plane.at(i, j + 1) * (1.0 - u) + plane.at(i + 1, j + 1) * u) * v;
        };
        const double nx = sampled(map.x), ny = sampled(map.y), nz = sampled(map.z);
        const double length = std::max(1e-9, std::sqrt(nx * nx + ny * ny + nz * nz));
        result.x.at(k % side, k / side) = static_cast<float>(nx / length);
        result.y.at(k % side, k / side) = static_cast<float>(ny / length);
        result.z.at(k % side, k / side) = static_cast<float>(nz / length);
    }
    return result;
}

std::vector<Codes> chain_of(const NormalMap& map, ChainFault fault) {
    std::vector<Codes> levels{codes_of(map)};
    NormalMap average = crop(map, 0, 0, map.extent());  // not normalised
    for (int level = 1; level < level_count(map.extent()); ++level) {
        const Extent from = average.extent(), to = level_extent(map.extent(), level);
        const int shift = fault == ChainFault::shifted ? 1 : 0;
        NormalMap next(to);
        const auto mean = [&](const Plane<float>& plane, int i, int j) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) {
                sum += plane.at((2 * i + k % 2 - shift + from.width) % from.width,
                                (2 * j + k / 2 - shift + from.height) % from.height);
            }
            return static_cast<float>(sum / 4.0);
        };
        for (int j = 0; j < to.height; ++j) {
            for (int i = 0; i < to.width; ++i) {
                next.x.at(i, j) = mean(average.x, i, j);
                next.y.at(i, j) = mean(average.y, i, j);
                next.z.at(i, j) = mean(average.z, i, j);
            }
        }
        NormalMap stored(to);
        for (int j = 0; j < to.height; ++j) {
            for (int i = 0; i < to.width; ++i) {
                const bool turned = fault == ChainFault::other_image;
                const int si = turned ? to.width - 1 - i : i, sj = turned ? to.height - 1 - j : j;
                const double x = next.x.at(si, sj), y = next.y.at(si, sj), z = next.z.at(si, sj);
                const double length =
                    fault == ChainFault::not_normalised ? 1.0 : std::max(1e-6, std::sqrt(x * x + y * y + z * z));
                stored.x.at(i, j) = static_cast<float>(x / length);
                stored.y.at(i, j) = static_cast<float>(y / length);
                stored.z.at(i, j) = static_cast<float>(z / length);
            }
        }
        levels.push_back(codes_of(stored));
        average = std::move(next);
    }
    return levels;
}

}  // namespace tex::reference
