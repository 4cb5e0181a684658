// SPDX-License-Identifier: Apache-2.0

#include "repairs/smooth_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <tex/height.h>

#include "checks/stored.h"

namespace tex::inline v1 {
namespace {

constexpr int kStepCodes = 256;
constexpr float kStepUnit = 1.0f / 1024.0f;  // of the heights: one step
constexpr int kLeastStep = 4;

int code_at(float value) {
    return static_cast<int>(static_cast<float>(kStepCodes - 1) * std::clamp(value, 0.0f, 1.0f) + 0.5f);
}

// The codes that a channel takes, in ascending order; none if two are near each other.
std::vector<float> steps_of(const Plane<float>& plane) {
    std::array<bool, kStepCodes> is_used{};
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i)
            is_used[static_cast<std::size_t>(code_at(plane.at(i, j)))] = true;
    }
    std::vector<float> steps;
    for (int code = 0, last = -kLeastStep; code < kStepCodes; ++code) {
        if (!is_used[static_cast<std::size_t>(code)]) continue;
        if (code - last < kLeastStep) return {};
        last = code;
        steps.push_back(static_cast<float>(code));
    }
    return steps;
}

// The number of the step that a value lies on.
int step_of(const std::vector<float>& steps, float value) {
    const auto code = static_cast<float>(code_at(value));
    return static_cast<int>(std::lower_bound(steps.begin(), steps.end(), code) - steps.begin());
}

// The value at a fraction of steps; beyond the ends, the last distance goes on.
float value_at(const std::vector<float>& steps, float at) {
    const auto last = static_cast<int>(steps.size()) - 1;
    const int below = std::clamp(static_cast<int>(std::floor(at)), 0, last - 1);
    const float a = steps[static_cast<std::size_t>(below)], b = steps[static_cast<std::size_t>(below) + 1];
    const float code = a + (at - static_cast<float>(below)) * (b - a);
    return std::clamp(code / static_cast<float>(kStepCodes - 1), 0.0f, 1.0f);
}

// Most texels of many maps are level, and rounding moved all of them to one step beside the middle: steps of 17 codes
// have 119 and 136. Smoothing leaves an area of one value where it is, so that the map leans. The step becomes what
// brings the mean to the middle, within what was rounded to it; values between stay in their order.
void level_middle(Plane<float>& plane, const std::vector<float>& steps, const Plane<float>& smooth) {
    constexpr double kMiddle = 0.5, kLeastLevel = 0.25;  // of the texels
    constexpr float kOnStep = 0.1f;
    const Extent extent = plane.extent();
    const auto fraction = [&](int i, int j, int step) {
        return smooth.at(i, j) / kStepUnit - static_cast<float>(step);
    };
    std::vector<std::int64_t> texels(steps.size());
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float at = std::floor(smooth.at(i, j) / kStepUnit + 0.5f);
            ++texels[std::min(texels.size() - 1, static_cast<std::size_t>(std::max(0.0f, at)))];
        }
    }
    int level = -1;
    for (int k = 0; k < static_cast<int>(steps.size()); ++k) {
        const auto from = static_cast<double>(value_at(steps, static_cast<float>(k) - 0.5f)),
                   to = static_cast<double>(value_at(steps, static_cast<float>(k) + 0.5f));
        constexpr double kCode = 1.0 / 255.0;
        if (from > kMiddle + kCode || to < kMiddle - kCode) continue;
        if (level < 0 || texels[static_cast<std::size_t>(k)] > texels[static_cast<std::size_t>(level)]) level = k;
    }
    if (level < 0) return;
    const float from = value_at(steps, static_cast<float>(level) - 0.5f),
                to = value_at(steps, static_cast<float>(level) + 0.5f);
    // A value of the step is a part of its middle, and the rest of the end that it lies towards.
    double sum = 0.0, parts = 0.0, on_step = 0.0;
    const auto part_of = [](float f) { return 1.0f - 2.0f * std::abs(f); };
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float f = fraction(i, j, level);
            const bool is_inside = std::abs(f) < 0.5f;
            const float part = is_inside ? part_of(f) : 0.0f;
            parts += static_cast<double>(part);
            on_step += std::abs(f) < kOnStep ? 1.0 : 0.0;
            sum += static_cast<double>(is_inside ? (1.0f - part) * (f < 0.0f ? from : to) : plane.at(i, j));
        }
    }
    const auto all = static_cast<double>(extent.texels());
    if (on_step < kLeastLevel * all) return;
    const float middle = std::clamp(static_cast<float>((kMiddle * all - sum) / parts), from, to);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float f = fraction(i, j, level);
            if (std::abs(f) < 0.5f) plane.at(i, j) = part_of(f) * middle + (1.0f - part_of(f)) * (f < 0.0f ? from : to);
        }
    }
}

Result<void> smooth_channel(Plane<float>& plane, const std::vector<float>& steps, const Execution& execution) {
    HeightField field{Plane<float>(plane.extent()), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i)
            field.height.at(i, j) = kStepUnit * static_cast<float>(step_of(steps, plane.at(i, j)));
    }
    const auto smooth = deband(std::move(field), Deband::on, execution);
    if (!smooth) return smooth.error();
    if (!smooth->report.applied) return Error{ErrorCode::unsupported, {}, "the values lie on no steps"};
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i)
            plane.at(i, j) = value_at(steps, smooth->height.at(i, j) / kStepUnit);
    }
    level_middle(plane, steps, smooth->height);
    return {};
}

}  // namespace

Result<void> smooth_base(StoredLevels& levels, const Execution& execution) {
    const Stored stored = levels.stored(0);
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    std::vector<Plane<float>>& planes = levels.levels.front().planes;
    if (levels.is_signed) return Error{ErrorCode::unsupported, {}, "signed values"};
    for (const int channel : {x, y}) {
        Plane<float>& plane = planes[static_cast<std::size_t>(channel)];
        const std::vector<float> steps = steps_of(plane);
        if (steps.size() < 2) return Error{ErrorCode::unsupported, {}, "the values lie on no steps"};
        if (auto done = smooth_channel(plane, steps, execution); !done) return done;
    }
    if (z < 0) return {};
    // Where vectors were no unit vectors, the z of x and y lies beyond half a step.
    const std::vector<float> steps = steps_of(planes[static_cast<std::size_t>(z)]);
    if (steps.size() < 2) return {};
    for (int j = 0; j < stored.extent().height; ++j) {
        for (int i = 0; i < stored.extent().width; ++i) {
            float& value = planes[static_cast<std::size_t>(z)].at(i, j);
            const float a = stored.component(x, i, j), b = stored.component(y, i, j);
            const float implied = 0.5f + 0.5f * std::sqrt(std::max(0.0f, 1.0f - a * a - b * b));
            const auto step = static_cast<float>(step_of(steps, value));
            value = std::clamp(implied, value_at(steps, step - 0.5f), value_at(steps, step + 0.5f));
        }
    }
    return {};
}

}  // namespace tex::inline v1
