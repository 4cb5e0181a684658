// SPDX-License-Identifier: Apache-2.0

#include "rows/height_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "kernels/height_field.h"
#include "rows/color.h"

namespace tex {
namespace {

constexpr std::string_view kTheFirst = ", the first at column ";  // the first invalid height

// The greatest HeightOptions::blur_sigma.
constexpr float kMaxBlurSigma = 256.0f;

constexpr int kNoPlane = -1;

using Names = std::vector<std::string>;

int find(const Names& names, std::string_view name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? kNoPlane : static_cast<int>(at - names.begin());
}

bool same_word(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char p, char q) { return lower(p) == lower(q); });
}

// The plane that holds the heights of a picture without colour; kNoPlane if that is ambiguous.
int grey_plane(const Names& names) {
    std::vector<int> planes;
    for (int k = 0; k < static_cast<int>(names.size()); ++k) {
        if (names[static_cast<std::size_t>(k)] != "A") planes.push_back(k);
    }
    if (names.size() == 1) return 0;
    if (planes.size() == 1) return planes.front();
    for (const std::string_view word : {"Y", "height", "displacement", "Z", "depth"}) {
        for (const int k : planes) {
            if (same_word(names[static_cast<std::size_t>(k)], word)) return k;
        }
    }
    return kNoPlane;
}

std::string list_of_channels(const Names& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

Error no_such_channel(const Names& names, HeightChannel channel) {
    std::string reason =
        channel == HeightChannel::automatic
            ? "which channel holds the height is not clear"
            : "the picture has no channel for \"" + std::string(name_of(kHeightChannelNames, channel)) + "\"";
    return {ErrorCode::bad_option, {}, reason + "; its channels are " + list_of_channels(names)};
}

// Writes row j of the heights before any further processing. Returns the number of texels for which `automatic` took
// luma.
std::int64_t take_row(const Image& image, const HeightSource& source, int j, float* out) {
    const auto row = [&](int plane) { return image.planes[static_cast<std::size_t>(plane)].row(j); };
    const int count = image.extent().width;
    if (source.plane != kNoPlane) {
        std::copy_n(row(source.plane), count, out);
        return 0;
    }
    const ColorRow colors{row(source.red), row(source.green), row(source.blue)};
    switch (source.mixture) {
        case HeightChannel::luma: luma_row(colors, count, out); break;
        case HeightChannel::average: average_row(colors, count, out); break;
        case HeightChannel::max: max_row(colors, count, out); break;
        default: return automatic_row(colors, count, out);
    }
    return 0;
}

}  // namespace

Result<HeightSource> find_height_source(const Names& names, HeightChannel channel) {
    HeightSource source{channel, kNoPlane, find(names, "R"), find(names, "G"), find(names, "B")};
    const bool colour = source.red >= 0 && source.green >= 0 && source.blue >= 0;
    const int grey = colour ? kNoPlane : grey_plane(names);
    const auto named = [&](const char* name) { return find(names, name) >= 0 ? find(names, name) : grey; };
    switch (channel) {
        case HeightChannel::r: source.plane = named("R"); break;
        case HeightChannel::g: source.plane = named("G"); break;
        case HeightChannel::b: source.plane = named("B"); break;
        case HeightChannel::a: source.plane = find(names, "A"); break;
        case HeightChannel::y: source.plane = named("Y"); break;
        case HeightChannel::automatic:
        case HeightChannel::luma:
        case HeightChannel::average:
        case HeightChannel::max:
            if (colour) return source;
            source.plane = grey;
            break;
    }
    if (source.plane == kNoPlane) return no_such_channel(names, channel);
    return source;
}

std::optional<Error> check_blur(const HeightOptions& options) {
    if (options.blur_sigma >= 0.0f && options.blur_sigma <= kMaxBlurSigma) return std::nullopt;
    return Error{ErrorCode::bad_option, {}, "the blur's sigma must be from 0 to 256 texels"};
}

Result<HeightOptions> with_no_data(const HeightOptions& options, std::optional<float> no_data,
                                   const std::vector<std::string>& names, const HeightSource& source,
                                   const LinearRows* linear) {
    HeightOptions with = options;
    if (options.no_data || !no_data) return with;
    // A texel whose channels all have that value.
    Image texel;
    texel.names = names;
    for (std::size_t k = 0; k < names.size(); ++k) texel.planes.emplace_back(Extent{1, 1}, *no_data);
    if (linear != nullptr) {
        if (const Result<void> converted = linear->convert(texel, 1); !converted) return converted.error();
    }
    Plane<float> height(Extent{1, 1});
    take_row(texel, source, 0, height.row(0));
    with.no_data = height.at(0, 0);
    return with;
}

HeightCounts take_heights(const Image& image, const HeightSource& source, const HeightOptions& options, int j,
                          float* out) {
    const float no_data = options.no_data.value_or(std::numeric_limits<float>::quiet_NaN());
    HeightCounts counts;
    counts.luma = take_row(image, source, j, out);
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
                std::string(kTheFirst) + std::to_string(column) + ", row " + std::to_string(row)};
}

bool is_fillable(const Error& error) {
    return error.code == ErrorCode::bad_data && error.reason.find(kTheFirst) != std::string::npos;
}

}  // namespace tex
