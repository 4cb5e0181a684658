// SPDX-License-Identifier: Apache-2.0
// A glTF or GLB file of any bytes is read or refused; what is read is whole, and tangents can be made.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fuzz/whole_mesh.h"
#include "mesh/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // A file beside it has a few bytes; every other one is missing.
    const tex::LoadBeside load = [](const std::string& path) -> tex::Result<std::vector<std::byte>> {
        if (path == "a.bin") return std::vector<std::byte>(256, std::byte{1});
        return tex::Error{tex::ErrorCode::io, path, "is missing"};
    };
    const auto mesh = tex::parse_gltf({reinterpret_cast<const std::byte*>(data), size}, load);
    if (mesh) expect_whole(*mesh);
    return 0;
}
