// SPDX-License-Identifier: Apache-2.0
// meshopt_buffers.h: buffers of glTF that meshoptimizer compressed.
//
// The formats are those of EXT_meshopt_compression (Kapoulkine 2021), whose specification describes them bit by bit,
// and of KHR_meshopt_compression, which adds version 1 of attributes and the filter of colours:
//
//     attributes   blocks of up to 256 elements, byte by byte as differences from the element before
//     triangles    a byte for each triangle, which names an edge and a corner among the last ones; the rest as numbers
//     indices      differences from one of two earlier numbers
//
// Filters then turn octahedral vectors, quaternions, exponents and YCoCg colours into plain numbers. Nothing is read or
// written outside of the buffers, whatever they hold.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential, color };

struct MeshoptLayout {
    MeshoptMode mode = MeshoptMode::attributes;
    MeshoptFilter filter = MeshoptFilter::none;
    std::size_t count = 0;   // of elements
    std::size_t stride = 0;  // of an element in bytes
};

// Decodes `layout.count * layout.stride` bytes. Errors: bad_data (the layout is impossible; the bytes are damaged or
// truncated). May throw std::bad_alloc.
Result<std::vector<std::byte>> decode_meshopt(const MeshoptLayout& layout, std::span<const std::byte> bytes);

// The parts of it. Each returns false if the bytes are damaged.
bool decode_meshopt_attributes(std::span<const std::byte> bytes, std::size_t stride, std::vector<std::byte>& to);
bool decode_meshopt_triangles(std::span<const std::byte> bytes, std::size_t size, std::vector<std::byte>& to);
bool decode_meshopt_indices(std::span<const std::byte> bytes, std::size_t size, std::vector<std::byte>& to);
void apply_meshopt_filter(MeshoptFilter filter, std::size_t stride, std::vector<std::byte>& elements);

}  // namespace tex::inline v1
