// SPDX-License-Identifier: Apache-2.0

#include "checks/jpeg.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "checks/median.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// Coefficients (u, v) with 1 <= u + v <= 4: higher ones are mostly 0 after quantisation.
constexpr int kHighest = 4;
constexpr int kSide = kHighest + 1;
constexpr std::size_t kCoefficients = std::size_t{kSide} * kSide;
// The steps of these coefficients for luma at quality 50 (T.81, table K.1), [v][u].
constexpr int kSteps[kSide][kSide] = {
    {16, 11, 10, 16, 24}, {12, 12, 14, 19, 26}, {14, 13, 16, 24, 40}, {14, 17, 22, 29, 51}, {18, 22, 37, 56, 68}};

constexpr int kFinest = 4;  // finer steps are lost in the rounding of R, G and B
constexpr int kCoarsest = 60;
constexpr int kBins = 16;    // of a histogram, per unit
constexpr int kRange = 512;  // larger magnitudes are rare
constexpr std::size_t kAllBins = std::size_t{kRange} * kBins;
constexpr std::size_t kLeastBlocks = 64;  // fewer fit a quantiser by chance
constexpr int kBlocks = 8192;             // this many are enough
constexpr double kLeastCount = 12.0;      // coefficients that are not rounded to 0
constexpr std::size_t kLeastCoefficients = 3;
constexpr double kAsStrong = 0.1;  // every multiple of 2q is also one of q: take the largest strong step
constexpr double kStrong = 0.6;

using Histogram = std::vector<double>;

// The bins of a histogram that are not 0, and what they hold. Small maps have few.
struct UsedBin {
    std::uint32_t bin = 0;
    double blocks = 0.0;
};
using UsedBins = std::vector<UsedBin>;

UsedBins used_bins(const Histogram& histogram) {
    UsedBins used;
    for (std::size_t k = 0; k < histogram.size(); ++k) {
        if (histogram[k] != 0.0) used.push_back({static_cast<std::uint32_t>(k), histogram[k]});
    }
    return used;
}

// Whether this block differs from all before it. Structures that repeat have few different blocks, and few blocks fit a
// quantiser by chance.
class DistinctBlocks {
public:
    bool add(const Image& image, int x, int y) {
        std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a of 64 bits, a value at a time
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = 0; j < 8; ++j) {
                const float* const row = image.planes[c].row(y + j) + x;
                for (int i = 0; i < 8; ++i) hash = (hash ^ std::bit_cast<std::uint32_t>(row[i])) * 0x100000001b3u;
            }
        }
        return hashes_.insert(hash).second;
    }
    [[nodiscard]] std::size_t count() const { return hashes_.size(); }

private:
    std::unordered_set<std::uint64_t> hashes_;
};

// The index of coefficient (u, v) in [v][u].
std::size_t place_of(int u, int v) { return static_cast<std::size_t>(v) * kSide + static_cast<std::size_t>(u); }

// Row u of the cosine transform of 8 samples (T.81, A.3.3).
struct CosineBasis {
    float row[kSide][8];
    CosineBasis() {
        for (int u = 0; u < kSide; ++u) {
            const double scale = u == 0 ? std::sqrt(0.125) : 0.5;
            for (int x = 0; x < 8; ++x)
                row[u][x] = static_cast<float>(scale * math::cos((2 * x + 1) * u * math::kPi / 16.0));
        }
    }
};

// Adds the coefficients of the block at (x, y), in codes of 8 bits, to their histograms [v][u].
void add_block(const Image& image, const CosineBasis& basis, int x, int y,
               std::array<Histogram, kCoefficients>& histograms) {
    float half[8][kSide] = {};
    for (int j = 0; j < 8; ++j) {
        const float *r = image.planes[0].row(y + j) + x, *g = image.planes[1].row(y + j) + x,
                    *b = image.planes[2].row(y + j) + x;
        for (int i = 0; i < 8; ++i) {
            const float luma = 255.0f * (0.299f * r[i] + 0.587f * g[i] + 0.114f * b[i]);
            for (int u = 0; u < kSide; ++u) half[j][u] += luma * basis.row[u][i];
        }
    }
    for (int v = 0; v < kSide; ++v) {
        for (int u = 0; u < kSide; ++u) {
            if (u + v == 0 || u + v > kHighest) continue;
            float value = 0.0f;
            for (int j = 0; j < 8; ++j) value += half[j][u] * basis.row[v][j];
            const float magnitude = std::abs(value) * static_cast<float>(kBins) + 0.5f;
            if (!(magnitude < static_cast<float>(kAllBins))) continue;  // also if NaN
            histograms[place_of(u, v)][static_cast<std::size_t>(magnitude)] += 1.0;
        }
    }
}

