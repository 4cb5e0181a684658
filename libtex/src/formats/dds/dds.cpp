// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/dds.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <tex/types.h>

#include "formats/bytes.h"
#include "formats/dds/dds_format.h"
#include "formats/layers.h"
#include "formats/normal_mark.h"
#include "formats/size_limits.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMagicBytes = kDdsMagic.size();
constexpr std::size_t kHeaderBytes = 124;
constexpr std::size_t kPixelFormatBytes = 32;
constexpr std::size_t kDx10Bytes = 20;

// The mark of libtex in the reserved words: a tag, then up to kMarkBytes of text.
constexpr std::size_t kReservedAt = 28;  // in the header
constexpr std::size_t kReservedWords = 11;
constexpr std::size_t kMarkWord = 3;
constexpr std::string_view kMarkTag = "LTEX";
constexpr std::size_t kMarkBytes = 12;
// The signatures of writers that store x first in ATI2, in the reserved words 0 and 1, and 9.
constexpr std::string_view kGimp = "GIMP-DDS";
constexpr std::string_view kNvtt = "NVTT";
constexpr std::size_t kNvttWord = 9;
static_assert(kMarkBytes >= kLongestNormalMark);

// DDS_HEADER::dwFlags, dwCaps and dwCaps2 (ddraw.h).
constexpr std::uint32_t kDdsdCaps = 0x1;
constexpr std::uint32_t kDdsdHeight = 0x2;
constexpr std::uint32_t kDdsdWidth = 0x4;
constexpr std::uint32_t kDdsdPitch = 0x8;
constexpr std::uint32_t kDdsdPixelFormat = 0x1000;
constexpr std::uint32_t kDdsdMipMapCount = 0x20000;
constexpr std::uint32_t kDdsdLinearSize = 0x80000;
constexpr std::uint32_t kDdsdDepth = 0x800000;
constexpr std::uint32_t kCapsComplex = 0x8;
constexpr std::uint32_t kCapsTexture = 0x1000;
constexpr std::uint32_t kCapsMipMap = 0x400000;
constexpr std::uint32_t kCaps2CubeMap = 0x200;
constexpr std::uint32_t kCaps2AllFaces = 0xfc00;
constexpr std::uint32_t kCaps2Volume = 0x200000;

// DDS_HEADER_DXT10.
constexpr std::uint32_t kDimensionTexture1d = 2;
constexpr std::uint32_t kDimensionTexture2d = 3;
constexpr std::uint32_t kDimensionTexture3d = 4;
constexpr std::uint32_t kMiscTextureCube = 0x4;
constexpr std::uint32_t kAlphaModeCustom = 4;  // alpha is a channel like the others

// -- writing -------------------------------------------------------------------------------------------------

bool is_dxt5nm(const Swizzle& swizzle) {
    return swizzle[0] != Component::x && swizzle[1] == Component::y && swizzle[3] == Component::x;
}

// What D3DFORMATs are as masks. Blue is first, as Direct3D 9 stores it: some readers (ImageMagick 6) ignore the masks.
constexpr std::pair<std::uint32_t, DdsPixelFormat> kMasked[] = {
    {kD3dL8, {kDdpfLuminance, 0, 8, {0xff, 0, 0, 0}}},
    {kD3dL16, {kDdpfLuminance, 0, 16, {0xffff, 0, 0, 0}}},
    {kD3dR8G8B8, {kDdpfRgb, 0, 24, {0xff0000, 0xff00, 0xff, 0}}},
    {kD3dA8R8G8B8, {kDdpfRgb | kDdpfAlphaPixels, 0, 32, {0xff0000, 0xff00, 0xff, 0xff000000}}},
};

// The pixel format of a legacy header; nullopt if Direct3D 9 lacks the format.
std::optional<DdsPixelFormat> legacy_pixel_format(const TextureHead& head) {
    const std::uint32_t number = format_row(widened(head.format)).d3d9;
    if (number == 0) return std::nullopt;
    const auto masked =
        std::find_if(std::begin(kMasked), std::end(kMasked), [&](const auto& row) { return row.first == number; });
    DdsPixelFormat legacy = masked != std::end(kMasked) ? masked->second : DdsPixelFormat{kDdpfFourCc, number, 0, {}};
    // ATI2 without this code leaves open whether x or y is first. The mark of libtex says it.
    if (legacy.four_cc == fourcc("ATI2") && head.swizzle[0] != Component::y) legacy.bit_count = fourcc("A2XY");
    return legacy;
}

