// SPDX-License-Identifier: Apache-2.0
// damage_codecs.cpp: what JPEG and BC1 do to codes, by their definitions.

#include "reference/damage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <vector>

namespace tex::reference {
namespace {

// The 8x8 cosine transform of T.81 A.3.3, forward (in place of samples) and back.
void cosine_transform(double (&block)[8][8], bool back) {
    static const auto basis = [] {
        std::vector<double> table(64);
        for (int u = 0; u < 8; ++u) {
            for (int x = 0; x < 8; ++x) {
                table[static_cast<std::size_t>(u * 8 + x)] =
                    (u == 0 ? std::sqrt(0.125) : 0.5) * std::cos((2 * x + 1) * u * std::numbers::pi / 16.0);
            }
        }
        return table;
    }();
    double half[8][8] = {};
    for (int j = 0; j < 8; ++j) {
        for (int u = 0; u < 8; ++u) {
            for (int x = 0; x < 8; ++x)
                half[j][u] += block[j][x] * basis[static_cast<std::size_t>(back ? x * 8 + u : u * 8 + x)];
        }
    }
    for (int v = 0; v < 8; ++v) {
        for (int u = 0; u < 8; ++u) {
            block[v][u] = 0.0;
            for (int y = 0; y < 8; ++y)
                block[v][u] += half[y][u] * basis[static_cast<std::size_t>(back ? y * 8 + v : v * 8 + y)];
        }
    }
}

constexpr int kLuminance[64] = {16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
                                14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
                                18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
                                49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
constexpr int kChrominance[64] = {17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,
                                  24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,
                                  99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
                                  99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};

// Quantises a plane of samples (0 to 255) in place, block by block; blocks over the border repeat the last sample.
void quantise(std::vector<double>& plane, Extent extent, const int (&table)[64], int quality) {
    const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
    const auto at = [&](int i, int j) -> double& {
        return plane[static_cast<std::size_t>(std::min(j, extent.height - 1)) * static_cast<std::size_t>(extent.width) +
                     static_cast<std::size_t>(std::min(i, extent.width - 1))];
    };
    for (int y = 0; y < extent.height; y += 8) {
        for (int x = 0; x < extent.width; x += 8) {
            double block[8][8];
            for (int j = 0; j < 8; ++j) {
                for (int i = 0; i < 8; ++i) block[j][i] = at(x + i, y + j) - 128.0;
            }
            cosine_transform(block, false);
            for (int k = 0; k < 64; ++k) {
                const double step = std::clamp((table[k] * scale + 50) / 100, 1, 255);
                block[k / 8][k % 8] = std::floor(block[k / 8][k % 8] / step + 0.5) * step;
            }
            cosine_transform(block, true);
            for (int j = 0; j < 8 && y + j < extent.height; ++j) {
                for (int i = 0; i < 8 && x + i < extent.width; ++i)
                    at(x + i, y + j) = std::clamp(block[j][i] + 128.0, 0.0, 255.0);
            }
        }
    }
}

}  // namespace

Codes jpeg(const Codes& codes, int quality) {
    const Extent full = codes.extent;
    const Extent half{(full.width + 1) / 2, (full.height + 1) / 2};
    std::vector<double> luma, blue(static_cast<std::size_t>(half.texels())), red(blue.size()), weight(blue.size());
    for (int j = 0; j < full.height; ++j) {
        for (int i = 0; i < full.width; ++i) {
            const double r = codes.at(i, j, 0), g = codes.at(i, j, 1), b = codes.at(i, j, 2);
            luma.push_back(0.299 * r + 0.587 * g + 0.114 * b);
            const auto k = static_cast<std::size_t>(j / 2) * static_cast<std::size_t>(half.width) +
                           static_cast<std::size_t>(i / 2);
            blue[k] += 128.0 - 0.168736 * r - 0.331264 * g + 0.5 * b;
            red[k] += 128.0 + 0.5 * r - 0.418688 * g - 0.081312 * b;
            weight[k] += 1.0;
        }
    }
    for (std::size_t k = 0; k < blue.size(); ++k) {
        blue[k] /= weight[k];
        red[k] /= weight[k];
    }
    quantise(luma, full, kLuminance, quality);
    quantise(blue, half, kChrominance, quality);
    quantise(red, half, kChrominance, quality);
    Codes result = codes;
    for (int j = 0; j < full.height; ++j) {
        for (int i = 0; i < full.width; ++i) {
            const double y =
                luma[static_cast<std::size_t>(j) * static_cast<std::size_t>(full.width) + static_cast<std::size_t>(i)];
            const auto k = static_cast<std::size_t>(j / 2) * static_cast<std::size_t>(half.width) +
                           static_cast<std::size_t>(i / 2);
            const double cb = blue[k] - 128.0, cr = red[k] - 128.0;
            result.at(i, j, 0) = rounded_code(y + 1.402 * cr);
            result.at(i, j, 1) = rounded_code(y - 0.344136 * cb - 0.714136 * cr);
            result.at(i, j, 2) = rounded_code(y + 1.772 * cb);
        }
    }
    return result;
}

Codes bc1(const Codes& codes) {
    Codes result = codes;
    for (int y = 0; y < codes.extent.height; y += 4) {
        for (int x = 0; x < codes.extent.width; x += 4) {
            const int right = std::min(x + 4, codes.extent.width), bottom = std::min(y + 4, codes.extent.height);
            double low[3] = {255.0, 255.0, 255.0}, high[3] = {};
            for (int j = y; j < bottom; ++j) {
                for (int i = x; i < right; ++i) {
                    for (int c = 0; c < 3; ++c)
                        low[c] = std::min<double>(low[c], codes.at(i, j, c)),
                        high[c] = std::max<double>(high[c], codes.at(i, j, c));
                }
            }
            double palette[4][3];
            for (int k = 0; k < 4; ++k) {
                for (int c = 0; c < 3; ++c) {
                    const double most = c == 1 ? 63.0 : 31.0;
                    const auto stored = [&](double v) { return std::floor(v / 255.0 * most + 0.5) / most * 255.0; };
                    palette[k][c] = (stored(low[c]) * (3 - k) + stored(high[c]) * k) / 3.0;
                }
            }
            for (int j = y; j < bottom; ++j) {
                for (int i = x; i < right; ++i) {
                    const auto distance = [&](const double* color) {
                        double sum = 0.0;
                        for (int c = 0; c < 3; ++c)
                            sum += (color[c] - codes.at(i, j, c)) * (color[c] - codes.at(i, j, c));
                        return sum;
                    };
                    const auto* best =
                        std::min_element(std::begin(palette), std::end(palette),
                                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
                    for (int c = 0; c < 3; ++c) result.at(i, j, c) = rounded_code((*best)[c]);
                }
            }
        }
    }
    return result;
}

}  // namespace tex::reference
