// SPDX-License-Identifier: Apache-2.0
// Which plane is the height, what is wrong with it, and the order of the steps; kernels/height_field.cpp
// computes.

#include <tex/height_field.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/blur.h"
#include "base/guard.h"
#include "base/nearest.h"
#include "base/parallel.h"
#include "kernels/height_field.h"

namespace tex {
namespace {

// The greatest HeightOptions::blur_sigma.
constexpr float kMaxBlurSigma = 256.0f;

constexpr int kNoPlane = -1;

bool same_word(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char p, char q) { return lower(p) == lower(q); });
}

// The plane with the heights of a picture without colour; kNoPlane where it is not clear which.
int grey_plane(const Image& image) {
    std::vector<int> planes;
    for (int k = 0; k < static_cast<int>(image.planes.size()); ++k) {
        if (image.names[static_cast<std::size_t>(k)] != "A") planes.push_back(k);
    }
    if (image.planes.size() == 1) return 0;
    if (planes.size() == 1) return planes.front();
    for (const std::string_view word : {"Y", "height", "displacement", "Z", "depth"}) {
        for (const int k : planes) {
            if (same_word(image.names[static_cast<std::size_t>(k)], word)) return k;
        }
    }
    return kNoPlane;
}

// Where heights come from: one plane as it is, or a mixture of R, G and B.
struct Source {
    HeightChannel mixture = HeightChannel::automatic;
    int plane = kNoPlane;  // else planes red, green and blue
    int red = 0, green = 0, blue = 0;
};

std::string list_of_channels(const Image& image) {
    std::string list;
    for (const std::string& name : image.names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

Error no_such_channel(const Image& image, HeightChannel channel) {
    std::string reason =
        channel == HeightChannel::automatic
            ? "which channel holds the height is not clear"
            : "the picture has no channel for \"" + std::string(name_of(kHeightChannelNames, channel)) + "\"";
    return {ErrorCode::bad_option, {}, reason + "; its channels are " + list_of_channels(image)};
}

Result<Source> find_source(const Image& image, HeightChannel channel) {
    Source source{channel, kNoPlane, image.find("R"), image.find("G"), image.find("B")};
    const bool colour = source.red >= 0 && source.green >= 0 && source.blue >= 0;
    const int grey = colour ? kNoPlane : grey_plane(image);
    const auto named = [&](const char* name) { return image.find(name) >= 0 ? image.find(name) : grey; };
    switch (channel) {
        case HeightChannel::r: source.plane = named("R"); break;
        case HeightChannel::g: source.plane = named("G"); break;
        case HeightChannel::b: source.plane = named("B"); break;
        case HeightChannel::a: source.plane = image.find("A"); break;
        case HeightChannel::y: source.plane = named("Y"); break;
        case HeightChannel::automatic:
        case HeightChannel::luma:
        case HeightChannel::average:
        case HeightChannel::max:
            if (colour) return source;
            source.plane = grey;
            break;
    }
    if (source.plane == kNoPlane) return no_such_channel(image, channel);
    return source;
}

// Row j of the heights before anything else is done to them. Returns the number of texels where `automatic`
// took luma.
std::int64_t take_row(const Image& image, const Source& source, int j, float* out) {
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

// What was found wrong, as a sentence. `invalid` texels of `heights` are NaN.
Error invalid_heights(const Plane<float>& heights, std::int64_t invalid, const HeightOptions& options) {
    const std::string kinds = options.no_data ? "NaN, infinite or no-data" : "NaN or infinite";
    if (invalid == heights.extent().texels()) {
        return {ErrorCode::bad_data, {}, "no texel has a height: all are " + kinds};
    }
    int column = 0, row = 0;
    while (!std::isnan(heights.at(column, row))) {
        if (++column == heights.extent().width) {
            column = 0;
            ++row;
        }
    }
    return {ErrorCode::bad_data,
            {},
            std::to_string(invalid) + (invalid == 1 ? " height is " : " heights are ") + kinds +
                ", the first at column " + std::to_string(column) + ", row " + std::to_string(row)};
}

}  // namespace

Strength strength_from_world(Extent extent, double range, double width, double height) {
    assert(width > 0.0 && height >= 0.0 && std::isfinite(range) && std::isfinite(width) &&
           std::isfinite(height));
    const double x = range * extent.width / width;
    const double y = height > 0.0 ? range * extent.height / height : x;
    return {static_cast<float>(x), static_cast<float>(y)};
}

Strength strength_from_uv(Extent extent, double r) {
    const auto strength = static_cast<float>(r * extent.width);
    return {strength, strength};
}

Result<HeightField> height_field(const Image& image, const HeightOptions& options, const Execution& execution,
                                 HeightReport* report) {
    assert(!image.planes.empty() && image.planes.size() == image.names.size());
    return guarded([&]() -> Result<HeightField> {
        if (!(options.blur_sigma >= 0.0f && options.blur_sigma <= kMaxBlurSigma)) {
            return Error{ErrorCode::bad_option, {}, "the blur's sigma must be from 0 to 256 texels"};
        }
        const Result<Source> source = find_source(image, options.channel);
        if (!source) return source.error();
        const Extent extent = image.extent();
        HeightField field{Plane<float>(extent), 1.0f, 1.0f, options.wrap_x, options.wrap_y};
        const float no_data = options.no_data.value_or(std::numeric_limits<float>::quiet_NaN());
        // Progress: what comes first is quick beside filling and blurring.
        const double taken = options.fill_invalid || options.blur_sigma > 0.0f ? 0.2 : 1.0;
        const double filled = options.blur_sigma > 0.0f ? 0.5 : 1.0;

        std::atomic<std::int64_t> luma_texels{0}, invalid_texels{0};
        const auto take = [&](int begin, int end) {
            std::int64_t luma = 0, invalid = 0;
            for (int j = begin; j < end; ++j) {
                luma += take_row(image, *source, j, field.height.row(j));
                invalid += clean_row(field.height.row(j), extent.width, no_data, options.invert);
            }
            luma_texels += luma;
            invalid_texels += invalid;
        };
        const int strip = std::max(1, (1 << 16) / extent.width);
        if (auto done = parallel_for(execution, extent.height, strip, take, {0.0, taken}); !done)
            return done.error();

        if (invalid_texels > 0) {
            if (!options.fill_invalid || invalid_texels == extent.texels()) {
                return invalid_heights(field.height, invalid_texels, options);
            }
            auto done = fill_from_nearest(field.height.view(), options.wrap_x, options.wrap_y, execution,
                                          {taken, filled});
            if (!done) return done.error();
        }
        if (options.blur_sigma > 0.0f) {
            auto done = blur(field.height, static_cast<double>(options.blur_sigma), options.wrap_x,
                             options.wrap_y, execution, {filled, 1.0});
            if (!done) return done.error();
        }
        if (report != nullptr) *report = {luma_texels, invalid_texels};
        return field;
    });
}

}  // namespace tex