// dwReserved1, in which tools write their signatures: GIMP in words 0 to 3, NVIDIA's in words 7 to 10. Word 3, which
// GIMP reads only after its own signature, begins the mark of libtex.
void write_reserved(ByteWriter& writer, const TextureHead& head) {
    const std::string mark = normal_mark(head);
    const std::size_t end = writer.size() + kReservedWords * sizeof(std::uint32_t);
    if (!mark.empty() && mark.size() <= kLongestNormalMark) {
        writer.zeros(kMarkWord * sizeof(std::uint32_t));
        writer.text(kMarkTag);
        writer.text(mark);
    }
    writer.zeros(end - writer.size());
}

// dwPitchOrLinearSize: the number of bytes of a row of texels, or of the base level for block formats.
std::uint32_t pitch_or_size(const TextureHead& head, Rearrange rearrange) {
    const Extent base = format_info(head.format).has_blocks() ? head.extent : Extent{head.extent.width, 1};
    const std::size_t bytes = stored_level_bytes(head.format, base, rearrange);
    return static_cast<std::uint32_t>(std::min<std::size_t>(bytes, 0xffffffffu));
}

// -- reading -------------------------------------------------------------------------------------------------

struct Header {
    std::uint32_t flags = 0;
    std::uint32_t height = 0;
    std::uint32_t width = 0;
    std::uint32_t depth = 0;
    std::uint32_t mip_map_count = 0;
    DdsPixelFormat pixel_format;
    std::uint32_t caps2 = 0;
    std::string mark;                              // of libtex, see normal_mark.h
    bool writes_x_first = false;                   // the writer, as its signature says
    std::size_t end = kMagicBytes + kHeaderBytes;  // where the levels begin
    bool has_dx10 = false;
    std::uint32_t dxgi = 0;
    std::uint32_t dimension = 0;
    std::uint32_t misc = 0;
    std::uint32_t array_size = 0;
    std::vector<std::string> remarks;
};

Error bad_data(const std::string& name, std::string reason) { return {ErrorCode::bad_data, name, std::move(reason)}; }

Error unsupported(const std::string& name, std::string reason) {
    return {ErrorCode::unsupported, name, std::move(reason)};
}

// The mark in the reserved words; empty if there is none.
std::string mark_of(const std::byte* reserved) {
    const char* const tag = reinterpret_cast<const char*>(reserved + kMarkWord * sizeof(std::uint32_t));
    if (std::string_view(tag, kMarkTag.size()) != kMarkTag) return {};
    const char* const text = tag + kMarkTag.size();
    const std::string mark(text, strnlen(text, kMarkBytes));
    return mark.empty() ? "?" : mark;
}

bool is_by_writer_of_x(const std::byte* reserved) {
    const auto* const text = reinterpret_cast<const char*>(reserved);
    return std::string_view(text, kGimp.size()) == kGimp ||
           std::string_view(text + kNvttWord * sizeof(std::uint32_t), kNvtt.size()) == kNvtt;
}

Result<Header> parse_header(const std::byte* data, std::size_t size, const std::string& name) {
    if (size < kMagicBytes + kHeaderBytes) return bad_data(name, "truncated: the DDS header is not complete");
    const auto field = [&](std::size_t index) { return load_u32(data + kMagicBytes + 4 * index); };
    Header header;
    // Some tools wrote 24 to both size fields; the other fields are at their usual places.
    const std::uint32_t header_bytes = field(0);
    const std::uint32_t format_bytes = field(18);
    if (header_bytes != kHeaderBytes && header_bytes != 24) {
        return bad_data(name, "DDS header of " + std::to_string(header_bytes) + " bytes instead of 124");
    }
    if (format_bytes != kPixelFormatBytes && format_bytes != 24 && format_bytes != 0) {
        return bad_data(name, "DDS pixel format of " + std::to_string(format_bytes) + " bytes instead of 32");
    }
    if (header_bytes != kHeaderBytes) header.remarks.push_back("the header gives its size as 24 instead of 124");
    if (format_bytes != kPixelFormatBytes) {
        header.remarks.push_back("the pixel format gives its size as " + std::to_string(format_bytes) +
                                 " instead of 32");
    }
    header.flags = field(1);
    header.height = field(2);
    header.width = field(3);
    header.depth = field(5);
    header.mip_map_count = field(6);
    header.mark = mark_of(data + kMagicBytes + kReservedAt);
    header.writes_x_first = is_by_writer_of_x(data + kMagicBytes + kReservedAt);
    header.pixel_format = {field(19), field(20), field(21), {field(22), field(23), field(24), field(25)}};
    header.caps2 = field(27);
    if (header.pixel_format.four_cc == fourcc("DX10") && (header.pixel_format.flags & kDdpfFourCc) != 0) {
        if (size < header.end + kDx10Bytes) return bad_data(name, "truncated: the DX10 header is not complete");
        const auto dx10 = [&](std::size_t index) { return load_u32(data + header.end + 4 * index); };
        header.has_dx10 = true;
        header.dxgi = dx10(0);
        header.dimension = dx10(1);
        header.misc = dx10(2);
        header.array_size = dx10(3);
        header.end += kDx10Bytes;
    }
    return header;
}

