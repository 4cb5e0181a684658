// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/ktx2.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numeric>
#include <optional>
#include <string_view>

#include <tex/types.h>

#include "formats/bytes.h"
#include "formats/channels.h"
#include "formats/ktx2/basis_levels.h"
#include "formats/ktx2/basis_texels.h"
#include "formats/ktx2/key_values.h"
#include "formats/ktx2/ktx2_descriptor.h"
#include "formats/ktx2/level_inflater.h"
#include "formats/ktx2/read_descriptor.h"
#include "formats/ktx2/unclaimed_bytes.h"
#include "formats/layers.h"
#include "formats/normal_mark.h"
#include "formats/size_limits.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kHeaderBytes = 80;      // identifier, header and index
constexpr std::size_t kLevelIndexBytes = 24;  // for each level

// Other VkFormats that can be read. Texels with `bgr` store blue first.
struct VkRow {
    std::uint32_t vk;
    Format format;
    bool srgb;
    bool bgr;
};

constexpr VkRow kVkFormats[] = {
    {30, Format::rgb8_unorm, false, true},  {36, Format::rgb8_unorm, true, true},
    {44, Format::rgba8_unorm, false, true}, {50, Format::rgba8_unorm, true, true},
    {131, Format::bc1_unorm, false, false}, {132, Format::bc1_unorm, true, false},
};

std::optional<VkRow> find_vk_format(std::uint32_t vk) {
    if (const auto marked = find_format(&FormatRow::vk, vk)) return VkRow{vk, marked->format, marked->srgb, false};
    for (const VkRow& row : kVkFormats) {
        if (row.vk == vk) return row;
    }
    return std::nullopt;
}

Error bad_data(const std::string& name, std::string reason) { return {ErrorCode::bad_data, name, std::move(reason)}; }

Error unsupported(const std::string& name, std::string reason) {
    return {ErrorCode::unsupported, name, std::move(reason)};
}

// -- writing -------------------------------------------------------------------------------------------------

void write_entry(ByteWriter& writer, std::string_view key, std::string_view value) {
    writer.u32(static_cast<std::uint32_t>(key.size() + value.size() + 2));
    writer.text(key);
    writer.u8(0);
    writer.text(value);
    writer.u8(0);
    writer.align(4);
}

// Keys in the order of their code points, as the specification requires.
std::vector<std::byte> key_values(const TextureHead& head) {
    ByteWriter writer;
    write_entry(writer, "KTXorientation", "rd");
    write_entry(writer, "KTXwriter", "libtex");
    if (const std::string mark = normal_mark(head); !mark.empty()) write_entry(writer, kNormalKey, mark);
    return writer.take();
}

