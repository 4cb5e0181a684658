// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/read_descriptor.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "formats/bytes.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr std::uint32_t kFirstBlockModel = 128;  // models below are of single texels

struct KhrModel {
    std::uint32_t number;
    std::string_view name;
};

// From khr_df.h.
constexpr KhrModel kKhrModels[] = {
    {kKhrBc1, "BC1"},          {kKhrBc2, "BC2"}, {kKhrBc3, "BC3"},     {kKhrBc4, "BC4"},     {kKhrBc5, "BC5"},
    {kKhrBc6h, "BC6H"},        {kKhrBc7, "BC7"}, {160, "ETC1"},        {kKhrEtc1s, "ETC1S"}, {164, "PVRTC"},
    {kKhrEtc2, "ETC2 or EAC"}, {165, "PVRTC2"},  {kKhrUastc, "UASTC"}, {kKhrAstc, "ASTC"},
};

std::string edges_text(const std::array<int, 4>& edges) {
    std::string text = std::to_string(edges[0]) + "x" + std::to_string(edges[1]);
    for (std::size_t k = 2; k < 4 && (edges[2] > 1 || edges[3] > 1); ++k) text += "x" + std::to_string(edges[k]);
    return text;
}

bool same_model(std::uint32_t stated, Format format) {
    if (stated == 0) return true;
    return format_info(format).has_blocks() ? stated == format_row(format).codec->khr_model : stated < kFirstBlockModel;
}

// Texel blocks without edges are those of the model. ASTC has blocks of many extents, and VkFormat tells which.
bool same_edges(const std::array<int, 4>& stated, Format format) {
    constexpr std::array<int, 4> kTexel = {1, 1, 1, 1};
    const Extent block = format_info(format).block;
    return stated == kTexel || stated == std::array<int, 4>{block.width, block.height, 1, 1};
}

}  // namespace

std::string khr_model_text(std::uint32_t model) {
    if (model == kKhrRgbsda) return "texels without compression";
    for (const KhrModel& row : kKhrModels) {
        if (row.number == model) return std::string(row.name);
    }
    return "colour model " + std::to_string(model);
}

Result<std::optional<Ktx2Descriptor>> read_descriptor(const FetchBytes& fetch, std::size_t size, std::uint32_t offset,
                                                      std::uint32_t bytes, std::vector<std::string>& remarks) {
    constexpr std::size_t kVendor = 4, kModel = 12, kTransfer = 14, kEdges = 16, kBlockBytes = 20, kSamples = 28,
                          kFirstChannel = 31, kSampleBytes = 16, kWithSamples = 60;
    if (bytes == 0) {
        remarks.emplace_back("there is no data format descriptor");
        return std::optional<Ktx2Descriptor>();
    }
    std::vector<std::byte> data;
    if (bytes >= kSamples && offset <= size && bytes <= size - offset) {
        Result<std::vector<std::byte>> fetched = fetch(offset, std::min<std::size_t>(bytes, kWithSamples));
        if (!fetched) return fetched.error();
        data = std::move(*fetched);
    }
    if (data.empty() || load_u32(data.data()) != bytes || load_u32(data.data() + kVendor) != 0) {
        remarks.emplace_back("the data format descriptor is damaged and was not read");
        return std::optional<Ktx2Descriptor>();
    }
    const auto number = [&](std::size_t at) { return std::to_integer<std::uint32_t>(data[at]); };
    Ktx2Descriptor descriptor;
    descriptor.model = number(kModel);
    descriptor.transfer = number(kTransfer);
    for (std::size_t k = 0; k < 4; ++k) descriptor.edges[k] = static_cast<int>(number(kEdges + k)) + 1;
    descriptor.block_bytes = number(kBlockBytes);
    for (std::size_t k = 0; k < 2 && data.size() >= kSamples + (k + 1) * kSampleBytes; ++k)
        descriptor.channels[k] = number(kFirstChannel + k * kSampleBytes) & 15u;
    return std::optional(descriptor);
}

Result<void> check_descriptor(const Ktx2Descriptor& descriptor, std::uint32_t vk, Format format) {
    const FormatInfo info = format_info(format);
    const std::string unit = info.has_blocks() ? "block" : "texel";
    std::string stated, wanted;
    if (!same_model(descriptor.model, format)) {
        stated = khr_model_text(descriptor.model);
    } else if (!same_edges(descriptor.edges, format)) {
        stated = "blocks of " + edges_text(descriptor.edges) + " texels";
    } else if (descriptor.block_bytes != 0 && descriptor.block_bytes != info.block_bytes) {
        stated = std::to_string(descriptor.block_bytes) + " bytes for each " + unit;
        wanted = ", with " + std::to_string(info.block_bytes);
    } else {
        return {};
    }
    return Error{ErrorCode::bad_data,
                 {},
                 "its data format descriptor says " + stated + ", but VkFormat " + std::to_string(vk) + " is " +
                     std::string(name_of(kFormatNames, format)) + wanted + "; export the texture again"};
}

}  // namespace tex::inline v1
