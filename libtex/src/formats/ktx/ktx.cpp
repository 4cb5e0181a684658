// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx/ktx.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>

#include <tex/types.h>

#include "formats/bytes.h"
#include "formats/channels.h"
#include "formats/ktx2/key_values.h"
#include "formats/layers.h"
#include "formats/size_limits.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kKtxHeaderBytes = 64;
constexpr std::uint32_t kKtxFaces = 6;
constexpr std::size_t kKtxAlignment = 4;  // of rows, layers and levels

struct KtxHeader {
    bool is_big_endian = false;
    std::uint32_t type, type_bytes, format, internal_format, width, height, depth, elements, faces, levels, key_bytes;
};

Error ktx_error(ErrorCode code, const std::string& name, std::string reason) { return {code, name, std::move(reason)}; }

Result<KtxHeader> parse_ktx_header(const std::vector<std::byte>& bytes, const std::string& name) {
    constexpr std::uint32_t kOrder = 0x04030201;
    const std::byte* const fields = bytes.data() + kKtxMagic.size();
    KtxHeader header = {};
    header.is_big_endian = load_big_u32(fields) == kOrder;
    if (!header.is_big_endian && load_u32(fields) != kOrder)
        return ktx_error(ErrorCode::bad_data, name, "damaged: the KTX header does not state the order of its bytes");
    const auto field = [&](std::size_t k) {
        return header.is_big_endian ? load_big_u32(fields + 4 * k) : load_u32(fields + 4 * k);
    };
    header.type = field(1);
    header.type_bytes = field(2);
    header.format = field(3);
    header.internal_format = field(4);
    header.width = field(6);
    header.height = field(7);
    header.depth = field(8);
    header.elements = field(9);
    header.faces = field(10);
    header.levels = field(11);
    header.key_bytes = field(12);
    return header;
}

// OpenGL's numbers (glcorearb.h).
struct GlType {
    std::uint32_t number;
    SampleKind sample;
    int bits;
};
constexpr GlType kGlTypes[] = {
    {0x1400, SampleKind::snorm, 8},  {0x1401, SampleKind::unorm, 8},     {0x1402, SampleKind::snorm, 16},
    {0x1403, SampleKind::unorm, 16}, {0x1406, SampleKind::floating, 32}, {0x140b, SampleKind::floating, 16},
};

struct GlFormat {
    std::uint32_t number;
    int channels;
    bool is_bgr;
};
constexpr std::uint32_t kGlAlpha = 0x1906;
constexpr GlFormat kGlFormats[] = {
    {0x1903, 1, false}, {kGlAlpha, 1, false}, {0x1907, 3, false}, {0x1908, 4, false},
    {0x1909, 1, false}, {0x8227, 2, false},   {0x80e0, 3, true},  {0x80e1, 4, true},
};
constexpr std::uint32_t kGlBc1RgbSrgb = 0x8c4c, kGlRgb8Srgb = 0x8c41, kGlRgba8Srgb = 0x8c43;

// Sets the format, and how rows are stored. False if they are of another kind.
bool describe_ktx_texels(const KtxHeader& header, StoredTexture& stored) {
    Texture& texture = stored.head;
    if (header.type == 0) {  // blocks
        const bool is_bc1 = header.internal_format == kGlBc1RgbSrgb;
        const auto marked = is_bc1 ? std::optional(MarkedFormat{Format::bc1_unorm, true})
                                   : find_format(&FormatRow::gl, header.internal_format);
        if (!marked) return false;
        texture.format = marked->format;
        texture.srgb = marked->srgb;
        texture.swizzle = likely_swizzle(texture.format);
        return true;
    }
    const auto* const type = std::find_if(std::begin(kGlTypes), std::end(kGlTypes),
                                          [&](const GlType& row) { return row.number == header.type; });
    const auto* const channels = std::find_if(std::begin(kGlFormats), std::end(kGlFormats),
                                              [&](const GlFormat& row) { return row.number == header.format; });
    if (type == std::end(kGlTypes) || channels == std::end(kGlFormats)) return false;
    const std::optional<Format> format = format_of(type->sample, type->bits, channels->channels);
    if (!format || (channels->is_bgr && type->bits != 8)) return false;
    texture.format = *format;
    texture.srgb = header.internal_format == kGlRgb8Srgb || header.internal_format == kGlRgba8Srgb;
    texture.swizzle = header.format == kGlAlpha ? kAlphaAlone : likely_swizzle(*format);
    stored.bgr = channels->is_bgr;
    stored.row_alignment = kKtxAlignment;
    return true;
}

// Whether rows run upwards. Errors: those of `fetch`.
Result<bool> runs_upwards(const FetchBytes& fetch, std::size_t size, const KtxHeader& header, Texture& texture) {
    if (header.key_bytes == 0) return false;
    std::optional<std::vector<KeyValue>> entries;
    Result<std::vector<std::byte>> bytes = std::vector<std::byte>();  // the entries point into them
    if (header.key_bytes <= size - kKtxHeaderBytes) {
        bytes = fetch(kKtxHeaderBytes, header.key_bytes);
        if (!bytes) return bytes.error();
        entries = parse_key_values(*bytes, header.is_big_endian);
    }
    if (!entries) {
        texture.remarks.emplace_back("the key/value data are damaged and were not read");
        return false;
    }
    return std::any_of(entries->begin(), entries->end(), [](const KeyValue& entry) {
        return entry.key == "KTXorientation" && entry.value.find("T=u") != std::string_view::npos;
    });
}