std::size_t round_up(std::size_t value, std::size_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

// -- reading -------------------------------------------------------------------------------------------------

struct Ktx2Header {
    std::uint32_t vk_format, width, height, depth, layers, faces, levels, supercompression;
    std::uint32_t descriptor_offset, descriptor_bytes, key_values_offset, key_values_bytes;
    std::uint64_t global_offset, global_bytes;  // of the data that levels share under supercompression
};

constexpr std::uint32_t kFaces = 6;

// The schemes that can be read (KTX 2.0, 3.2).
std::optional<Supercompression> find_scheme(std::uint32_t scheme) {
    switch (scheme) {
        case 0: return Supercompression::none;
        case 1: return Supercompression::basis_lz;
        case 2: return Supercompression::zstd;
        case 3: return Supercompression::zlib;
        default: return std::nullopt;
    }
}

Ktx2Header parse_header(const std::byte* data) {
    const auto field = [&](std::size_t offset) { return load_u32(data + offset); };
    return {field(12), field(20), field(24), field(28), field(32), field(36),           field(40),
            field(44), field(48), field(52), field(56), field(60), load_u64(data + 64), load_u64(data + 72)};
}

Result<Extent> check_header(const Ktx2Header& header, const std::string& name, const ReadOptions& options) {
    if (!find_scheme(header.supercompression)) return unknown_scheme(header.supercompression).of(name);
    if (header.faces != 1 && header.faces != kFaces) return bad_data(name, std::to_string(header.faces) + " faces");
    if (header.depth > 1) return unsupported(name, "volume textures are not supported");
    if (header.height == 0) return unsupported(name, "one-dimensional textures are not supported");
    return claimed_extent(name, header.width, header.height, options);
}

// What the descriptor says about the format that the VkFormat names. Errors: bad_data.
Result<void> apply_descriptor(const Ktx2Descriptor& descriptor, std::uint32_t vk, Texture& texture) {
    if (Result<void> agrees = check_descriptor(descriptor, vk, texture.format); !agrees) return agrees;
    const std::string vk_text = "VkFormat " + std::to_string(vk);
    if (descriptor.states_srgb() && !texture.srgb)
        texture.remarks.push_back("the data format descriptor says sRGB, but " + vk_text + " does not");
    if (descriptor.states_linear() && texture.srgb)
        texture.remarks.push_back(vk_text + " says sRGB, but the data format descriptor says linear");
    texture.srgb = texture.srgb || descriptor.states_srgb();
    return {};
}

// What the texels are: those of the VkFormat, or of Basis Universal. Errors: bad_data, unsupported.
Result<void> describe_texels(const std::optional<VkRow>& row, const std::optional<Ktx2Descriptor>& descriptor,
                             StoredTexture& stored) {
    Texture& texture = stored.head;
    texture.x_in_grey = true;
    if (!row) {
        const Result<BasisTexels> texels = basis_texels(descriptor, stored.supercompression);
        if (!texels) return texels.error();
        texture.format = texels->format;
        texture.swizzle = texels->swizzle;
        texture.swizzle_known = texels->swizzle_known;
        texture.srgb = descriptor->states_srgb();
        return {};
    }
    if (stored.supercompression == Supercompression::basis_lz)
        return Error{ErrorCode::bad_data, {}, "BasisLZ holds no texels of VkFormat " + std::to_string(row->vk)};
    stored.bgr = row->bgr;
    texture.format = row->format;
    texture.swizzle = likely_swizzle(row->format);
    texture.srgb = row->srgb;
    return descriptor ? apply_descriptor(*descriptor, row->vk, texture) : Result<void>();
}

// KTXswizzle names the stored channel that a shader reads as R, G, B and A: "ag01" means that A holds x and G holds y.
bool apply_ktx_swizzle(std::string_view value, Texture& texture) {
    constexpr std::string_view kChannels = "rgba";
    if (value.size() != 4) return false;
    const std::size_t x = kChannels.find(value[0]);
    const std::size_t y = kChannels.find(value[1]);
    const std::size_t z = kChannels.find(value[2]);
    if (x == std::string_view::npos || y == std::string_view::npos || x == y) return false;
    Swizzle swizzle = {Component::other, Component::other, Component::other, Component::other};
    swizzle[x] = Component::x;
    swizzle[y] = Component::y;
    if (z != std::string_view::npos && z != x && z != y) swizzle[z] = Component::z;
    texture.swizzle = swizzle;
    texture.swizzle_known = true;
    return true;
}

// Applies the key/value data. Returns true if rows run upwards. Errors: those of `fetch`.
Result<bool> apply_key_values(const FetchBytes& fetch, std::size_t size, const Ktx2Header& header, Texture& texture) {
    if (header.key_values_bytes == 0) return false;
    const std::size_t offset = header.key_values_offset;
    std::vector<std::byte> bytes;  // the entries point into these bytes
    std::optional<std::vector<KeyValue>> entries;
    if (offset <= size && header.key_values_bytes <= size - offset) {
        Result<std::vector<std::byte>> fetched = fetch(offset, header.key_values_bytes);
        if (!fetched) return fetched.error();
        bytes = std::move(*fetched);
        entries = parse_key_values(bytes, false);
    }
    if (!entries) {
        texture.remarks.push_back("the key/value data are damaged and were not read");
        return false;
    }
    bool upwards = false;
    bool own = false;
    for (const KeyValue& entry : *entries) {
        if (entry.key == "KTXorientation" && entry.value.size() >= 2) upwards = entry.value[1] == 'u';
        if (entry.key == "KTXswizzle" && entry.value != "rgba" && !own && !apply_ktx_swizzle(entry.value, texture)) {
            texture.remarks.push_back("KTXswizzle was not understood");
        }
        if (entry.key == kNormalKey) {
            own = apply_found_mark(entry.value, texture);
        }
    }
    return upwards;
}

// The layers of a level follow each other.
struct LayerChoice {
    std::uint64_t layers, chosen;
};

// The place of the chosen layer of level k, from the level's entry in the level index.
Result<StoredTexture::Level> place_of(const std::byte* entry, std::size_t size, std::size_t k, LayerChoice layer,
                                      const StoredTexture& texture, Extent extent, const std::string& name) {
    const bool is_compressed = texture.supercompression != Supercompression::none;
    const std::uint64_t offset = load_u64(entry);
    const std::uint64_t bytes = load_u64(entry + 8);
    const std::uint64_t decoded = is_compressed ? load_u64(entry + 16) : bytes;
    const std::size_t wanted = level_bytes(texture.head.format, extent);
    const std::string level_text = "level " + std::to_string(k);
    if (decoded % layer.layers != 0 || decoded / layer.layers != wanted) {
        const std::string layers = layer.layers > 1 ? std::to_string(layer.layers) + " times " : "";
        return bad_data(name, level_text + " has " + std::to_string(decoded) + " bytes instead of " + layers +
                                  std::to_string(wanted));
    }
    if (offset > size || bytes > size - offset) {
        return bad_data(name, "truncated: " + level_text + " ends beyond the end of the file");
    }
    const std::uint64_t before = layer.chosen * wanted;
    if (!is_compressed) return StoredTexture::Level{extent, offset + before, wanted};
    const Result<void> fits = check_claim(name, extent, static_cast<double>(decoded), static_cast<std::int64_t>(bytes),
                                          most_inflation(texture.supercompression));
    if (!fits) return fits.error();
    return StoredTexture::Level{extent, offset, bytes, decoded, before};
}

// Without supercompression, a level has one size, which its entry in the level index states twice.
void remark_on_sizes(const std::vector<std::byte>& index, std::size_t levels, Texture& texture) {
    for (std::size_t k = 0; k < levels; ++k) {
        const std::uint64_t bytes = load_u64(index.data() + k * kLevelIndexBytes + 8);
        const std::uint64_t uncompressed = load_u64(index.data() + k * kLevelIndexBytes + 16);
        if (bytes == uncompressed) continue;
        texture.remarks.push_back("level " + std::to_string(k) + " claims " + std::to_string(uncompressed) +
                                  " bytes when uncompressed; without supercompression, it has " +
                                  std::to_string(bytes));
        return;
    }
}

// What the header does not name: more levels than it counts, an appended file. A remark speaks of a descriptor that was
// not found, which is before the key/value data.
Result<std::uint64_t> unread_bytes(const FetchBytes& fetch, std::size_t size, const Ktx2Header& header,
                                   const std::vector<std::byte>& index, bool has_descriptor) {
    std::vector<ClaimedBytes> claimed = {{0, kHeaderBytes + index.size()},
                                         {0, has_descriptor ? 0 : header.key_values_offset},
                                         {header.descriptor_offset, header.descriptor_bytes},
                                         {header.key_values_offset, header.key_values_bytes},
                                         {header.global_offset, header.global_bytes}};
    for (std::size_t at = 0; at < index.size(); at += kLevelIndexBytes)
        claimed.push_back({load_u64(index.data() + at), load_u64(index.data() + at + 8)});
    return unclaimed_bytes(fetch, size, std::move(claimed));
}

}  // namespace