// One period of cos(2 pi c / step) for each step, in bins. It is computed only once, because small files would spend
// most of their time on it.
const std::vector<double>& wave_of(int step) {
    static const auto waves = [] {
        std::array<std::vector<double>, kCoarsest + 1> all;
        for (int each = kFinest; each <= kCoarsest; ++each) {
            const int period = each * kBins;
            for (int k = 0; k < period; ++k)
                all[static_cast<std::size_t>(each)].push_back(math::cos(2.0 * math::kPi * k / period));
        }
        return all;
    }();
    return waves[static_cast<std::size_t>(step)];
}

// The mean of cos(2 pi c / step) over the coefficients c of at least half a step: 1 if all are multiples, -1 if there
// are too few coefficients.
double strength_at(const UsedBins& bins, int step) {
    const std::vector<double>& wave = wave_of(step);
    const auto period = static_cast<std::uint32_t>(wave.size());
    double sum = 0.0, count = 0.0;
    std::uint32_t last = 0, phase = 0;
    for (const auto& [bin, blocks] : bins) {
        phase += bin - last;
        last = bin;
        while (phase >= period) phase -= period;
        if (bin < period / 2) continue;
        sum += blocks * wave[phase];
        count += blocks;
    }
    return count < kLeastCount ? -1.0 : sum / count;
}

struct Step {
    double strength = -1.0;
    int step = 0;
};

Step step_of(const Histogram& histogram) {
    const UsedBins bins = used_bins(histogram);
    std::array<double, kCoarsest + 1> strengths{};
    double most = -1.0;
    for (int step = kFinest; step <= kCoarsest; ++step) {
        strengths[static_cast<std::size_t>(step)] = strength_at(bins, step);
        most = std::max(most, strengths[static_cast<std::size_t>(step)]);
    }
    for (int step = kCoarsest; step >= kFinest && most > 0.0; --step) {
        const double strength = strengths[static_cast<std::size_t>(step)];
        if (strength >= most - kAsStrong && strength > 0.0) return {strength, step};
    }
    return {};
}

}  // namespace

JpegTrace measure_jpeg(const Stored& stored, int offset) {
    if (stored.image->planes.size() < 3 || stored.is_signed) return {};
    const std::vector<Rect> windows = sample_windows(stored.extent());
    std::int64_t blocks = 0;
    for (const Rect& window : windows) blocks += std::int64_t{window.width / 8} * (window.height / 8);
    if (blocks < static_cast<std::int64_t>(kLeastBlocks)) return {};
    const auto stride = static_cast<int>(std::max<std::int64_t>(1, blocks / kBlocks));
    std::array<Histogram, kCoefficients> histograms;
    histograms.fill(Histogram(kAllBins));
    const CosineBasis basis;
    DistinctBlocks distinct;
    for (const Rect& window : windows) {
        for (int y = offset; y + 8 <= window.height; y += 8) {
            for (int x = offset + y / 8 % stride * 8; x + 8 <= window.width; x += 8 * stride) {
                if (distinct.add(*stored.image, window.x + x, window.y + y))
                    add_block(*stored.image, basis, window.x + x, window.y + y, histograms);
            }
        }
    }
    if (distinct.count() < kLeastBlocks) return {};
    std::vector<double> strengths, scales;
    for (int v = 0; v < kSide; ++v) {
        for (int u = 0; u < kSide; ++u) {
            const Step step = step_of(histograms[place_of(u, v)]);
            if (step.step == 0) continue;
            strengths.push_back(step.strength);
            if (step.strength > kStrong) scales.push_back(static_cast<double>(step.step) / kSteps[v][u]);
        }
    }
    if (strengths.size() < kLeastCoefficients || scales.empty()) return {};
    return {median(strengths), median(scales)};
}

}  // namespace tex::inline v1
