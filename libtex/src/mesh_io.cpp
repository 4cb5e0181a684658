// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh_io.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "mesh/gltf.h"
#include "mesh/obj.h"
#include "threads/guard.h"

namespace tex {
namespace {

Result<Mesh> parse(const std::vector<std::byte>& bytes, const LoadBeside& load) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (is_gltf(bytes)) return parse_gltf(bytes, load);
    if (!is_obj(text))
        return Error{ErrorCode::unsupported, {}, "is not a mesh that libtex reads: glTF 2.0 (.gltf, .glb) or OBJ"};
    auto mesh = parse_obj(text);
    if (!mesh) return mesh;
    for (const MeshPart& part : mesh->parts) {
        if (const auto checked = check_part(part); !checked) return checked.error();
    }
    return mesh;
}

Result<std::vector<std::byte>> read_all(const std::string& path, const MeshReadOptions& options) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    if (file->size() && *file->size() > options.max_bytes)
        return Error{ErrorCode::unsupported, path, "has more than " + std::to_string(options.max_bytes) + " bytes"};
    return file->read_rest(options.max_bytes);
}

}  // namespace

Result<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options) {
    return guarded([&]() -> Result<Mesh> {
        const auto bytes = read_all(path, options);
        if (!bytes) return bytes.error();
        const LoadBeside load = [&](const std::string& name) -> Result<std::vector<std::byte>> {
            if (path == "-") return Error{ErrorCode::unsupported, path, "has buffers in other files: " + name};
            const std::size_t slash = path.rfind('/');
            return read_all(slash == std::string::npos ? name : path.substr(0, slash + 1) + name, options);
        };
        auto mesh = parse(*bytes, load);
        if (!mesh) return mesh.error().of(path);
        return mesh;
    });
}

}  // namespace tex