FileLayout ktx2_layout(const TextureHead& head) {
    const Format stored = widened(head.format);
    const FormatInfo info = format_info(stored);
    const auto level_total = static_cast<std::size_t>(head.levels);
    const std::vector<std::byte> descriptor = data_format_descriptor(stored, head.swizzle);
    const std::vector<std::byte> entries = key_values(head);
    const std::size_t descriptor_offset = kHeaderBytes + level_total * kLevelIndexBytes;
    const std::size_t entries_offset = descriptor_offset + descriptor.size();

    FileLayout layout;
    if (stored != head.format) layout.rearrange = Rearrange::widen;
    layout.levels.resize(level_total);
    layout.size = entries_offset + entries.size();
    const std::size_t alignment = std::lcm(info.block_bytes, std::size_t{4});
    for (std::size_t k = level_total; k-- > 0;) {
        layout.size = round_up(layout.size, alignment);
        layout.levels[k] = {layout.size, level_bytes(stored, level_extent(head.extent, static_cast<int>(k)))};
        layout.size += layout.levels[k].bytes;
    }

    ByteWriter writer;
    writer.text(kKtx2Magic);
    writer.u32(format_row(stored).vk.exact);
    writer.u32(info.has_blocks() ? 1 : static_cast<std::uint32_t>(info.bits / 8));  // bytes of one value
    writer.u32(static_cast<std::uint32_t>(head.extent.width));
    writer.u32(static_cast<std::uint32_t>(head.extent.height));
    writer.u32(0);  // depth
    writer.u32(0);  // layers
    writer.u32(1);  // faces
    writer.u32(static_cast<std::uint32_t>(head.levels));
    writer.u32(0);  // no supercompression
    writer.u32(static_cast<std::uint32_t>(descriptor_offset));
    writer.u32(static_cast<std::uint32_t>(descriptor.size()));
    writer.u32(static_cast<std::uint32_t>(entries_offset));
    writer.u32(static_cast<std::uint32_t>(entries.size()));
    writer.u64(0);  // supercompression global data
    writer.u64(0);
    for (const FileLayout::Level& place : layout.levels) {
        writer.u64(place.offset);
        writer.u64(place.bytes);
        writer.u64(place.bytes);  // uncompressed
    }
    layout.head = writer.take();
    layout.head.insert(layout.head.end(), descriptor.begin(), descriptor.end());
    layout.head.insert(layout.head.end(), entries.begin(), entries.end());
    return layout;
}

