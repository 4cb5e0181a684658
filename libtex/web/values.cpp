// SPDX-License-Identifier: Apache-2.0

#include "values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tex::web {
namespace {

struct Array {
    const std::byte* at;
    std::size_t count;  // elements
    std::string type;
};

Array array_from(const Json& given, const std::string& name) {
    const Json *const at = given.find("at"), *const count = given.find("count"), *const type = given.find("type");
    if (at == nullptr || count == nullptr || type == nullptr) fail(name + ": expected a typed array");
    return {reinterpret_cast<const std::byte*>(static_cast<std::uintptr_t>(at->number())),
            static_cast<std::size_t>(count->number()), type->text()};
}

// Samples as floats: bytes and words are codes of unorm.
void copy_row(const Array& from, std::size_t first, std::size_t step, int count, float* to) {
    const auto samples = [&]<class T>(T, double scale) {
        const T* const at = reinterpret_cast<const T*>(from.at) + first;
        for (int i = 0; i < count; ++i)
            to[i] = static_cast<float>(static_cast<double>(at[static_cast<std::size_t>(i) * step]) / scale);
    };
    if (from.type == "f32") samples(float{}, 1.0);
    if (from.type == "u16") samples(std::uint16_t{}, 65535.0);
    if (from.type == "u8") samples(std::uint8_t{}, 255.0);
}

constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;

// Sizes fit std::size_t, which has 32 bits.
void need_room(Extent extent, const std::string& name) {
    if (extent.texels() > kMostTexels) fail(name + ": more texels than fit memory", ErrorCode::out_of_memory);
}

// The extent of {width, height, data, stride}, where stride counts samples from one row to the next.
Extent layout_from(const Json& given, const std::string& name, int channels, Array& array, std::size_t& stride) {
    const auto side = [&](const char* key) {
        const double value = member(given, key).number();
        if (!(value >= 1.0 && value <= kMaxExtent) || value != std::floor(value))
            fail(name + "." + key + ": must be from 1 to " + std::to_string(kMaxExtent));
        return static_cast<int>(value);
    };
    const Extent extent{side("width"), side("height")};
    need_room(extent, name);
    array = array_from(member(given, "data"), name + ".data");
    if (array.type != "f32" && array.type != "u16" && array.type != "u8")
        fail(name + ".data: expected a Float32Array, Uint16Array or Uint8Array");
    const auto row = static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(channels);
    const Json* const own_stride = given.find("stride");
    const double samples = own_stride != nullptr ? own_stride->number() : static_cast<double>(row);
    if (!(samples >= static_cast<double>(row))) fail(name + ".stride: must be at least " + std::to_string(row));
    stride = static_cast<std::size_t>(std::min(samples, 0x1p31));
    if (static_cast<double>(array.count) < static_cast<double>(stride) * (extent.height - 1) + static_cast<double>(row))
        fail(name + ".data: has fewer samples than its width and height need");
    return extent;
}

}  // namespace

const Json& member(const Json& of, const char* name) {
    const Json* const found = of.find(name);
    if (found == nullptr) fail(std::string(name) + ": is missing");
    return *found;
}

Json value_or_null(const Json& of, const char* name) {
    const Json* const found = of.find(name);
    return found != nullptr ? *found : Json();
}

std::span<const std::byte> bytes_from(const Json& given, const std::string& name) {
    const Array array = array_from(given, name);
    if (array.type != "u8") fail(name + ": expected a Uint8Array");
    return {array.at, array.count};
}

Plane<float> plane_from(const Json& given, const std::string& name) {
    Array array;
    std::size_t stride = 0;
    const Extent extent = layout_from(given, name, 1, array, stride);
    Plane<float> plane(extent);
    for (int j = 0; j < extent.height; ++j)
        copy_row(array, static_cast<std::size_t>(j) * stride, 1, extent.width, plane.row(j));
    return plane;
}

NormalMap map_from(const Json& given, const std::string& name) {
    Array array;
    std::size_t stride = 0;
    const Extent extent = layout_from(given, name, 3, array, stride);
    if (array.type != "f32") fail(name + ".data: expected a Float32Array; unpack() reads stored colours");
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        const std::size_t first = static_cast<std::size_t>(j) * stride;
        copy_row(array, first, 3, extent.width, map.x.row(j));
        copy_row(array, first + 1, 3, extent.width, map.y.row(j));
        copy_row(array, first + 2, 3, extent.width, map.z.row(j));
    }
    return map;
}

