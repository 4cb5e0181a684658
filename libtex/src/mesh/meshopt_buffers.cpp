// SPDX-License-Identifier: Apache-2.0

#include "mesh/meshopt_buffers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tex::inline v1 {
namespace {

template <class T>
T load_number(const std::byte* from) {
    T value{};
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
void store_number(std::byte* to, float value) {
    const auto number = static_cast<T>(static_cast<std::int32_t>(value));
    std::memcpy(to, &number, sizeof number);
}

// The nearest whole number, ties to even, for magnitudes below 2^22: what meshoptimizer's decoders of vectors do, in
// browsers too.
float nearest(float value) {
    constexpr float kShift = 12582912.0f;  // 1.5 * 2^23
    return (value + kShift) - kShift;
}

// Octahedral vectors (Meyer et al. 2010): x and y, with the scale in z; w stays. Numbers of T become normalised ones.
template <class T>
void undo_octahedral(std::byte* at) {
    constexpr float kMost = sizeof(T) == 1 ? 127.0f : 32767.0f;
    auto x = static_cast<float>(load_number<T>(at));
    auto y = static_cast<float>(load_number<T>(at + sizeof(T)));
    const float z = static_cast<float>(load_number<T>(at + 2 * sizeof(T))) - std::fabs(x) - std::fabs(y);
    const float fold = z >= 0.0f ? 0.0f : z;
    x += x >= 0.0f ? fold : -fold;
    y += y >= 0.0f ? fold : -fold;
    const float length = std::sqrt(x * x + y * y + z * z);
    const float scale = length > 0.0f ? kMost / length : 0.0f;
    store_number<T>(at, nearest(x * scale));
    store_number<T>(at + sizeof(T), nearest(y * scale));
    store_number<T>(at + 2 * sizeof(T), nearest(z * scale));
}

// Unit quaternions without their largest component, whose number is in the lowest bits of w, and the scale above.
void undo_quaternion(std::byte* at) {
    const auto last = load_number<std::int16_t>(at + 6);
    const float scale = static_cast<float>(last | 3);
    float v[3], square = 2.0f * scale * scale;
    for (std::size_t k = 0; k < 3; ++k) {
        v[k] = static_cast<float>(load_number<std::int16_t>(at + 2 * k));
        square -= v[k] * v[k];
    }
    const float w = std::sqrt(std::max(square, 0.0f)), most = 32767.0f / std::sqrt(2.0f) / scale;
    const auto largest = static_cast<std::size_t>(last & 3);
    for (std::size_t k = 0; k < 3; ++k) {
        const float value = std::clamp(nearest(v[k] * most), -32768.0f, 32767.0f);
        store_number<std::int16_t>(at + 2 * ((largest + k + 1) & 3), value);
    }
    store_number<std::int16_t>(at + 2 * largest, std::clamp(nearest(w * most), -32768.0f, 32767.0f));
}

// A signed mantissa of 24 bits, and the exponent above.
void undo_exponential(std::byte* at) {
    const auto bits = load_number<std::uint32_t>(at);
    const auto mantissa = static_cast<std::int32_t>(bits << 8) >> 8;
    const auto exponent = static_cast<std::int32_t>(bits) >> 24;
    const float power = std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23);
    const float value = power * static_cast<float>(mantissa);
    std::memcpy(at, &value, sizeof value);
}

bool is_possible(const MeshoptLayout& layout) {
    const std::size_t stride = layout.stride;
    if (layout.mode != MeshoptMode::attributes)
        return (stride == 2 || stride == 4) && layout.filter == MeshoptFilter::none &&
               (layout.mode == MeshoptMode::indices || layout.count % 3 == 0);
    if (stride == 0 || stride > 256 || stride % 4 != 0) return false;
    switch (layout.filter) {
        case MeshoptFilter::octahedral:
        case MeshoptFilter::color: return stride == 4 || stride == 8;
        case MeshoptFilter::quaternion: return stride == 8;
        case MeshoptFilter::none:
        case MeshoptFilter::exponential: return true;
    }
    return false;
}

}  // namespace

// Colours are no attribute that libtex reads, so they stay as they are.
void apply_meshopt_filter(MeshoptFilter filter, std::size_t stride, std::vector<std::byte>& elements) {
    if (filter == MeshoptFilter::none || filter == MeshoptFilter::color) return;
    const std::size_t step = filter == MeshoptFilter::exponential ? 4 : stride;
    for (std::size_t at = 0; at + step <= elements.size(); at += step) {
        std::byte* const element = elements.data() + at;
        if (filter == MeshoptFilter::exponential)
            undo_exponential(element);
        else if (filter == MeshoptFilter::quaternion)
            undo_quaternion(element);
        else if (stride == 4)
            undo_octahedral<std::int8_t>(element);
        else
            undo_octahedral<std::int16_t>(element);
    }
}

Result<std::vector<std::byte>> decode_meshopt(const MeshoptLayout& layout, std::span<const std::byte> bytes) {
    const auto damaged = [] { return Error{ErrorCode::bad_data, {}, "its compressed bytes are damaged"}; };
    if (!is_possible(layout)) return damaged();
    std::vector<std::byte> to(layout.count * layout.stride);
    bool decoded = false;
    switch (layout.mode) {
        case MeshoptMode::attributes: decoded = decode_meshopt_attributes(bytes, layout.stride, to); break;
        case MeshoptMode::triangles: decoded = decode_meshopt_triangles(bytes, layout.stride, to); break;
        case MeshoptMode::indices: decoded = decode_meshopt_indices(bytes, layout.stride, to); break;
    }
    if (!decoded) return damaged();
    apply_meshopt_filter(layout.filter, layout.stride, to);
    return to;
}

}  // namespace tex::inline v1