// The pictures in the file. Errors: unsupported (volumes).
Result<LayerCount> count_layers(Header& header, const std::string& name) {
    constexpr std::uint64_t kFaces = 6;
    const bool is_legacy_cube = (header.caps2 & kCaps2CubeMap) != 0;
    const bool is_cube = is_legacy_cube || (header.has_dx10 && (header.misc & kMiscTextureCube) != 0);
    const bool is_volume = (header.caps2 & kCaps2Volume) != 0 ||
                           ((header.flags & kDdsdDepth) != 0 && header.depth > 1) ||
                           (header.has_dx10 && header.dimension == kDimensionTexture3d);
    if (is_volume) return unsupported(name, "volume textures are not supported");
    // Direct3D 9 has cube maps without some of their faces.
    const int faces = std::popcount(header.caps2 & kCaps2AllFaces);
    LayerCount count{is_cube ? kFaces : 1, is_cube};
    if (!header.has_dx10) {
        if (is_cube && faces > 0) count.layers = static_cast<std::uint64_t>(faces);
        return count;
    }
    count.layers *= std::max<std::uint64_t>(header.array_size, 1);
    if (header.array_size == 0) header.remarks.push_back("the array size is 0 instead of 1");
    if (header.dimension != kDimensionTexture2d && !(header.dimension == kDimensionTexture1d && header.height == 1)) {
        header.remarks.push_back("the resource dimension is " + std::to_string(header.dimension) + " instead of 3");
    }
    return count;
}

// Bytes of a level in the file. Does not overflow: at most 2^40 texels of 16 bytes.
std::size_t file_bytes(const DdsTexels& texels, Extent extent) {
    if (!texels.fields) return level_bytes(texels.format, extent);
    return static_cast<std::size_t>(extent.texels()) * static_cast<std::size_t>(texels.fields->texel_bytes);
}

// The number of levels that the header asks for.
int wanted_levels(const Header& header, Extent extent, std::vector<std::string>& remarks) {
    const int most = level_count(extent);
    if (header.mip_map_count <= static_cast<std::uint32_t>(most)) {
        return std::max(1, static_cast<int>(header.mip_map_count));
    }
    remarks.push_back("the mip count is " + std::to_string(header.mip_map_count) + ", a complete chain has " +
                      std::to_string(most));
    return most;
}

}  // namespace