Result<StoredTexture> parse_ktx2(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                 const ReadOptions& options) {
    if (size < kHeaderBytes) return bad_data(name, "truncated: the KTX2 header is not complete");
    const Result<std::vector<std::byte>> head = fetch(0, kHeaderBytes);
    if (!head) return head.error();
    const Ktx2Header header = parse_header(head->data());
    const Result<Extent> extent = check_header(header, name, options);
    if (!extent) return extent.error();
    const bool is_cube = header.faces == kFaces;
    const LayerCount count{std::uint64_t{std::max<std::uint32_t>(header.layers, 1)} * header.faces, is_cube};
    const std::optional<VkRow> row = find_vk_format(header.vk_format);
    if (!row && header.vk_format != 0) return unknown_vk_format(header.vk_format).of(name);
    StoredTexture stored;
    stored.supercompression = *find_scheme(header.supercompression);
    Texture& texture = stored.head;
    texture.zlib = stored.supercompression == Supercompression::zlib;
    const Result<std::optional<Ktx2Descriptor>> descriptor =
        read_descriptor(fetch, size, header.descriptor_offset, header.descriptor_bytes, texture.remarks);
    if (!descriptor) return descriptor.error();
    if (const Result<void> described = describe_texels(row, *descriptor, stored); !described)
        return described.error().of(name);
    const Result<std::uint64_t> layer = chosen_layer(count, name, options);
    if (!layer) return layer.error();
    const auto levels = std::max<std::uint32_t>(1, header.levels);  // 0: the reader generates the other levels
    if (levels > static_cast<std::uint32_t>(level_count(*extent))) {
        return bad_data(
            name, std::to_string(levels) + " levels, a complete chain has " + std::to_string(level_count(*extent)));
    }
    if (size < kHeaderBytes + levels * kLevelIndexBytes) {
        return bad_data(name, "truncated: the level index is not complete");
    }

    const Result<std::vector<std::byte>> index = fetch(kHeaderBytes, levels * kLevelIndexBytes);
    if (!index) return index.error();

    const Result<bool> upwards = apply_key_values(fetch, size, header, texture);
    if (!upwards) return upwards.error();
    stored.upwards = *upwards;
    if (stored.upwards && format_info(texture.format).has_blocks()) {
        return unsupported(name, "blocks whose rows run upwards (KTXorientation) are not supported");
    }
    const ClaimedBytes global = {header.global_offset, header.global_bytes};
    if (stored.supercompression == Supercompression::basis_lz) {
        Result<std::shared_ptr<const BasisCodebooks>> books =
            read_basis_global(fetch, size, global, std::uint64_t{levels} * count.layers);
        if (!books) return books.error().of(name);
        stored.codebooks = std::move(*books);
    }
    for (std::size_t k = 0; k < levels; ++k) {
        const std::byte* const entry = index->data() + k * kLevelIndexBytes;
        const Extent of_level = level_extent(*extent, static_cast<int>(k));
        const Result<StoredTexture::Level> place =
            stored.codebooks != nullptr ? basis_level(fetch, size, global, k * count.layers + *layer,
                                                      {load_u64(entry), load_u64(entry + 8)}, of_level, texture.format)
                                        : place_of(entry, size, k, {count.layers, *layer}, stored, of_level, name);
        if (!place) return place.error().of(name);
        stored.levels.push_back(*place);
    }
    if (stored.supercompression == Supercompression::none) remark_on_sizes(*index, levels, texture);
    const Result<std::uint64_t> unread = unread_bytes(fetch, size, header, *index, descriptor->has_value());
    if (!unread) return unread.error();
    texture.trailing_bytes = *unread;
    return stored;
}

}  // namespace tex::inline v1
