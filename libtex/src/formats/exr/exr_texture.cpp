// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_texture.h"

#include <algorithm>
#include <optional>

#include <ImfChannelList.h>
#include <ImfStringAttribute.h>

#include <tex/mip_chain.h>

#include "formats/channels.h"

namespace tex {
namespace {

// The channels of a texture: R, G, B (and A) if they are present, otherwise all channels.
Result<std::vector<ExrChannel>> texture_channels(const std::string& path, const Imf::Header& header) {
    std::vector<ExrChannel> channels = channels_of(header);
    const Imf::ChannelList& list = header.channels();
    if (list.findChannel("R") && list.findChannel("G") && list.findChannel("B")) {
        channels.resize(list.findChannel("A") ? 4 : 3);
    } else if (channels.empty() || channels.size() > 4) {
        return Error{ErrorCode::unsupported, path,
                     std::to_string(channels.size()) + " channels, and not R, G and B among them"};
    }
    return channels;
}

void describe_normals(const Imf::Header& header, Texture& texture) {
    texture.swizzle = likely_swizzle(texture.format);
    if (const auto* text = header.findTypedAttribute<Imf::StringAttribute>(kNormalEncoding)) {
        texture.normal_encoding = text->value();
        texture.swizzle_known = format_info(texture.format).channels >= 2;
    }
    if (const auto* text = header.findTypedAttribute<Imf::StringAttribute>(kNormalYAxis)) {
        if (const std::optional<YAxis> axis = find_by_name(kYAxisNames, text->value())) {
            texture.y_axis = *axis;
            texture.y_known = true;
        }
    }
}

// The number of levels of a part that follow the rule of level_extent().
int usable_levels(const Imf::Header& header, Extent base, std::vector<std::string>& remarks) {
    const std::optional<Imf::TileDescription> tiles = tiles_of(header);
    if (!tiles || tiles->mode == Imf::ONE_LEVEL) return 1;
    if (tiles->mode == Imf::MIPMAP_LEVELS) {
        const auto power = [](int n) { return (n & (n - 1)) == 0; };
        if (tiles->roundingMode == Imf::ROUND_DOWN || (power(base.width) && power(base.height)))
            return level_count(base);
        remarks.emplace_back("mip levels with extents rounded up are left out");
    } else {
        remarks.emplace_back("ripmap levels are left out");
    }
    return 1;
}

}  // namespace

Result<ExrTexture> exr_texture_of(const std::string& path, const Imf::Header& header, Extent base) {
    Result<std::vector<ExrChannel>> channels = texture_channels(path, header);
    if (!channels) return std::move(channels).error();
    ExrTexture texture;
    const bool half = std::all_of(channels->begin(), channels->end(),
                                  [](const ExrChannel& channel) { return channel.type == Imf::HALF; });
    texture.head.format = *format_of(SampleKind::floating, half ? 16 : 32, static_cast<int>(channels->size()));
    describe_normals(header, texture.head);
    texture.levels = usable_levels(header, base, texture.head.remarks);
    texture.channels = std::move(*channels);
    return texture;
}

}  // namespace tex
