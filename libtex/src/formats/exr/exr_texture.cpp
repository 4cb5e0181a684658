// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_texture.h"

#include <algorithm>
#include <optional>

#include <ImfStringAttribute.h>

#include <tex/types.h>

#include "formats/channels.h"
#include "rows/channel_names.h"

namespace tex::inline v1 {
namespace {

// The channels of a texture. A part with one channel needs no name that says what it holds, nor does alpha beside it.
Result<std::vector<ExrChannel>> texture_channels(const std::string& path, const std::vector<ExrChannel>& all,
                                                 std::vector<std::string>& remarks) {
    const std::vector<std::string> names = names_of(all);
    const Result<NormalChannels> normals = normal_channels(names);
    if (!normals) return normals.error().of(path);
    if (!normals->remark.empty()) remarks.push_back(normals->remark);
    std::vector<ExrChannel> channels;
    for (const std::size_t k : normals->channels) channels.push_back(all[k]);
    if (!channels.empty()) return channels;
    const auto others = std::count_if(names.begin(), names.end(), [](const auto& name) { return !is_alpha(name); });
    if (names.size() == 1 || (names.size() == 2 && others == 1)) return all;
    return Error{ErrorCode::unsupported, path,
                 "no channels are called R, G, B or X, Y, Z; its channels are " + list_of_names(names)};
}

void describe_mark(const Imf::Header& header, Texture& texture) {
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

Result<ExrTexture> exr_texture_of(const std::string& path, const Imf::Header& header, Extent base,
                                  const std::vector<ExrChannel>& all) {
    ExrTexture texture;
    Result<std::vector<ExrChannel>> channels = texture_channels(path, all, texture.head.remarks);
    if (!channels) return std::move(channels).error();
    const bool half = std::all_of(channels->begin(), channels->end(),
                                  [](const ExrChannel& channel) { return channel.type == Imf::HALF; });
    texture.head.format = *format_of(SampleKind::floating, half ? 16 : 32, static_cast<int>(channels->size()));
    describe_mark(header, texture.head);
    texture.levels = usable_levels(header, base, texture.head.remarks);
    texture.channels = std::move(*channels);
    return texture;
}

}  // namespace tex::inline v1