Result<Extent> check_ktx(const KtxHeader& header, const std::string& name, const ReadOptions& options) {
    if (header.faces != 1 && header.faces != kKtxFaces)
        return ktx_error(ErrorCode::bad_data, name, std::to_string(header.faces) + " faces");
    if (header.depth > 1) return ktx_error(ErrorCode::unsupported, name, "volume textures are not supported");
    if (header.height == 0)
        return ktx_error(ErrorCode::unsupported, name, "one-dimensional textures are not supported");
    if (header.is_big_endian && header.type_bytes > 1)
        return ktx_error(ErrorCode::unsupported, name, "big-endian texels are not supported");
    return claimed_extent(name, header.width, header.height, options);
}

// Finds the levels of the layer, which follow each other, each with all layers. The size of a cube map that is no array
// counts one face.
Result<void> find_ktx_levels(const FetchBytes& fetch, std::size_t size, const KtxHeader& header, Extent extent,
                             const LayerCount& count, std::uint64_t layer, const std::string& name,
                             StoredTexture& stored) {
    const auto levels = std::max<std::uint32_t>(header.levels, 1);
    std::size_t at = kKtxHeaderBytes + header.key_bytes;
    for (std::uint32_t k = 0; k < levels; ++k) {
        const std::string level = "level " + std::to_string(k);
        const Error ends_early = ktx_error(ErrorCode::bad_data, name, "truncated: " + level + " is not complete");
        if (at > size || size - at < 4) return ends_early;
        const Result<std::vector<std::byte>> field = fetch(at, 4);
        if (!field) return field.error();
        at += 4;
        const Extent its = level_extent(extent, static_cast<int>(k));
        const auto block = format_info(stored.head.format).block.height;
        const std::size_t image =
            stored_pitch(stored, its.width) * static_cast<std::size_t>((its.height + block - 1) / block);
        const std::uint64_t counted = count.has_faces && header.elements == 0 ? 1 : count.layers;
        const std::uint64_t stated = header.is_big_endian ? load_big_u32(field->data()) : load_u32(field->data());
        if (stated % counted != 0 || stated / counted != image)
            return ktx_error(ErrorCode::bad_data, name,
                             level + " has " + std::to_string(stated) + " bytes instead of " +
                                 (counted > 1 ? std::to_string(counted) + " times " : "") + std::to_string(image));
        if ((size - at) / image < count.layers) return ends_early;
        stored.levels.push_back({its, at + image * layer, image});
        at += image * count.layers;  // blocks and aligned rows leave no padding
    }
    stored.head.trailing_bytes = size - at;
    return {};
}

}  // namespace

Result<StoredTexture> parse_ktx(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                const ReadOptions& options) {
    if (size < kKtxHeaderBytes)
        return ktx_error(ErrorCode::bad_data, name, "truncated: the KTX header is not complete");
    const Result<std::vector<std::byte>> head = fetch(0, kKtxHeaderBytes);
    if (!head) return head.error();
    const Result<KtxHeader> header = parse_ktx_header(*head, name);
    if (!header) return header.error();
    const Result<Extent> extent = check_ktx(*header, name, options);
    if (!extent) return extent.error();
    StoredTexture stored;
    if (!describe_ktx_texels(*header, stored))
        return ktx_error(ErrorCode::unsupported, name,
                         "glInternalFormat " + std::to_string(header->internal_format) + " with glFormat " +
                             std::to_string(header->format) + " and glType " + std::to_string(header->type) +
                             " is not supported");
    if (header->levels > static_cast<std::uint32_t>(level_count(*extent)))
        return ktx_error(
            ErrorCode::bad_data, name,
            std::to_string(header->levels) + " levels, a complete chain has " + std::to_string(level_count(*extent)));
    const Result<bool> upwards = runs_upwards(fetch, size, *header, stored.head);
    if (!upwards) return upwards.error();
    stored.upwards = *upwards;
    if (stored.upwards && format_info(stored.head.format).has_blocks())
        return ktx_error(ErrorCode::unsupported, name,
                         "blocks whose rows run upwards (KTXorientation) are not supported");
    const bool is_cube = header->faces == kKtxFaces;
    const LayerCount count{std::uint64_t{std::max<std::uint32_t>(header->elements, 1)} * header->faces, is_cube};
    const Result<std::uint64_t> layer = chosen_layer(count, name, options);
    if (!layer) return layer.error();
    const Result<void> found = find_ktx_levels(fetch, size, *header, *extent, count, *layer, name, stored);
    if (!found) return found.error();
    return stored;
}

}  // namespace tex::inline v1
