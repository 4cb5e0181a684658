// SPDX-License-Identifier: Apache-2.0

#include "color/color.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "color/ocio.h"
#include "rows/channel_names.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// The planes that hold colour: R, G and B, or the one that is not alpha. Empty if there are none.
std::vector<std::size_t> colour_planes(const std::vector<std::string>& names) {
    std::vector<std::size_t> planes;
    const std::vector<ChannelGroup> groups = channel_groups(names);
    if (const ChannelGroup* colours = colour_group(groups)) return colours->channels;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (!is_alpha(names[k])) planes.push_back(k);
    }
    if (planes.size() > 1) planes.clear();
    return planes;
}

// -- without a configuration -----------------------------------------------------------------------------------

// IEC 61966-2-1:1999. Beyond [0, 1] the curve continues by its own formula, and below 0 by symmetry.
float srgb_to_linear(float encoded) {
    const double c = std::abs(static_cast<double>(encoded));
    const double linear = c <= 0.04045 ? c / 12.92 : math::pow((c + 0.055) / 1.055, 2.4);
    return static_cast<float>(encoded < 0.0f ? -linear : linear);
}

// Pictures with few bits have few values, so a table of all codes is faster than computing the power for each texel.
std::vector<float> srgb_table(int bits) {
    const int top = (1 << bits) - 1;
    std::vector<float> table;
    table.reserve(static_cast<std::size_t>(top) + 1);
    for (int code = 0; code <= top; ++code) {
        table.push_back(srgb_to_linear(static_cast<float>(code) / static_cast<float>(top)));
    }
    return table;
}

void look_up(const std::vector<float>& table, float* row, int width) {
    const auto top = static_cast<float>(table.size() - 1);
    for (int i = 0; i < width; ++i) {
        row[i] = table[static_cast<std::size_t>(std::clamp(row[i], 0.0f, 1.0f) * top + 0.5f)];
    }
}

bool is_word(std::string_view text, std::string_view lower) {
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

Result<ConvertRow> built_in(SampleKind sample, int bits, const std::string& space) {
    if (is_word(space, "linear")) return ConvertRow([](const ColorRows&, int) { return Result<void>(); });
    if (!is_word(space, "srgb")) {
        return Error{ErrorCode::bad_option,
                     {},
                     "no colour space \"" + space + "\": without a configuration there are sRGB and linear"};
    }
    constexpr int kMostBitsOfTable = 16;
    if (sample == SampleKind::unorm && bits <= kMostBitsOfTable) {
        return ConvertRow([table = srgb_table(bits)](const ColorRows& rows, int width) {
            for (int k = 0; k < rows.given; ++k) look_up(table, rows.row[k], width);
            return Result<void>();
        });
    }
    return ConvertRow([](const ColorRows& rows, int width) {
        for (int k = 0; k < rows.given; ++k)
            std::transform(rows.row[k], rows.row[k] + width, rows.row[k], srgb_to_linear);
        return Result<void>();
    });
}

}  // namespace

Result<std::vector<std::string>> files_of_conversion(const std::string& config, const std::string& space) {
    if (space.empty() || config.empty()) return std::vector<std::string>();
    return files_of_config(config, space);
}

Result<LinearRows> linear_rows(const std::vector<std::string>& names, SampleKind sample, int bits,
                               const std::string& config, const std::string& space) {
    std::vector<std::size_t> planes = colour_planes(names);
    if (planes.empty()) {
        return Error{ErrorCode::bad_option, {}, "a colour space needs the channels R, G and B, or a single one"};
    }
    Result<ConvertRow> convert = config.empty() ? built_in(sample, bits, space) : by_config(config, space);
    if (!convert) return convert.error();
    return LinearRows(std::move(planes), std::move(*convert));
}

}  // namespace tex::inline v1
