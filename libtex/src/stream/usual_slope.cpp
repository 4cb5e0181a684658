// SPDX-License-Identifier: Apache-2.0

#include "stream/usual_slope.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "stream/height_stage.h"
#include "stream/open_heights.h"

namespace tex::inline v1 {
namespace {

constexpr std::int64_t kEnoughTexels = std::int64_t{1} << 20;
constexpr double kUsual = 0.99;
// The leading bits of a positive float are its exponent and the first bits of its fraction: bins of the square of the
// slope, of at most 1.6 % each, so 0.8 % of the slope.
constexpr int kDroppedBits = 17;
constexpr std::size_t kSlopeBinCount = std::size_t{1} << (31 - kDroppedBits);

class MeasureStage final : public Stage {
public:
    MeasureStage(const Stage& normals, UsualSlope& usual)
        : Stage(normals.extent(), 0), normals_(normals), usual_(usual) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int j = strip.first; j < strip.first + strip.height; ++j) {
            if (usual_.wants(j)) usual_.add(normals_.normals(j));
        }
        return {};
    }

private:
    const Stage& normals_;
    UsualSlope& usual_;
};

double rounded_to_three_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    return std::round(value / unit) * unit;
}

}  // namespace

UsualSlope::UsualSlope(Extent extent, float strength)
    : width_(extent.width), strength_(strength == 0.0f ? 1.0f : std::abs(strength)),
      stride_(static_cast<int>((extent.texels() + kEnoughTexels - 1) / kEnoughTexels)), counts_(kSlopeBinCount) {}

// Not every n-th row: the joints of tiles come at equal distances, too. (Knuth, The Art of Computer Programming, volume
// 3, section 6.4: multiplicative hashing.)
bool UsualSlope::wants(int row) const {
    const std::uint32_t mixed = static_cast<std::uint32_t>(row) * 2654435769u;
    return (mixed >> 16) % static_cast<std::uint32_t>(stride_) == 0;
}

void UsualSlope::add(const VectorRow& row) {
    const std::lock_guard lock(mutex_);
    for (int i = 0; i < width_; ++i) {
        const float z = std::max(row.z[i], 1e-16f) * strength_;
        const float square = (row.x[i] * row.x[i] + row.y[i] * row.y[i]) / (z * z);
        ++counts_[std::min<std::size_t>(std::bit_cast<std::uint32_t>(square) >> kDroppedBits, kSlopeBinCount - 1)];
    }
}

float UsualSlope::slope() const { return strength_ * slope_at_one(); }

float UsualSlope::strength_for_one() const {
    const auto slope = static_cast<double>(slope_at_one());
    return slope > 0.0 ? static_cast<float>(rounded_to_three_digits(1.0 / slope)) : 0.0f;
}

float UsualSlope::slope_at_one() const {
    std::int64_t all = 0, below = 0;
    for (const std::int64_t count : counts_) all += count;
    std::size_t bin = 0;
    while (bin + 1 < counts_.size() && static_cast<double>(below += counts_[bin]) < kUsual * static_cast<double>(all))
        ++bin;
    return bin == 0 ? 0.0f : std::sqrt(std::bit_cast<float>(static_cast<std::uint32_t>(bin) << kDroppedBits));
}

Result<Strength> measure_strength(InputFile& file, const BakeFileOptions& options, const Execution& execution) {
    BakeFileOptions as_one = options;
    as_one.strength = [](Extent) { return Strength{1.0f, 1.0f}; };
    as_one.vertical_scale = 1.0f;
    const Gradient gradient = gradient_of(options.bake);
    const Execution silent = execution.quiet();
    Result<Heights> heights = open_heights(file, RowOrder::any, as_one, gradient, silent);
    if (!heights) return heights.error();
    UsualSlope usual(heights->rows->extent());
    Flow flow;
    flow.add<MeasureStage>(*add_bake(flow, *heights, file.path(), as_one, gradient).normals, usual);
    Execution onward = execution.quiet();
    onward.progress = [&execution](double) { return !execution.progress || execution.progress(0.0); };
    if (const Result<void> done = flow.run(onward); !done) return done.error();
    const float strength = usual.strength_for_one();
    return strength > 0.0f ? Strength{strength, strength} : Strength{};
}

Result<BakeFileOptions> with_measured_strength(InputFile& file, const BakeFileOptions& options,
                                               const Execution& execution) {
    if (!options.auto_strength) return options;
    if (const Result<void> settled = file.settle(largest_file(options.read)); !settled) return settled.error();
    const Result<Strength> strength = measure_strength(file, options, execution);
    if (!strength) return strength.error();
    if (const Result<void> again = file.rewind(); !again) return again.error();
    BakeFileOptions measured = options;
    measured.auto_strength = false;
    measured.strength = [found = *strength](Extent) { return found; };
    return measured;
}

}  // namespace tex::inline v1
