// SPDX-License-Identifier: Apache-2.0

#include "rows/swizzle_evidence.h"

#include <algorithm>
#include <iterator>

#include <tex/format.h>

#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr float kConstant = 8.0f / 255.0f;  // a BC1 block may miss a constant by this much
constexpr int kMostTexels = 1 << 20;

int step_of(Extent extent) {
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(extent.texels()) / kMostTexels))));
}

double length_error(float a, float b, float c, float scale, float offset) {
    const float x = a * scale - offset;
    const float y = b * scale - offset;
    const float z = c * scale - offset;
    const float error = std::abs(x * x + y * y + z * z - 1.0f);
    return static_cast<double>(std::isfinite(error) ? std::min(error, 4.0f) : 4.0f);
}

double signed_error(float a, float b, float c) { return length_error(a, b, c, 1.0f, 0.0f); }
double unsigned_error(float a, float b, float c) { return length_error(a, b, c, 2.0f, 1.0f); }

bool is_near(float value, float wanted) { return std::abs(value - wanted) <= kConstant; }

Swizzle named(std::string_view name) { return *find_by_name(kSwizzleNames, name); }

}  // namespace

void SwizzleEvidence::Range::add(float value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
}

bool SwizzleEvidence::Range::is_constant() const { return !(greatest - least > kConstant); }

SwizzleEvidence::SwizzleEvidence(Extent extent, const Texture& head)
    : extent_(extent), is_float_(format_info(head.format).sample == SampleKind::floating),
      x_in_grey_(head.x_in_grey || format_row(head.format).codec->swizzle == kSwizzleXxxy), step_(step_of(extent)) {}

void SwizzleEvidence::add_row(int j, const float* const (&channels)[4]) {
    if (j % step_ != 0) return;
    for (int i = 0; i < extent_.width; i += step_) {
        const float r = channels[0][i];
        const float g = channels[1][i];
        const float b = channels[2][i];
        const float a = channels[3][i];
        for (std::size_t c = 0; c < 4; ++c) channels_[c].add(channels[c][i]);
        signed_.rgb += signed_error(r, g, b);
        signed_.rxgb += signed_error(a, g, b);
        unsigned_.rgb += unsigned_error(r, g, b);
        unsigned_.rxgb += unsigned_error(a, g, b);
        off_grey_ += static_cast<double>(std::abs(r - g) + std::abs(b - g)) / 2.0;
        ++count_;
    }
}

// If red varies and the colours are not grey, the layout is rgb, whatever else there is: see layout().
bool SwizzleEvidence::is_certain() const {
    const auto examined = [this](int side) { return static_cast<double>((side + step_ - 1) / step_); };
    return !channels_[0].is_constant() && off_grey_ > kGrey * examined(extent_.width) * examined(extent_.height);
}

Swizzle SwizzleEvidence::layout() const {
    // If no texel is negative, values are taken as unsigned.
    const bool is_signed =
        std::any_of(std::begin(channels_), std::end(channels_), [](const Range& range) { return range.least < 0.0f; });
    const auto count = static_cast<double>(count_);
    const double rgb_error = (is_signed ? signed_ : unsigned_).rgb / count;
    const double rxgb_error = (is_signed ? signed_ : unsigned_).rxgb / count;
    const auto& [r, g, b, a] = channels_;
    constexpr double kNotUnit = 0.25;  // far beyond quantisation and filtering
    // Floats without a negative value may still be signed: a flat map is 0, 0, 1.
    const bool is_unit = rgb_error <= kNotUnit || (is_float_ && signed_.rgb / count <= kNotUnit);
    const bool is_grey = off_grey_ / count <= kGrey;
    if (x_in_grey_ && is_grey && !(a.least > 1.0f - kConstant)) return named("ra");
    // A flat map with something else in alpha: DXT5nm has no such red beside such blue.
    constexpr float kHalf = 128.0f / 255.0f;
    const float zero = is_float_ && is_near(r.least, 0.0f) ? 0.0f : kHalf;  // of signed floats, or of codes
    if (r.is_constant() && is_near(r.least, zero) && b.is_constant() && is_near(b.least, 1.0f)) return named("rgb");
    if (r.is_constant() && b.is_constant() && (!a.is_constant() || !is_unit)) return named("dxt5nm");
    if (!a.is_constant() && is_grey) return named("dxt5nm");
    if (r.is_constant() && !a.is_constant() && rxgb_error < rgb_error) return named("rxgb");
    return named("rgb");
}

}  // namespace tex::inline v1
