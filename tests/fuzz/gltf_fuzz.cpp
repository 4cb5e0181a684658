// SPDX-License-Identifier: Apache-2.0
// A glTF or GLB file of any bytes is read or refused; what is read is whole, and tangents can be made. The files that
// it names are in its folder.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
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
    const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
    if (const auto mesh = tex::parse_gltf(bytes, load)) expect_whole(*mesh);
    if (const auto files = tex::gltf_buffer_files(bytes)) {
        // No name leads out of the folder of the file.
        for (const std::string& file : *files) {
            const bool leaves = file.front() == '/' || ("/" + file + "/").find("/../") != std::string::npos;
            if (file.empty() || leaves) std::abort();
        }
    }
    return 0;
}
