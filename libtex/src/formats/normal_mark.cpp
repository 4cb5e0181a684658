// SPDX-License-Identifier: Apache-2.0

#include "formats/normal_mark.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include <tex/format.h>

#include "formats/channels.h"

namespace tex::inline v1 {
namespace {

constexpr std::string_view kUp = "+y";
constexpr std::string_view kDown = "-y";
constexpr std::string_view kHeights = "heights ";

// The shortest digits that give these numbers again.
std::string heights_mark(float x, float y) {
    std::string mark(kHeights);
    const auto add = [&](float value) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value);
        mark.append(digits, end.ptr);
    };
    add(x);
    if (x == y) return mark;
    mark += ' ';
    add(y);
    return mark;
}

static_assert([] {
    std::size_t longest = 0;
    for (const Named<Swizzle>& row : kSwizzleNames) longest = std::max(longest, row.name.size());
    return longest + 1 + kUp.size() == kLongestNormalMark;
}());

// The layout of this name, or with these letters. Channels that hold no component of the normal are as in a file
// without a mark.
std::optional<Swizzle> swizzle_of(std::string_view word, Format format) {
    if (const Swizzle likely = likely_swizzle(format); layout_name(likely) == word) return likely;
    if (const auto named = find_by_name(kSwizzleNames, word)) return named;
    Swizzle swizzle;
    if (word.size() != swizzle.size()) return std::nullopt;
    for (std::size_t c = 0; c < swizzle.size(); ++c) {
        const auto component = find_by_name(kComponentNames, word.substr(c, 1));
        if (!component) return std::nullopt;
        swizzle[c] = *component;
    }
    return swizzle;
}

// Whether the format has a channel for each component of the normal that the swizzle places.
bool fits(const Swizzle& swizzle, Format format) {
    const auto channels = static_cast<std::ptrdiff_t>(format_info(format).channels);
    const auto count = [&](std::ptrdiff_t begin, std::ptrdiff_t end, Component component) {
        return std::count(swizzle.begin() + begin, swizzle.begin() + end, component);
    };
    const auto all = static_cast<std::ptrdiff_t>(swizzle.size());
    return count(0, channels, Component::x) > 0 && count(0, channels, Component::y) > 0 &&
           count(channels, all, Component::z) == 0;
}

}  // namespace

std::string normal_mark(const TextureHead& head) {
    if (head.bumpiness_x != 0.0f) return heights_mark(head.bumpiness_x, head.bumpiness_y);
    if (!head.swizzle_known) return {};
    std::string mark = layout_name(head.swizzle);
    if (head.y_known) mark.append(" ").append(head.y_axis == YAxis::up ? kUp : kDown);
    return mark;
}

bool apply_normal_mark(std::string_view mark, Texture& texture) {
    const std::size_t blank = mark.find(' ');
    const std::optional<Swizzle> swizzle = swizzle_of(mark.substr(0, blank), texture.format);
    if (!swizzle || !fits(*swizzle, texture.format)) return false;
    if (blank != std::string_view::npos) {
        const std::string_view y = mark.substr(blank + 1);
        if (y != kUp && y != kDown) return false;
        texture.y_axis = y == kUp ? YAxis::up : YAxis::down;
        texture.y_known = true;
    }
    texture.swizzle = *swizzle;
    texture.swizzle_known = true;
    texture.order_open = false;
    texture.normal_encoding = "signed";
    return true;
}

bool apply_found_mark(std::string_view mark, Texture& texture) {
    if (mark.empty()) return false;
    if (const std::optional<Strength> strength = strength_in_mark(mark)) {
        texture.bumpiness_x = strength->x;
        texture.bumpiness_y = strength->y;
        return false;
    }
    if (apply_normal_mark(mark, texture)) return true;
    texture.remarks.emplace_back("the mark libtex.normal was not understood");
    return false;
}

std::optional<Strength> strength_in_mark(std::string_view mark) {
    if (!mark.starts_with(kHeights)) return std::nullopt;
    float values[2] = {};
    const char* at = mark.data() + kHeights.size();
    const char* const end = mark.data() + mark.size();
    int count = 0;
    for (; count < 2 && at < end; ++count) {
        if (count > 0 && *at++ != ' ') return std::nullopt;
        const auto [next, error] = std::from_chars(at, end, values[count]);
        const float size = std::abs(values[count]);
        if (error != std::errc() || !(size >= 1e-20f && size <= 1e20f)) return std::nullopt;
        at = next;
    }
    if (count == 0 || at != end) return std::nullopt;
    return Strength{values[0], values[count - 1]};
}

std::string description_of(std::string_view mark) {
    return mark.empty() ? std::string() : std::string(kNormalKey).append(" ").append(mark);
}

std::string_view mark_in_description(std::string_view description) {
    while (!description.empty()) {
        const std::size_t end = description.find_first_of("\r\n");
        const std::string_view line = description.substr(0, end);
        if (line.starts_with(kNormalKey) && line.size() > kNormalKey.size() && line[kNormalKey.size()] == ' ')
            return line.substr(kNormalKey.size() + 1);
        if (end == std::string_view::npos) break;
        description.remove_prefix(end + 1);
    }
    return {};
}

}  // namespace tex::inline v1
