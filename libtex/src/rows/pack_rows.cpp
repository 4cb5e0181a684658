// SPDX-License-Identifier: Apache-2.0

#include "rows/pack_rows.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <half.h>

#include "kernels/encode.h"
#include "kernels/pack.h"
#include "rows/codecs.h"
#include "rows/extra_rows.h"

namespace tex::inline v1 {
namespace {

// The rows of a normal map as the channels of a format.
class Rows {
public:
    // `lengthens`: vectors get the lengths that hold NormalMap::length.
    Rows(const NormalMap& map, int height, const Swizzle& swizzle, bool lengthens, YAxis y_axis)
        : map_(map), extent_{map.extent().width, height}, swizzle_(swizzle), lengthens_(lengthens),
          negate_y_(y_axis == YAxis::down) {}

    // The channels refer to the map, or to `scratch`.
    void channels(int j, PackChannel out[4], NormalMap& scratch) const {
        VectorRow normals{map_.x.row(j), map_.y.row(j), map_.z.row(j)};
        if (lengthens_) {
            if (scratch.x.empty()) scratch = NormalMap({extent_.width, 1});
            lengthen(normals, map_.length.row(j), extent_.width,
                     {scratch.x.row(0), scratch.y.row(0), scratch.z.row(0)});
            normals = {scratch.x.row(0), scratch.y.row(0), scratch.z.row(0)};
        }
        pack_channels(normals, swizzle_, negate_y_, row_of(map_.blue, j), row_of(map_.alpha, j), out);
    }

    [[nodiscard]] BlockRow blocks(int j) const { return block_row(map_.x, map_.y, extent_, j, negate_y_); }

    [[nodiscard]] Extent extent() const { return extent_; }

private:
    static const float* row_of(const Plane<float>& plane, int j) { return plane.empty() ? nullptr : plane.row(j); }

