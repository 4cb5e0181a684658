// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/beside.h"
#include "files/input_file.h"
#include "formats/reader/reader_mesh.h"
#include "mesh/gltf.h"
#include "mesh/obj.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

Result<Mesh> parse_other(const std::string& path, const std::vector<std::byte>& bytes, const MeshReadOptions& options) {
    const auto glb = read_with_mesh_reader(path, bytes, options.reader);
    if (!glb) return glb.error();
    const LoadBeside nothing = [](const std::string&) -> Result<std::vector<std::byte>> {
        return Error{ErrorCode::bad_data, {}, "the mesh reader returned invalid data"};
    };
    auto mesh = parse_gltf(*glb, nothing, {}, options.colors);
    if (!mesh) return mesh;
    for (MeshPart& part : mesh->parts) part.v_axis = YAxis::up;
    return mesh;
}

Result<Mesh> parse(const std::string& path, const std::vector<std::byte>& bytes, const LoadBeside& load,
                   const MeshReadOptions& options) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const DecodeDraco draco = [&](std::span<const std::byte> request) {
        return decode_draco_with_reader(path, request, options.reader);
    };
    if (is_gltf(bytes)) return parse_gltf(bytes, load, draco, options.colors);
    if (!is_obj(text)) return parse_other(path, bytes, options);
    auto mesh = parse_obj(text, options.colors);
    if (!mesh) return mesh;
    for (const MeshPart& part : mesh->parts) {
        if (const auto checked = check_part(part); !checked) return checked.error();
    }
    return mesh;
}

// What names the other files of a mesh: nothing unless it is glTF. Of a GLB file that is as long as it says, the JSON
// alone, because the rest may be large.
Result<std::vector<std::byte>> read_names(const std::string& path, std::int64_t most) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    if (file->size() && *file->size() > most)
        return Error{ErrorCode::unsupported, path, "has more than " + std::to_string(most) + " bytes"};
    const std::string_view head(reinterpret_cast<const char*>(file->head().data()), file->head().size());
    const bool is_blank = head.find_first_not_of(" \t\r\n") == std::string_view::npos;
    if (!is_blank && !is_gltf(file->head())) return std::vector<std::byte>();
    const auto length = glb_json_length(file->head(), file->size().value_or(0));
    if (!length) {
        auto all = file->read_rest(most);
        if (all && !is_gltf(*all)) all->clear();
        return all;
    }
    std::vector<std::byte> json(*length);
    const auto read = file->read_at(kGlbHeader, json.data(), json.size());
    if (!read) return read.error();
    json.resize(*read);
    return json;
}

}  // namespace

Result<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options) {
    return no_throw([&]() -> Result<Mesh> {
        const auto bytes = read_at_most(path, options.max_bytes);
        if (!bytes) return bytes.error();
        const LoadBeside load = [&](const std::string& name) -> Result<std::vector<std::byte>> {
            if (path == "-") return Error{ErrorCode::unsupported, path, "has buffers in other files: " + name};
            return read_named(path, name, options.max_bytes);
        };
        auto mesh = parse(path, *bytes, load, options);
        if (!mesh) return mesh.error().of(path);
        return mesh;
    });
}

Result<std::vector<std::string>> mesh_files(const std::string& path, const MeshReadOptions& options) {
    return no_throw([&]() -> Result<std::vector<std::string>> {
        std::vector<std::string> files = {path};
        std::error_code error;
        if (path == "-" || (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)))
            return files;
        const auto bytes = read_names(path, options.max_bytes);
        if (!bytes) return bytes.error();
        if (bytes->empty()) return files;
        const auto names = gltf_buffer_files(*bytes);
        if (!names) return names.error().of(path);
        for (const std::string& name : *names) {
            if (std::string file = beside(path, name); std::filesystem::exists(file, error))
                files.push_back(std::move(file));
        }
        return files;
    });
}

}  // namespace tex::inline v1
