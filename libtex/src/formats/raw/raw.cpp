// SPDX-License-Identifier: Apache-2.0

#include "formats/raw/raw.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/raw/raw_rows.h"
#include "formats/size_limits.h"
#include "formats/words.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr std::string_view kWanted = "a raw layout is [WxH,]TYPE[,SKIP], for example 1025x1025,u16le";

RawSamples samples_of(RawType type) {
    switch (type) {
        case RawType::u8: return {SampleKind::unorm, 8, false};
        case RawType::u16le: return {SampleKind::unorm, 16, false};
        case RawType::u16be: return {SampleKind::unorm, 16, true};
        case RawType::s16le: return {SampleKind::snorm, 16, false};
        case RawType::s16be: return {SampleKind::snorm, 16, true};
        case RawType::f32le: return {SampleKind::floating, 32, false};
        case RawType::f32be: break;
    }
    return {SampleKind::floating, 32, true};
}

bool read_number(std::string_view text, std::int64_t& value) {
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && stop == text.data() + text.size() && value >= 0;
}

bool read_extent(std::string_view text, Extent& extent) {
    const std::size_t by = text.find('x');
    std::int64_t width = 0, height = 0;
    if (by == std::string_view::npos || !read_number(text.substr(0, by), width) ||
        !read_number(text.substr(by + 1), height))
        return false;
    if (width < 1 || height < 1 || width > kMaxExtent || height > kMaxExtent) return false;
    extent = {static_cast<int>(width), static_cast<int>(height)};
    return true;
}

// The extent of the layout, or that of a square that fills the file.
Result<Extent> extent_of(const InputFile& file, const RawLayout& layout, const ReadOptions& options) {
    const std::int64_t sample = samples_of(layout.type).bits / 8, bytes = *file.size() - layout.skip;
    const std::string holds = std::to_string(*file.size()) + " bytes";
    if (layout.extent.width == 0) {
        const std::int64_t texels = std::max<std::int64_t>(bytes, 0) / sample;
        const auto side = static_cast<std::int64_t>(std::sqrt(static_cast<double>(texels)));
        if (side < 1 || side * side * sample != bytes)
            return Error{ErrorCode::bad_data, file.path(),
                         holds + " are not a square of " + std::string(name_of(kRawTypeNames, layout.type)) +
                             "; name its extent in the raw layout"};
        return claimed_extent(file.path(), side, side, options);
    }
    Result<Extent> extent = claimed_extent(file.path(), layout.extent.width, layout.extent.height, options);
    if (!extent) return extent;
    const std::int64_t wanted = layout.skip + extent->texels() * sample;
    if (*file.size() == wanted) return extent;
    return Error{ErrorCode::bad_data, file.path(),
                 holds + ", but the raw layout wants " + std::to_string(wanted) + " bytes"};
}

}  // namespace

Result<RawLayout> parse_raw(const std::string& layout) {
    std::vector<std::string_view> words;
    std::string_view rest = layout;
    for (std::size_t comma; (comma = rest.find(',')) != std::string_view::npos; rest.remove_prefix(comma + 1))
        words.push_back(rest.substr(0, comma));
    words.push_back(rest);
    RawLayout raw;
    const Error wrong{ErrorCode::bad_option, {}, std::string(kWanted)};
    auto word = words.begin();
    if (read_extent(*word, raw.extent)) ++word;
    if (word == words.end()) return wrong;
    const auto type = find_by_name(kRawTypeNames, *word++);
    if (!type) return Error{ErrorCode::bad_option, {}, wrong.reason + "; types are u8 and u16, s16, f32 with le or be"};
    raw.type = *type;
    constexpr std::int64_t kMostSkipped = std::int64_t{1} << 40;
    if (word != words.end() && (!read_number(*word++, raw.skip) || raw.skip > kMostSkipped)) return wrong;
    if (word != words.end()) return wrong;
    return raw;
}

bool is_raw(const InputFile& file, const ReadOptions& options) {
    return !options.raw.empty() || has_extension(file.path(), ".r16") || has_extension(file.path(), ".r32");
}

Result<std::unique_ptr<RowSource>> open_raw(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        const std::string by_name = has_extension(file.path(), ".r32") ? "f32le" : "u16le";
        const Result<RawLayout> layout = parse_raw(options.raw.empty() ? by_name : options.raw);
        if (!layout) return layout.error();
        const std::int64_t limit = largest_file(options);
        if (const Result<void> settled = file.settle(limit); !settled) return settled.error();
        const Result<Extent> extent = extent_of(file, *layout, options);
        if (!extent) return extent.error();
        RawTexels place{.extent = *extent, .samples = samples_of(layout->type), .first = layout->skip};
        if (layout->extent.width == 0)
            place.remark = "the length of the file means " + std::to_string(extent->width) + "x" +
                           std::to_string(extent->height) + " texels";
        return open_raw_rows(file, std::move(place));
    });
}

Result<void> check_raw(const std::string& layout) {
    const Result<RawLayout> raw = parse_raw(layout);
    return raw ? Result<void>() : Result<void>(raw.error());
}

FileLayout raw_layout(const TextureHead& head, const WriteOptions&) {
    FileLayout layout;
    layout.levels = {{0, level_bytes(head.format, head.extent)}};
    layout.size = layout.levels.front().bytes;
    return layout;
}

}  // namespace tex::inline v1