    const NormalMap& map_;
    const Extent extent_;
    const Swizzle swizzle_;
    const bool lengthens_;
    const bool negate_y_;
};

std::size_t size(int n) { return static_cast<std::size_t>(n); }

// Packs floats, or halves that Imath rounds to nearest even.
template <class Value>
void pack_values(const PackChannel* from, int channels, int count, std::byte* out) {
    for (int k = 0; k < channels; ++k) {
        const float* source = from[k].values;
        std::byte* to = out + size(k) * sizeof(Value);
        // 0 - n, not -n, so that a flat map holds no negative zeros.
        for (int i = 0; i < count; ++i, to += size(channels) * sizeof(Value)) {
            const Value value(source == nullptr ? 1.0f : from[k].negate ? 0.0f - source[i] : source[i]);
            std::memcpy(to, &value, sizeof value);
        }
    }
}

// Packs rows [begin, end). The kernels write past the end of a row, so they write into a separate row first.
void pack_rows_of_texels(const Rows& rows, const FormatInfo& info, int begin, int end, std::byte* out) {
    const int width = rows.extent().width;
    std::vector<std::byte> packed(size(width + kPackSlack) * info.block_bytes);
    NormalMap scratch;
    for (int j = begin; j < end; ++j) {
        PackChannel from[4];
        rows.channels(j, from, scratch);
        const std::size_t bytes = pack_texels(info, from, width, packed.data());
        std::memcpy(out + size(j) * bytes, packed.data(), bytes);
    }
}

float value_of(const PackChannel& channel, int i) {
    if (channel.values == nullptr) return 1.0f;
    return channel.negate ? -channel.values[i] : channel.values[i];
}

// Packs `count` rows of texels from row j into blocks that encode all components together. pack_rows() explains the
// other arguments.
void pack_whole_blocks(const WholeBlocks& codec, const Rows& rows, const PackOptions& options, int j, int count,
                       std::byte* out, const RdoBands& bands, RdoTally* tally, std::byte* plain) {
    const auto [format, swizzle] = encoding_info(options.encoding);
    const int width = rows.extent().width;
    std::vector<float> texels(size(codec.values) * size(width) * size(count));
    float* to = texels.data();
    NormalMap scratch;
    for (int k = j; k < j + count; ++k) {
        PackChannel from[4];
        rows.channels(k, from, scratch);
        if (codec.values == 2) from[1] = from[3];  // y
        if (swizzle[3] == Component::x) std::swap(from[0], from[3]);
        for (int i = 0; i < width; ++i) {
            for (int c = 0; c < codec.values; ++c) *to++ = value_of(from[c], i);
        }
    }
    codec.encode(format, options.effort, texels.data(), {width, count}, out);
    if (!is_optimised(options)) return;
    if (plain != nullptr) std::memcpy(plain, out, level_bytes(format, {width, count}));
    for (int k = 0; k < count; k += bands.rows) {
        const float* const band = texels.data() + size(codec.values) * size(width) * size(k);
        codec.optimise(band, std::min(bands.rows, count - k), bands.level, bands.first + j + k, options,
                       out + level_bytes(format, {width, k}), tally);
    }
}

}  // namespace

std::size_t pack_texels(const FormatInfo& format, const PackChannel* channels, int count, std::byte* out) {
    if (format.bits == 8) {
        pack_unorm8(channels, format.channels, count, reinterpret_cast<std::uint8_t*>(out));
    } else if (format.bits == 16 && format.sample == SampleKind::unorm) {
        pack_unorm16(channels, format.channels, count, reinterpret_cast<std::uint16_t*>(out));
    } else if (format.bits == 16) {
        pack_values<Imath::half>(channels, format.channels, count, out);
    } else {
        pack_values<float>(channels, format.channels, count, out);
    }
    return size(count) * format.block_bytes;
}

void pack_channels(VectorRow normals, const Swizzle& swizzle, bool negate_y, const float* blue, const float* alpha,
                   PackChannel out[4]) {
    for (std::size_t k = 0; k < 4; ++k) {
        switch (swizzle[k]) {
            case Component::x: out[k] = {normals.x}; break;
            case Component::y: out[k] = {normals.y, negate_y}; break;
            case Component::z: out[k] = {normals.z}; break;
            case Component::other: out[k] = {k == 3 ? alpha : blue, false, true}; break;
            default: out[k] = {}; break;  // every encoding's constants are 1, except in channels that it lacks
        }
    }
}

Swizzle swizzle_with(Encoding encoding, ExtraSet beside) {
    Swizzle swizzle = encoding_info(encoding).swizzle;
    if (beside.blue && can_hold(encoding).blue) swizzle[2] = Component::other;
    return swizzle;
}

void pack_rows(const NormalMap& map, ExtraSet extras, int height, const PackOptions& options, int begin, int end,
               std::byte* out, const RdoBands& bands, RdoTally* tally, std::byte* plain) {
    const Format format = encoding_info(options.encoding).format;
    const FormatInfo info = format_info(format);
    const ExtraSet held = extras & can_hold(options.encoding);
    Swizzle channels = swizzle_with(options.encoding, extras);
    if (held.alpha) channels[3] = Component::other;
    const Rows rows(map, height, channels, held.length, options.y_axis);
    if (info.has_blocks()) {
        const std::size_t pitch = level_bytes(format, {rows.extent().width, 1});
        const int block = info.block.height;
        if (const WholeBlocks* const codec = whole_blocks(options.encoding); codec != nullptr) {
            const std::size_t offset = size(begin / block) * pitch;
            return pack_whole_blocks(*codec, rows, options, begin, end - begin, out + offset, bands, tally,
                                     plain == nullptr ? nullptr : plain + offset);
        }
        for (int j = begin; j < end; j += block) encode_blocks(rows.blocks(j), options, out + size(j / block) * pitch);
        if (!is_optimised(options)) return;
        if (plain != nullptr) {
            const std::size_t offset = size(begin / block) * pitch;
            std::memcpy(plain + offset, out + offset, size(blocks_across(end - begin, block)) * pitch);
        }
        for (int j = begin; j < end; j += bands.rows) {
            const auto row = [&](int r) { return rows.blocks(j + r * block); };
            optimise_band(row, blocks_across(std::min(bands.rows, end - j), block), bands.level, bands.first + j,
                          options, out + size(j / block) * pitch, tally);
        }
        return;
    }
    pack_rows_of_texels(rows, info, begin, end, out);
}

}  // namespace tex::inline v1
