// SPDX-License-Identifier: Apache-2.0

#include "formats/tga/tga.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "formats/byte_range.h"
#include "formats/code_rows.h"
#include "formats/size_limits.h"
#include "formats/tga/tga_header.h"
#include "formats/tga/tga_packets.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

template <int kDepth, std::size_t kChannels>
void copy_texels(const std::byte* stored, int width, std::uint8_t* out) {
    for (int i = 0; i < width; ++i, stored += kDepth / 8, out += kChannels) std::memcpy(out, stored, kChannels);
}

template <int kDepth, std::size_t kChannels>
void copy_colors(const std::byte* stored, int width, std::uint8_t* out) {
    for (int i = 0; i < width; ++i, stored += kDepth / 8, out += kChannels) {
        const std::array<std::uint8_t, 4> color = tga_color(stored, kDepth);
        std::memcpy(out, color.data(), kChannels);
    }
}

class TgaRows final : public CodeRows {
public:
    TgaRows(const InputFile& file, TgaHeader header) : file_(file), header_(std::move(header)) {
        describe_codes(header_.extent, channel_names(header_.channels), header_.bits);
        describe_mark(header_.normal_mark);
    }

    // Checks that all rows are there.
    Result<void> find_rows();

    Result<void> decode(int first, int count, std::byte* rows) override;

private:
    [[nodiscard]] std::size_t stored_bytes() const {
        return static_cast<std::size_t>(header_.extent.width) * header_.texel_bytes();
    }
    Result<void> find_packets();
    Result<void> read_stored(int first, int count, std::vector<std::byte>& stored) const;
    // Makes codes of a stored row. False if an index is beyond the palette.
    bool expand(const std::byte* stored, std::uint8_t* out) const;
    bool expand_indices(const std::byte* stored, std::uint8_t* out) const;

    const InputFile& file_;
    const TgaHeader header_;
    std::vector<TgaRowStart> starts_;  // of the rows in the order of the file, and of what follows them; only of RLE
};

Result<void> TgaRows::find_rows() {
    if (header_.is_rle) return find_packets();
    const auto rows = static_cast<std::int64_t>(stored_bytes()) * header_.extent.height;
    return *file_.size() - header_.first >= rows ? Result<void>() : Result<void>(ends_early(file_));
}

Result<void> TgaRows::find_packets() {
    ByteRange bytes(file_, header_.first, *file_.size());
    TgaPackets packets(bytes, header_.texel_bytes(), {header_.first, 0, false});
    starts_.reserve(static_cast<std::size_t>(header_.extent.height) + 1);
    starts_.push_back(packets.next());
    for (int j = 0; j < header_.extent.height; ++j) {
        if (!packets.read(header_.extent.width, nullptr)) return bytes.error();
        starts_.push_back(packets.next());
    }
    return {};
}

// Reads rows [first, first + count) in the order of the file.
Result<void> TgaRows::read_stored(int first, int count, std::vector<std::byte>& stored) const {
    if (!header_.is_rle) {
        const std::int64_t place = header_.first + static_cast<std::int64_t>(stored_bytes()) * first;
        const Result<std::size_t> got = file_.read_at(place, stored.data(), stored.size());
        if (!got) return got.error();
        return *got == stored.size() ? Result<void>() : Result<void>(ends_early(file_));
    }
    const TgaRowStart start = starts_[static_cast<std::size_t>(first)];
    // A run that goes on in the next row has its texel after the place of that row.
    const std::int64_t end =
        starts_[static_cast<std::size_t>(first + count)].place + static_cast<std::int64_t>(header_.texel_bytes());
    ByteRange bytes(file_, start.place, std::min(end, *file_.size()));
    TgaPackets packets(bytes, header_.texel_bytes(), start);
    for (int j = 0; j < count; ++j) {
        if (!packets.read(header_.extent.width, stored.data() + static_cast<std::size_t>(j) * stored_bytes()))
            return bytes.error();
    }
    return {};
}

