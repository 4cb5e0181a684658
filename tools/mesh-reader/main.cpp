// SPDX-License-Identifier: Apache-2.0
// tex-mesh-reader: reads meshes with Assimp, and buffers of glTF with Draco, for libtex, which starts it. Do not run it
// by hand.
//
// reader_protocol.h describes how. The answer is the mesh as a GLB file (glb.h).

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/Importer.hpp>

#include "draco.h"
#include "glb.h"
#include "reader/reader.h"

namespace tex::reader {
namespace {

// libtex reads these file types itself, and more strictly.
void leave_out_own_types(Assimp::Importer& importer) {
    for (const char* extension : {"gltf", "glb", "obj"}) {
        while (Assimp::BaseImporter* const known = importer.GetImporter(extension)) importer.UnregisterLoader(known);
    }
}

// Assimp 5.4 knows FBX by the name of the file alone; libtex goes by the content.
bool is_fbx(std::string_view bytes) { return bytes.starts_with("Kaydara FBX Binary") || bytes.starts_with("; FBX "); }

bool refuse_mesh(ReaderHeader& header, const std::string& reason) {
    if (reason.find("No suitable reader") == std::string::npos)
        return refuse(header, ErrorCode::bad_data, reason.empty() ? "damaged" : reason);
    return refuse(header, ErrorCode::unsupported,
                  "is not a mesh that libtex reads: glTF 2.0 (.gltf, .glb), OBJ, FBX, PLY and other types that Assimp "
                  "knows");
}

bool answer(const Glb& glb, ReaderHeader& header) {
    if (glb.bytes() > UINT32_MAX) return refuse(header, ErrorCode::unsupported, "has more than 4 GB of triangles");
    const std::uint32_t head[] = {0x46546c67, 2, static_cast<std::uint32_t>(glb.bytes()),
                                  static_cast<std::uint32_t>(glb.json.size()), 0x4e4f534a};
    const std::uint32_t middle[] = {static_cast<std::uint32_t>(glb.data.size()), 0x004e4942};
    header.bytes = glb.bytes();
    reserve_result(glb.bytes());
    std::uint64_t at = kReaderDataOffset;
    const auto put = [&at](const void* from, std::size_t bytes) {
        put_bytes(at, from, bytes);
        at += bytes;
    };
    put(head, sizeof head);
    put(glb.json.data(), glb.json.size());
    put(middle, sizeof middle);
    put(glb.data.data(), glb.data.size());
    return true;
}

bool read_mesh(const Task& task, ReaderHeader& header) {
    struct stat status {};
    if (fstat(kInputDescriptor, &status) != 0 || status.st_size <= 0)
        return refuse(header, ErrorCode::bad_data, "the file is empty");
    const auto bytes = static_cast<std::size_t>(status.st_size);
    const void* const file = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, kInputDescriptor, 0);
    if (file == MAP_FAILED) throw std::bad_alloc();
    if (task.verb == "draco") {
        Glb glb;
        return decode_draco(file, bytes, glb, header) && answer(glb, header);
    }
    Assimp::Importer importer;
    leave_out_own_types(importer);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    std::string hint = task.format == "-" ? "" : task.format;
    if (is_fbx({static_cast<const char*>(file), bytes})) hint = "fbx";
    const aiScene* const scene =
        importer.ReadFileFromMemory(file, bytes, aiProcess_Triangulate | aiProcess_SortByPType, hint.c_str());
    if (scene == nullptr) return refuse_mesh(header, importer.GetErrorString());
    if (scene->mRootNode == nullptr || scene->mNumMeshes == 0)
        return refuse(header, ErrorCode::bad_data, "has no triangles");
    return answer(glb_of(*scene), header);
}

}  // namespace
}  // namespace tex::reader

int main(int argc, char** argv) {
    return tex::reader::run_program("tex-mesh-reader", "Assimp", argc, argv, tex::reader::read_mesh);
}
