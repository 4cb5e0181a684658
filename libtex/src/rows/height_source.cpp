// SPDX-License-Identifier: Apache-2.0

#include "rows/height_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "kernels/height_field.h"
#include "rows/channel_names.h"
#include "rows/height_bytes.h"
#include "rows/linear_rows.h"

namespace tex::inline v1 {
namespace {

constexpr int kNoPlane = -1;

using Names = std::vector<std::string>;

// The plane that holds the heights beside colours and vectors; kNoPlane if that is ambiguous.
int grey_plane(const Names& names, const std::vector<ChannelGroup>& groups) {
    if (names.size() == 1) return 0;
    const auto is_grouped = [&](int k) {
        return std::any_of(groups.begin(), groups.end(), [&](const ChannelGroup& group) {
            const auto& channels = group.channels;
            return channels.size() >= 2 &&
                   std::find(channels.begin(), channels.end(), static_cast<std::size_t>(k)) != channels.end();
        });
    };
    std::vector<int> planes;
    for (int k = 0; k < static_cast<int>(names.size()); ++k) {
        if (!is_alpha(names[static_cast<std::size_t>(k)]) && !is_grouped(k)) planes.push_back(k);
    }
    if (planes.size() == 1) return planes.front();
    for (const std::string_view word : {"Y", "height", "displacement", "Z", "depth"}) {
        for (const int k : planes) {
            const std::string& name = names[static_cast<std::size_t>(k)];
            if (same_word(channel_word(name), word) || same_word(channel_word(layer_of(name)), word)) return k;
        }
    }
    return kNoPlane;
}

Error no_such_channel(const Names& names, std::string_view channel) {
    std::string reason = channel.empty() ? "which channel holds the height is not clear"
                                         : "the picture has no channel for \"" + std::string(channel) + "\"";
    return {ErrorCode::bad_option, {}, reason + "; its channels are " + list_of_names(names)};
}

Error not_in_bytes(HeightChannel channel) {
    return {ErrorCode::bad_option,
            {},
            "the picture has not the 8 bits that heights as \"" + std::string(name_of(kHeightChannelNames, channel)) +
                "\" have"};
}

// Writes row j of the heights before any further processing.
HeightCounts take_row(const Image& image, const HeightSource& source, bool heeds_alpha, int j, float* out) {
    const auto row = [&](int plane) { return image.planes[static_cast<std::size_t>(plane)].row(j); };
    const int count = image.extent().width;
    if (source.plane != kNoPlane) {
        std::copy_n(row(source.plane), count, out);
        return {};
    }
    const ColorRow colors{row(source.red), row(source.green), row(source.blue)};
    switch (source.mixture) {
        case HeightChannel::luma: luma_row(colors, count, out); break;
        case HeightChannel::average: average_row(colors, count, out); break;
        case HeightChannel::max: max_row(colors, count, out); break;
        case HeightChannel::terrain_rgb:
        case HeightChannel::terrarium:
        case HeightChannel::rg16:
        case HeightChannel::gr16:
            return height_bytes_row(colors, heeds_alpha && source.alpha != kNoPlane ? row(source.alpha) : nullptr,
                                    source.mixture, source.has_numbers, count, out);
        default: return {automatic_row(colors, count, out)};
    }
    return {};
}

// The value that the picture has where the file stores `number`. Where integers are read as fractions, only a number
// that is a code of their type counts as one; other numbers are fractions already.
float value_of(float number, const PictureFacts& facts) {
    const auto value = static_cast<double>(number);
    if (facts.stored) return static_cast<float>(value * facts.scale + facts.offset);
    if (facts.sample == SampleKind::floating || std::isnan(value)) return number;
    const bool is_signed = facts.sample == SampleKind::snorm;
    const auto greatest = static_cast<double>((std::uint64_t{1} << (facts.bits - (is_signed ? 1 : 0))) - 1);
    const double least = is_signed ? -greatest - 1.0 : 0.0;
    const bool is_fraction = value >= (is_signed ? -1.0 : 0.0) && value <= 1.0;
    if (is_fraction || value < least || value > greatest || value != std::floor(value)) return number;
    return static_cast<float>(std::max(value / greatest, -1.0));
}

}  // namespace

PictureFacts facts_of(const Image& image) {
    return {image.names, image.sample, image.bits, image.stored, image.scale, image.offset, image.no_data};
}

Result<HeightSource> find_height_source(const PictureFacts& facts, const HeightOptions& options) {
    const Names& names = facts.names;
    const HeightChannel channel = options.channel;
    HeightSource source{channel, kNoPlane};
    source.has_numbers = facts.stored;
    if (!options.channel_name.empty()) {
        const std::size_t found = find_channel(names, options.channel_name);
        if (found == names.size()) return no_such_channel(names, options.channel_name);
        source.plane = static_cast<int>(found);
        return source;
    }
    const std::vector<ChannelGroup> groups = channel_groups(names);
    const ChannelGroup* const colours = colour_group(groups);
    const bool hidden = colours != nullptr && colours->layer.empty();
    const int grey = hidden ? kNoPlane : grey_plane(names, groups);
    if (colours != nullptr) {
        source.red = static_cast<int>(colours->channels[0]);
        source.green = static_cast<int>(colours->channels[1]);
        source.blue = static_cast<int>(colours->channels[2]);
    }
    // The channel of this name, in the layer of the colours if there are any.
    const auto named = [&](const char* word, int otherwise) {
        const std::string layer = colours == nullptr || colours->layer.empty() ? "" : colours->layer + ".";
        const std::size_t found = find_channel(names, layer + word);
        return found < names.size() ? static_cast<int>(found) : otherwise;
    };
    const auto alpha = [&] {
        const auto found = std::find_if(names.begin(), names.end(), [](const auto& name) { return is_alpha(name); });
        if (const int plane = named("A", named("alpha", kNoPlane)); plane != kNoPlane) return plane;
        const auto count = std::count_if(names.begin(), names.end(), [](const auto& name) { return is_alpha(name); });
        return count == 1 ? static_cast<int>(found - names.begin()) : kNoPlane;
    };
    switch (channel) {
        case HeightChannel::r: source.plane = named("R", colours != nullptr ? source.red : grey); break;
        case HeightChannel::g: source.plane = named("G", colours != nullptr ? source.green : grey); break;
        case HeightChannel::b: source.plane = named("B", colours != nullptr ? source.blue : grey); break;
        case HeightChannel::a: source.plane = alpha(); break;
        case HeightChannel::y: source.plane = named("Y", grey); break;
        case HeightChannel::automatic:
            if (colours != nullptr && grey == kNoPlane) return source;
            source.plane = grey;
            break;
        case HeightChannel::luma:
        case HeightChannel::average:
        case HeightChannel::max:
            if (colours != nullptr) return source;
            source.plane = grey;
            break;
        case HeightChannel::terrain_rgb:
        case HeightChannel::terrarium:
        case HeightChannel::rg16:
        case HeightChannel::gr16:
            if (facts.bits != 8 && !facts.stored) return not_in_bytes(channel);
            if (channel == HeightChannel::terrain_rgb || channel == HeightChannel::terrarium) source.alpha = alpha();
            if (colours != nullptr) return source;
            break;
    }
    if (source.plane != kNoPlane) return source;
    const bool is_automatic = channel == HeightChannel::automatic;
    return no_such_channel(names, is_automatic ? std::string_view() : name_of(kHeightChannelNames, channel));
}

Result<HeightOptions> with_no_data(const HeightOptions& options, const PictureFacts& facts, const HeightSource& source,
                                   const LinearRows* linear) {
    HeightOptions with = options;
    if (options.no_data) {
        const bool is_made = source.plane == kNoPlane && source.mixture >= HeightChannel::terrain_rgb;
        if (!is_made) with.no_data = value_of(*options.no_data, facts);
        return with;
    }
    // Infinity, which is invalid anyway, says that heights may be missing although no value stands for them.
    if (source.alpha != kNoPlane || facts.is_masked) with.no_data = std::numeric_limits<float>::infinity();
    if (!facts.no_data) return with;
    // A texel whose channels all have that value.
    Image texel;
    texel.names = facts.names;
    for (std::size_t k = 0; k < facts.names.size(); ++k) texel.planes.emplace_back(Extent{1, 1}, *facts.no_data);
    if (linear != nullptr) {
        if (const Result<void> converted = linear->convert(texel, 1); !converted) return converted.error();
    }
    Plane<float> height(Extent{1, 1});
    take_row(texel, source, false, 0, height.row(0));
    with.no_data = height.at(0, 0);
    return with;
}

HeightCounts take_heights(const Image& image, const HeightSource& source, const HeightOptions& options, int j,
                          float* out) {
    const float no_data = options.no_data.value_or(std::numeric_limits<float>::quiet_NaN());
    const bool heeds_alpha = !options.no_data || !std::isnan(*options.no_data);
    HeightCounts counts = take_row(image, source, heeds_alpha, j, out);
    counts.invalid = clean_row(out, image.extent().width, no_data, options.invert);
    return counts;
}

Error invalid_heights(std::int64_t invalid, int column, int row, Extent extent, const HeightOptions& options) {
    const bool named = options.no_data && !std::isnan(*options.no_data);
    const std::string kinds = named ? "NaN, infinite or no-data" : "NaN or infinite";
    if (invalid == extent.texels()) return {ErrorCode::bad_data, {}, "no texel has a height: all are " + kinds};
    return {ErrorCode::bad_data,
            {},
            std::to_string(invalid) + (invalid == 1 ? " height is " : " heights are ") + kinds +
                ", the first at column " + std::to_string(column) + ", row " + std::to_string(row),
            ErrorDetail::missing_heights};
}

}  // namespace tex::inline v1
