// SPDX-License-Identifier: Apache-2.0

#include "formats/raw/raw.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/claims.h"
#include "kernels/samples.h"
#include "threads/guard.h"

namespace tex {
namespace {

constexpr std::string_view kWanted = "a raw layout is [WxH,]TYPE[,SKIP], for example 1025x1025,u16le";

struct RawSamples {
    SampleKind kind;
    int bits;
    bool big_endian;
    std::uint32_t tiff_kind;  // as StoredSamples counts
};

RawSamples samples_of(RawType type) {
    switch (type) {
        case RawType::u8: return {SampleKind::unorm, 8, false, 1};
        case RawType::u16le: return {SampleKind::unorm, 16, false, 1};
        case RawType::u16be: return {SampleKind::unorm, 16, true, 1};
        case RawType::s16le: return {SampleKind::snorm, 16, false, 2};
        case RawType::s16be: return {SampleKind::snorm, 16, true, 2};
        case RawType::f32le: return {SampleKind::floating, 32, false, 3};
        case RawType::f32be: break;
    }
    return {SampleKind::floating, 32, true, 3};
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

// In any case.
bool has_extension(std::string_view path, std::string_view extension) {
    if (path.size() < extension.size()) return false;
    const std::string_view end = path.substr(path.size() - extension.size());
    return std::equal(end.begin(), end.end(), extension.begin(), [](char a, char b) { return a == b || a + 32 == b; });
}

class RawRows final : public RowSource {
public:
    RawRows(const InputFile& file, const RawLayout& layout, Extent extent)
        : file_(file), skip_(layout.skip), samples_(samples_of(layout.type)) {
        describe(extent, {"Y"}, static_cast<std::size_t>(extent.width) * sample_bytes());
        describe_samples(samples_.kind, samples_.bits);
        describe_stored({.kind = samples_.tiff_kind, .bits = static_cast<std::uint32_t>(samples_.bits)});
        if (layout.extent.width == 0)
            describe_remark("the length of the file means " + std::to_string(extent.width) + "x" +
                            std::to_string(extent.height) + " texels");
    }

    [[nodiscard]] bool is_random() const override { return true; }
    bool store_numbers() override {
        has_whole_numbers_ = true;
        return true;
    }

    Result<void> decode(int first, int count, std::byte* rows) override {
        const std::size_t bytes = row_bytes() * static_cast<std::size_t>(count);
        const std::int64_t offset = skip_ + static_cast<std::int64_t>(row_bytes()) * first;
        const Result<std::size_t> got = file_.read_at(offset, rows, bytes);
        if (!got) return got.error();
        if (*got < bytes) return Error{ErrorCode::bad_data, file_.path(), "the file has become shorter"};
        for (std::size_t at = 0; samples_.big_endian && at < bytes; at += sample_bytes())
            std::reverse(rows + at, rows + at + sample_bytes());
        return {};
    }

    void store(const std::byte* rows, int first, int end, Image& image) const override {
        for (int j = first; j < end; ++j, rows += row_bytes()) {
            float* const to = image.planes.front().row(j);
            if (has_whole_numbers_ && samples_.kind != SampleKind::floating)
                store_whole_numbers(rows, to);
            else
                decode_samples(samples_.kind, samples_.bits, rows, sample_bytes(), extent().width, to);
        }
    }

private:
    [[nodiscard]] std::size_t sample_bytes() const { return static_cast<std::size_t>(samples_.bits / 8); }

    void store_whole_numbers(const std::byte* row, float* to) const {
        for (int i = 0; i < extent().width; ++i, row += sample_bytes()) {
            std::uint16_t code = 0;
            std::memcpy(&code, row, sample_bytes());
            to[i] = samples_.kind == SampleKind::snorm ? static_cast<float>(static_cast<std::int16_t>(code))
                                                       : static_cast<float>(code);
        }
    }

    const InputFile& file_;
    const std::int64_t skip_;
    const RawSamples samples_;
    bool has_whole_numbers_ = false;
};

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
    return guarded([&]() -> Result<std::unique_ptr<RowSource>> {
        const std::string by_name = has_extension(file.path(), ".r32") ? "f32le" : "u16le";
        const Result<RawLayout> layout = parse_raw(options.raw.empty() ? by_name : options.raw);
        if (!layout) return layout.error();
        const std::int64_t limit = largest_file(options);
        if (const Result<void> settled = file.settle(limit); !settled) return settled.error();
        const Result<Extent> extent = extent_of(file, *layout, options);
        if (!extent) return extent.error();
        return std::unique_ptr<RowSource>(std::make_unique<RawRows>(file, *layout, *extent));
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

}  // namespace tex
