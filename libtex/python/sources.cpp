// SPDX-License-Identifier: Apache-2.0
#include "sources.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

// With Ctrl-C.
template <class Body>
auto run(const Body& body) {
    return Running().run(body);
}

// The texels of all planes, side by side, each as code(value).
template <class Code>
std::vector<std::byte> interleaved(const Image& image, Code code) {
    using Stored = decltype(code(0.0f));
    const Extent extent = image.extent();
    const std::size_t channels = image.planes.size();
    std::vector<std::byte> bytes(static_cast<std::size_t>(extent.texels()) * channels * sizeof(Stored));
    std::byte* at = bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (const Plane<float>& plane : image.planes) {
                const Stored stored = code(plane.at(i, j));
                std::memcpy(at, &stored, sizeof stored);
                at += sizeof stored;
            }
        }
    }
    return bytes;
}

// The code of a value of so many bits.
template <class Stored>
auto coder() {
    return [](float value) {
        constexpr float kLargest = static_cast<float>(std::numeric_limits<Stored>::max());
        constexpr float kLeast = std::numeric_limits<Stored>::is_signed ? -1.0f : 0.0f;
        return static_cast<Stored>(std::lround(std::clamp(value, kLeast, 1.0f) * kLargest));
    };
}

std::vector<std::byte> stored_texels(const Image& image, SampleKind sample, int bits) {
    if (sample == SampleKind::floating) return interleaved(image, [](float value) { return value; });
    if (sample == SampleKind::snorm)
        return bits == 8 ? interleaved(image, coder<std::int8_t>()) : interleaved(image, coder<std::int16_t>());
    return bits == 8 ? interleaved(image, coder<std::uint8_t>()) : interleaved(image, coder<std::uint16_t>());
}

}  // namespace

std::optional<MipChain> chain_of_source(py::handle from, bool base_only) {
    if (py::isinstance<Image>(from)) {
        const auto& image = from.cast<const Image&>();
        MipChain chain;
        chain.levels.push_back(run([&](const Execution& e) { return unpack(image, {}, e); }));
        return chain;
    }
    if (py::isinstance<Texture>(from)) {
        const auto& texture = from.cast<const Texture&>();
        return run([&](const Execution& e) -> Result<MipChain> {
            const Result<Swizzle> swizzle = guess_swizzle(texture, e);
            if (!swizzle) return swizzle.error();
            UnpackOptions options;
            options.swizzle = *swizzle;
            return unpack(texture, options, e);
        });
    }
    if (!is_path(from)) return std::nullopt;
    const std::string path = path_from(from, "path");
    return run([&](const Execution& e) { return read_normals(path, {}, base_only, e); }).chain;
}

std::optional<HeightField> field_of_source(py::handle from) {
    if (py::isinstance<Image>(from)) {
        const auto& image = from.cast<const Image&>();
        return run([&](const Execution& e) { return height_field(image, {}, e); });
    }
    if (!is_path(from)) return std::nullopt;
    const std::string path = path_from(from, "path");
    return run([&](const Execution& e) -> Result<HeightField> {
        Result<Image> image = read_image(path);
        if (!image) return image.error();
        Result<PictureHeights> field = height_field(*image, {}, e);
        if (!field) return field.error().of(path);
        return HeightField(std::move(*field));
    });
}

Texture texture_of(py::handle from, std::string_view name) {
    const Picture picture(from, name);
    const Image& image = *picture;
    const auto channels = static_cast<int>(image.planes.size());
    need(channels >= 2 && channels <= 4, name, "a normal map has 2 to 4 channels");
    const int bits = image.sample == SampleKind::floating ? 32 : image.bits <= 8 ? 8 : 16;
    SampleKind sample = image.sample;
    std::optional<Format> format = format_of(sample, bits, channels);
    if (!format) format = format_of(sample = SampleKind::floating, 32, channels);
    Texture texture;
    texture.format = *format;
    if (channels == 2) texture.swizzle = kSwizzleXy;
    texture.normal_encoding = image.normal_encoding;
    texture.levels.push_back({image.extent(), without_gil([&] { return stored_texels(image, sample, bits); })});
    return texture;
}

}  // namespace tex::python