bool TgaRows::expand(const std::byte* stored, std::uint8_t* out) const {
    const int width = header_.extent.width;
    if (header_.texels == TgaTexels::indices) return expand_indices(stored, out);
    if (header_.texels == TgaTexels::grey)
        header_.depth == 8      ? copy_texels<8, 1>(stored, width, out)
        : header_.channels == 2 ? copy_texels<16, 2>(stored, width, out)
                                : copy_texels<16, 1>(stored, width, out);
    else if (header_.depth == 16)
        copy_colors<16, 3>(stored, width, out);
    else if (header_.depth == 24)
        copy_colors<24, 3>(stored, width, out);
    else
        header_.channels == 4 ? copy_colors<32, 4>(stored, width, out) : copy_colors<32, 3>(stored, width, out);
    return true;
}

bool TgaRows::expand_indices(const std::byte* stored, std::uint8_t* out) const {
    const std::size_t step = header_.texel_bytes();
    const auto channels = static_cast<std::size_t>(header_.channels);
    const std::byte* const end = stored + stored_bytes();
    for (; stored < end; stored += step, out += channels) {
        const std::uint32_t high = step == 2 ? std::to_integer<std::uint32_t>(stored[1]) << 8 : 0;
        const std::uint32_t index = (std::to_integer<std::uint32_t>(stored[0]) | high) - header_.index_0;
        if (index >= header_.palette.size()) return false;
        std::memcpy(out, header_.palette[index].data(), channels);
    }
    return true;
}

void mirror(std::uint8_t* row, int width, std::size_t channels) {
    std::uint8_t* left = row;
    std::uint8_t* right = row + static_cast<std::size_t>(width - 1) * channels;
    for (; left < right; left += channels, right -= channels) std::swap_ranges(left, left + channels, right);
}

Result<void> TgaRows::decode(int first, int count, std::byte* rows) {
    const int height = header_.extent.height;
    std::vector<std::byte> stored(stored_bytes() * static_cast<std::size_t>(count));
    const int lowest = header_.from_top ? first : height - first - count;
    if (Result<void> read = read_stored(lowest, count, stored); !read) return read;
    for (int j = 0; j < count; ++j) {
        const int k = header_.from_top ? j : count - 1 - j;
        auto* const out = reinterpret_cast<std::uint8_t*>(rows) + static_cast<std::size_t>(j) * row_bytes();
        if (!expand(stored.data() + static_cast<std::size_t>(k) * stored_bytes(), out))
            return Error{ErrorCode::bad_data, file_.path(), "damaged: a texel has a colour that the palette lacks"};
        if (header_.from_right) mirror(out, header_.extent.width, static_cast<std::size_t>(header_.channels));
    }
    return {};
}

}  // namespace

bool may_be_tga(std::span<const std::byte> head) {
    if (head.size() < kTgaHeader) return false;
    const auto at = [&](std::size_t k) { return static_cast<int>(head[k]); };
    const auto one_of = [](int v, std::initializer_list<int> list) {
        return std::find(list.begin(), list.end(), v) != list.end();
    };
    const bool palette = at(1) == 1 && one_of(at(7), {15, 16, 24, 32});
    return (at(1) == 0 || palette) && one_of(at(2), {1, 2, 3, 9, 10, 11}) && one_of(at(16), {8, 15, 16, 24, 32}) &&
           (at(12) | at(13)) != 0 && (at(14) | at(15)) != 0;
}

Result<std::unique_ptr<RowSource>> open_tga(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        Result<TgaHeader> header = read_tga_header(file, options);
        if (!header) return header.error();
        auto rows = std::make_unique<TgaRows>(file, std::move(*header));
        if (const Result<void> found = rows->find_rows(); !found) return found.error();
        return std::unique_ptr<RowSource>(std::move(rows));
    });
}

}  // namespace tex::inline v1
