// SPDX-License-Identifier: Apache-2.0
// A buffer that meshoptimizer compressed, of any bytes, is decoded or refused. What is decoded has the size that its
// layout says. The first five bytes are the mode, the filter, the number of elements (two bytes) and their size.

#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/whole_mesh.h"
#include "mesh/meshopt_buffers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 5) return 0;
    tex::MeshoptLayout layout;
    layout.mode = static_cast<tex::MeshoptMode>(data[0] % 3);
    layout.filter = static_cast<tex::MeshoptFilter>(data[1] % 5);
    layout.count = std::size_t{data[2]} + std::size_t{256} * (std::size_t{data[3]} % 8);
    layout.stride = data[4];
    const std::span bytes(reinterpret_cast<const std::byte*>(data + 5), size - 5);
    const auto decoded = tex::decode_meshopt(layout, bytes);
    if (decoded) expect(decoded->size() == layout.count * layout.stride);
    return 0;
}
