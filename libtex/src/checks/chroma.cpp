// SPDX-License-Identifier: Apache-2.0

#include "checks/chroma.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace tex::inline v1 {
namespace {

struct DetailSums {
    double straight = 0.0, diagonal = 0.0;
    std::int64_t with_detail = 0;
    void add(float a, float b, float c, float d) {
        constexpr float kDetail = 4.0f * 1.5f / 255.0f;
        const float horizontal = a - b + c - d, vertical = a + b - c - d, both = a - b - c + d;
        straight += static_cast<double>(horizontal * horizontal + vertical * vertical);
        diagonal += static_cast<double>(both * both);
        with_detail += std::max(std::abs(horizontal), std::abs(vertical)) >= kDetail ? 1 : 0;
    }
};

}  // namespace

// The figures are in tests/bench/VERDICTS.md. Where luma has hardly any detail, the ratios are noise.
bool ChromaDetail::is_halved() const {
    constexpr double kLeastDetail = 0.35, kLeastStraight = 1.5;
    constexpr double kMostDiagonal = 0.45, kMostStraight = 0.75;
    constexpr double kLeastShare = 0.1;  // a few texels that stand out say nothing about the others
    return share >= kLeastShare && luma_diagonal >= kLeastDetail && luma >= kLeastStraight &&
           chroma_diagonal <= kMostDiagonal * luma_diagonal && chroma <= kMostStraight * luma;
}

double ChromaDetail::lost() const { return std::sqrt(std::max(0.0, luma * luma - chroma * chroma)); }

ChromaDetail measure_chroma(const Stored& stored, const Background* background) {
    constexpr int kWindow = 128;
    constexpr float kLeastSquare = 0.1f, kMostSquare = 2.2f;  // of lengths: grey has 0, black and white 3
    const auto& planes = stored.image->planes;
    if (stored.is_signed || !stored.has_z() || planes.size() < 3) return {};
    DetailSums luma, chroma;
    std::int64_t squares = 0;
    for (const Rect& window : sample_windows(stored.extent(), kWindow)) {
        for (int j = window.y; j + 1 < window.y + window.height; j += 2) {
            const float* rows[2][3];
            for (std::size_t c = 0; c < 3; ++c) {
                rows[0][c] = planes[c].row(j);
                rows[1][c] = planes[c].row(j + 1);
            }
            const auto y = [&](int k, int i) {
                return 0.299f * rows[k][0][i] + 0.587f * rows[k][1][i] + 0.114f * rows[k][2][i];
            };
            const auto cr = [&](int k, int i) {
                return 0.5f * rows[k][0][i] - 0.4187f * rows[k][1][i] - 0.0813f * rows[k][2][i];
            };
            const auto is_vector = [&](int k, int i) {
                float square = 0.0f;
                for (const float* const row : rows[k]) square += (2.0f * row[i] - 1.0f) * (2.0f * row[i] - 1.0f);
                return square >= kLeastSquare && square <= kMostSquare;
            };
            const auto is_left_out = [&](int i) {
                if (!is_vector(0, i) || !is_vector(0, i + 1) || !is_vector(1, i) || !is_vector(1, i + 1)) return true;
                return background != nullptr && (background->holds(i, j) || background->holds(i + 1, j) ||
                                                 background->holds(i, j + 1) || background->holds(i + 1, j + 1));
            };
            for (int i = window.x; i + 1 < window.x + window.width; i += 2) {
                if (is_left_out(i)) continue;
                luma.add(y(0, i), y(0, i + 1), y(1, i), y(1, i + 1));
                chroma.add(cr(0, i), cr(0, i + 1), cr(1, i), cr(1, i + 1));
                ++squares;
            }
        }
    }
    const auto all = static_cast<double>(std::max<std::int64_t>(1, squares));
    const auto rms = [all](double sum) { return 255.0 / 4.0 * std::sqrt(sum / all); };
    return {rms(luma.straight), rms(chroma.straight), rms(luma.diagonal), rms(chroma.diagonal),
            static_cast<double>(luma.with_detail) / all};
}

Image quarter_of(const Stored& stored) {
    constexpr int kSide = 4;
    const Extent extent = stored.extent();
    const Extent small{std::max(1, extent.width / kSide), std::max(1, extent.height / kSide)};
    Image image;
    image.names = stored.image->names;
    image.sample = stored.image->sample;
    image.bits = stored.image->bits;
    for (const Plane<float>& plane : stored.image->planes) {
        Plane<float> mean(small);
        for (int j = 0; j < small.height; ++j) {
            for (int i = 0; i < small.width; ++i) {
                float sum = 0.0f;
                int texels = 0;
                for (int l = kSide * j; l < std::min(kSide * (j + 1), extent.height); ++l) {
                    for (int k = kSide * i; k < std::min(kSide * (i + 1), extent.width); ++k) {
                        sum += plane.at(k, l);
                        ++texels;
                    }
                }
                mean.at(i, j) = sum / static_cast<float>(texels);
            }
        }
        image.planes.push_back(std::move(mean));
    }
    return image;
}

}  // namespace tex::inline v1
