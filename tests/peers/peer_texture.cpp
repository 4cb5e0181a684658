// SPDX-License-Identifier: Apache-2.0

#include "peer_texture.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "scratch.h"

namespace peers {
namespace {

// A value in [0, 1) from the texel's position: the same on every machine.
float noise(int i, int j) {
    std::uint32_t h = static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h ^= h >> 13;
    return static_cast<float>(h >> 8) / 16777216.0f;
}

tex::HeightField bumpy_field(tex::Extent extent) {
    tex::HeightField field;
    field.height = tex::Plane<float>(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const bool flat = (i / 16 + j / 16) % 3 == 0;
            const float wave = static_cast<float>((i * 7 + j * 3) % 32) / 32.0f;
            field.height.at(i, j) = flat ? 0.5f : 0.6f * wave + 0.4f * noise(i, j);
        }
    }
    field.bumpiness_x = field.bumpiness_y = 3.0f;
    return field;
}

}  // namespace

tex::Texture bumpy_texture(tex::Extent extent, tex::Encoding encoding) {
    auto normals = tex::bake(bumpy_field(extent));
    auto chain = tex::build_mip_chain(std::move(normals).value());
    tex::PackOptions options;
    options.encoding = encoding;
    return tex::pack(chain.value(), options).value();
}

std::string scratch_path(const std::string& name) {
    static const tex::Scratch scratch;
    return scratch.path(name);
}

float largest_difference(const tex::Image& ours, int channel, const std::vector<float>& theirs, int channels) {
    const tex::Extent extent = ours.extent();
    if (static_cast<std::int64_t>(theirs.size()) != extent.texels() * channels) {
        return std::numeric_limits<float>::infinity();
    }
    float largest = 0.0f;
    for (int j = 0; j < extent.height; ++j) {
        const float* row = ours.planes[static_cast<std::size_t>(channel)].row(j);
        for (int i = 0; i < extent.width; ++i) {
            const auto texel =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
            largest = std::max(
                largest,
                std::abs(row[i] -
                         theirs[texel * static_cast<std::size_t>(channels) + static_cast<std::size_t>(channel)]));
        }
    }
    return largest;
}

}  // namespace peers
