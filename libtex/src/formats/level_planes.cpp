// SPDX-License-Identifier: Apache-2.0

#include "formats/level_planes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "blocks/extent.h"
#include "formats/channels.h"
#include "rows/decode_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr unsigned kReds = 0xF800, kGreens = 0x07E0, kBlues = 0x001F;  // of a 16-bit colour

// The bits of the colours that differ anywhere in BC2 or BC3 blocks.
unsigned varying_bits(const Level& level) {
    constexpr std::size_t kBlockBytes = 16, kColors = 8;
    std::uint32_t first;
    std::memcpy(&first, level.bytes.data() + kColors, sizeof first);
    std::uint32_t varying = (first ^ first >> 16) & 0xFFFF;  // the colours of one block
    for (std::size_t at = kColors; at < level.bytes.size(); at += kBlockBytes) {
        std::uint32_t colors;
        std::memcpy(&colors, level.bytes.data() + at, sizeof colors);
        varying |= colors ^ first;
    }
    return (varying | varying >> 16) & 0xFFFF;
}

// The channels, as bits, that have one value in all texels.
unsigned constant_channels(Format format, const Level& level) {
    if (format != Format::bc2_unorm && format != Format::bc3_unorm) return 0;
    const unsigned varying = varying_bits(level);
    return ((varying & kReds) == 0 ? 1u : 0u) | ((varying & kGreens) == 0 ? 2u : 0u) |
           ((varying & kBlues) == 0 ? 4u : 0u);
}

// A plane whose rows are all the same row of one value.
Plane<float> one_row_plane(Extent extent, float value) {
    auto row = std::make_shared<Plane<float>>(Extent{extent.width, 1}, value);
    float* const texels = row->row(0);
    return {extent, 0, std::shared_ptr<float>(std::move(row), texels)};
}

// The first texel of each channel.
void decode_first(Format format, const Level& level, float values[4]) {
    Plane<float> block({kBlockEdge, 4 * kBlockEdge});
    ChannelRows rows;
    for (int c = 0; c < 4; ++c) rows.channel[c] = block.row(c * kBlockEdge);
    decode_blocks(format, level.bytes.data(), 1, rows, block.stride());
    for (int c = 0; c < 4; ++c) values[c] = block.at(0, c * kBlockEdge);
}

class LevelDecoder {
public:
    LevelDecoder(Format format, const Level& level, const PlaneNeeds& needs, Image& image)
        : format_(format), level_(level), needs_(needs), image_(image), strip_rows_(strip_rows_of(format)) {
        const unsigned constant = needs.share_constants ? constant_channels(format, level) : 0;
        float values[4] = {};
        if (constant != 0) decode_first(format, level, values);
        for (int c = 0; c < format_info(format).channels; ++c) {
            const bool is_needed = (needs.channels >> c & 1) != 0, is_constant = (constant >> c & 1) != 0;
            is_stored_[c] = is_needed && !is_constant;
            if (is_stored_[c])
                image.planes.emplace_back(level.extent);
            else
                image.planes.push_back(one_row_plane(level.extent, is_needed ? values[c] : 0.0f));
        }
    }

    [[nodiscard]] int strips() const { return blocks_across(level_.extent.height, strip_rows_); }

    void decode(int begin, int end) {
        const Extent extent = level_.extent;
        Plane<float> scratch({whole_blocks(extent.width), 4 * strip_rows_});
        for (int strip = begin; strip < end; ++strip) {
            const int first = strip * strip_rows_, count = std::min(strip_rows_, extent.height - first);
            if (needs_.rows && !needs_.rows(first, count)) continue;
            ChannelRows rows;
            for (int c = 0; c < 4; ++c) rows.channel[c] = is_stored_[c] ? scratch.row(c * strip_rows_) : nullptr;
            decode_strip(format_, level_, strip, rows, scratch.stride());
            for (int c = 0; c < 4; ++c) {
                for (int r = 0; is_stored_[c] && r < count; ++r)
                    std::memcpy(image_.planes[static_cast<std::size_t>(c)].row(first + r),
                                scratch.row(c * strip_rows_ + r),
                                static_cast<std::size_t>(extent.width) * sizeof(float));
            }
        }
    }

private:
    const Format format_;
    const Level& level_;
    const PlaneNeeds& needs_;
    Image& image_;
    const int strip_rows_;
    bool is_stored_[4] = {};
};

}  // namespace

Result<Image> decode_planes(const Texture& texture, const Level& level, const PlaneNeeds& needs,
                            const Execution& execution) {
    const FormatInfo info = format_info(texture.format);
    Image image;
    image.sample = info.sample;
    image.bits = info.bits;
    image.normal_encoding = texture.normal_encoding;
    image.names = channel_names(texture);
    LevelDecoder decoder(texture.format, level, needs, image);
    const int grain = strips_at_once(level.extent, strip_rows_of(texture.format));
    const auto decoded =
        parallel_for(execution, decoder.strips(), grain, [&](int begin, int end) { decoder.decode(begin, end); });
    if (!decoded) return decoded.error();
    return image;
}

}  // namespace tex::inline v1