MipChain chain_from(const Json& given, const std::string& name) {
    MipChain chain;
    if (!given.is_list()) {
        chain.levels.push_back(map_from(given, name));
        return chain;
    }
    for (const Json& level : given.elements()) {
        const auto k = static_cast<int>(chain.levels.size());
        const std::string at = name + "[" + std::to_string(k) + "]";
        chain.levels.push_back(map_from(level, at));
        const Extent wanted = level_extent(chain.levels.front().extent(), k);
        if (chain.levels.back().extent() != wanted)
            fail(at + ": must be " + std::to_string(wanted.width) + "x" + std::to_string(wanted.height));
    }
    if (chain.levels.empty()) fail(name + ": there is no level");
    return chain;
}

Texture texture_from(const Json& given) {
    Texture texture;
    const auto format = find_by_name(kFormatNames, member(given, "format").text());
    if (!format) fail("texture.format: is no format");
    texture.format = *format;
    texture.swizzle = swizzle_from(member(given, "swizzle"), "texture.swizzle");
    const auto flag = [&](const char* key) {
        const Json value = value_or_null(given, key);
        if (!value.is_null() && !value.is_boolean()) fail(std::string("texture.") + key + ": expected true or false");
        return value.boolean();
    };
    texture.swizzle_known = flag("swizzle_known");
    texture.y_axis = value_or_null(given, "y_axis").text() == "down" ? YAxis::down : YAxis::up;
    texture.y_known = flag("y_known");
    texture.srgb = flag("srgb");
    for (const Json& from : list_from(member(given, "levels"), "texture.levels")) {
        const std::span<const std::byte> bytes = bytes_from(member(from, "bytes"), "texture.levels");
        const auto side = [&](const char* key) {
            return static_cast<int>(std::clamp(member(from, key).number(), 0.0, kMaxExtent + 1.0));
        };
        texture.levels.push_back({{side("width"), side("height")}, {bytes.begin(), bytes.end()}});
        const Level& level = texture.levels.back();
        const auto k = static_cast<int>(texture.levels.size()) - 1;
        if (level.extent.width < 1 || level.extent.width > kMaxExtent || level.extent.height < 1 ||
            level.extent.height > kMaxExtent || level.extent.texels() > kMostTexels ||
            level.extent != level_extent(texture.levels[0].extent, k) ||
            level.bytes.size() != level_bytes(texture.format, level.extent))
            fail("texture.levels[" + std::to_string(k) + "]: has not the extent or the bytes of a level");
    }
    if (texture.levels.empty()) fail("texture.levels: there is no level");
    return texture;
}

Json Answer::array(const char* type, std::shared_ptr<void> memory, std::size_t count) {
    const auto at = reinterpret_cast<std::uintptr_t>(memory.get());
    arrays.push_back(std::move(memory));
    return {{"at", at}, {"count", count}, {"type", type}};
}

Json Answer::of(const NormalMap& map) {
    const Extent extent = map.extent();
    const auto count = static_cast<std::size_t>(extent.texels()) * 3;
    const auto data = std::make_shared<std::vector<float>>(count);
    float* to = data->data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            *to++ = map.x.row(j)[i];
            *to++ = map.y.row(j)[i];
            *to++ = map.z.row(j)[i];
        }
    }
    return {{"width", extent.width},
            {"height", extent.height},
            {"data", array("f32", std::shared_ptr<void>(data, data->data()), count)}};
}

Json Answer::of(const MipChain& chain) {
    Json levels = Json::list();
    for (const NormalMap& level : chain.levels) levels.append(of(level));
    return levels;
}

Json Answer::of(const Plane<float>& plane) {
    const Extent extent = plane.extent();
    const auto data = std::make_shared<std::vector<float>>(static_cast<std::size_t>(extent.texels()));
    for (int j = 0; j < extent.height; ++j) {
        std::memcpy(data->data() + static_cast<std::ptrdiff_t>(j) * extent.width, plane.row(j),
                    static_cast<std::size_t>(extent.width) * sizeof(float));
    }
    return {{"width", extent.width},
            {"height", extent.height},
            {"data", array("f32", std::shared_ptr<void>(data, data->data()), data->size())}};
}

Json Answer::of(Texture texture) {
    Json levels = Json::list();
    for (Level& level : texture.levels) {
        levels.append(
            {{"width", level.extent.width}, {"height", level.extent.height}, {"bytes", of(std::move(level.bytes))}});
    }
    return {{"format", name_of(kFormatNames, texture.format)},
            {"swizzle", layout_name(texture.swizzle)},
            {"swizzle_known", texture.swizzle_known},
            {"y_axis", name_of(kYAxisNames, texture.y_axis)},
            {"y_known", texture.y_known},
            {"srgb", texture.srgb},
            {"remarks", Json::list({texture.remarks.begin(), texture.remarks.end()})},
            {"levels", levels}};
}

Json Answer::of(std::vector<std::byte> bytes) {
    const auto data = std::make_shared<std::vector<std::byte>>(std::move(bytes));
    return array("u8", std::shared_ptr<void>(data, data->data()), data->size());
}

}  // namespace tex::web