FileLayout dds_layout(const TextureHead& head, const WriteOptions& options) {
    std::optional<DdsPixelFormat> legacy = legacy_pixel_format(head);
    const std::uint32_t dxgi = format_row(widened(head.format)).dxgi.exact;
    const bool dx10 = !legacy || (options.dds_header == DdsHeader::dx10 && dxgi != 0);
    DdsPixelFormat pixel_format = dx10 ? DdsPixelFormat{kDdpfFourCc, fourcc("DX10"), 0, {}} : *legacy;
    if (options.dds_mark) {
        pixel_format.flags |= kDdpfNormal;
        if (!dx10 && head.format == Format::bc3_unorm && is_dxt5nm(head.swizzle)) {
            pixel_format.bit_count = fourcc("A2D5");
        }
    }

    FileLayout layout;
    if (widened(head.format) != head.format) layout.rearrange = Rearrange::widen;
    if ((pixel_format.flags & kDdpfRgb) != 0) layout.rearrange = Rearrange::bgr;
    const bool mips = head.levels > 1;
    const bool block = format_info(head.format).has_blocks();

    ByteWriter writer;
    writer.text(kDdsMagic);
    writer.u32(kHeaderBytes);
    writer.u32(kDdsdCaps | kDdsdHeight | kDdsdWidth | kDdsdPixelFormat | kDdsdMipMapCount |
               (block ? kDdsdLinearSize : kDdsdPitch));
    writer.u32(static_cast<std::uint32_t>(head.extent.height));
    writer.u32(static_cast<std::uint32_t>(head.extent.width));
    writer.u32(pitch_or_size(head, layout.rearrange));
    writer.u32(0);  // depth
    writer.u32(static_cast<std::uint32_t>(head.levels));
    write_reserved(writer, head);
    writer.u32(kPixelFormatBytes);
    writer.u32(pixel_format.flags);
    writer.u32(pixel_format.four_cc);
    writer.u32(pixel_format.bit_count);
    for (const std::uint32_t mask : pixel_format.masks) writer.u32(mask);
    writer.u32(kCapsTexture | (mips ? kCapsComplex | kCapsMipMap : 0));
    writer.zeros(4 * sizeof(std::uint32_t));  // caps2 to caps4, reserved
    if (dx10) {
        const Component alpha = head.swizzle[3];
        const bool custom = alpha == Component::x || alpha == Component::y || alpha == Component::z;
        writer.u32(dxgi);
        writer.u32(kDimensionTexture2d);
        writer.u32(0);  // misc
        writer.u32(1);  // array size
        writer.u32(custom ? kAlphaModeCustom : 0);
    }

    layout.size = writer.size();
    layout.head = writer.take();
    for (int k = 0; k < head.levels; ++k) {
        const std::size_t bytes = stored_level_bytes(head.format, level_extent(head.extent, k), layout.rearrange);
        layout.levels.push_back({layout.size, bytes});
        layout.size += bytes;
    }
    return layout;
}

Result<StoredTexture> parse_dds(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                const ReadOptions& options) {
    const Result<std::vector<std::byte>> head = fetch(0, std::min(size, kMagicBytes + kHeaderBytes + kDx10Bytes));
    if (!head) return head.error();
    Result<Header> header = parse_header(head->data(), size, name);
    if (!header) return header.error();
    const Result<LayerCount> count = count_layers(*header, name);
    if (!count) return count.error();
    const Result<Extent> extent = claimed_extent(name, header->width, header->height, options);
    if (!extent) return extent.error();
    Result<DdsTexels> texels = header->has_dx10 ? texels_of_dxgi(header->dxgi) : texels_of(header->pixel_format);
    if (!texels) return texels.error().of(name);

    StoredTexture stored;
    stored.fields = texels->fields;
    Texture& texture = stored.head;
    texture.format = texels->format;
    texture.swizzle = texels->swizzle;
    texture.swizzle_known = texels->swizzle_known;
    texture.order_open = texels->order_open && !header->writes_x_first;
    texture.srgb = texels->srgb;
    texture.remarks = std::move(header->remarks);
    texture.remarks.insert(texture.remarks.end(), texels->remarks.begin(), texels->remarks.end());

    apply_found_mark(header->mark, texture);

    const Result<std::uint64_t> layer = chosen_layer(*count, name, options);
    if (!layer) return layer.error();
    const int wanted = wanted_levels(*header, *extent, texture.remarks);
    std::size_t left = size - header->end;
    if (count->layers > 1) {  // each with all its levels
        std::size_t chain = 0;
        for (int k = 0; k < wanted; ++k) chain += file_bytes(*texels, level_extent(*extent, k));
        if (left / chain <= *layer)
            return bad_data(name, "truncated: the file ends before layer " + std::to_string(*layer) + " is complete");
        left -= chain * static_cast<std::size_t>(*layer);
        const std::uint64_t after = std::min<std::uint64_t>(count->layers - 1 - *layer, left / chain - 1);
        size -= chain * static_cast<std::size_t>(after);  // as if the file ended with this layer
        left -= chain * static_cast<std::size_t>(after);
    }
    for (int k = 0; k < wanted; ++k) {
        const Extent level = level_extent(*extent, k);
        const std::size_t bytes = file_bytes(*texels, level);
        if (bytes > left) {
            if (k == 0) {
                return bad_data(name, "truncated: the base level wants " + std::to_string(bytes) + " bytes, " +
                                          std::to_string(left) + " are left");
            }
            texture.remarks.push_back("the mip count is " + std::to_string(header->mip_map_count) +
                                      ", the data end after " + std::to_string(k));
            left = 0;
            break;
        }
        stored.levels.push_back({level, size - left});
        left -= bytes;
    }
    texture.trailing_bytes = left;
    return stored;
}

}  // namespace tex::inline v1
