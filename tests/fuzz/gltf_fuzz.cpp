// SPDX-License-Identifier: Apache-2.0
// A glTF or GLB file of any bytes is read or refused; what is read is whole, and tangents can be made. The files that
// it names are in its folder. Its maps belong to materials and images that exist. What stands for the answer of Draco
// is the buffer that it was to decode.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <tex/mesh.h>

#include "fuzz/whole_mesh.h"
#include "mesh/gltf.h"
#include "mesh/gltf_images.h"
#include "mesh/gltf_output.h"

namespace {

// UVs that were moved are finite.
void expect_selected(const tex::Mesh& mesh) {
    for (std::size_t k = 0; k < mesh.materials.size() && k < 4; ++k) {
        tex::MeshSelection selection;
        selection.material = std::to_string(k);
        const auto selected = tex::select_part(mesh, selection, {1, {}});
        if (selected) expect(static_cast<bool>(tex::check_part(selected->part)));
    }
}

void look_at_maps(std::span<const std::byte> bytes, const tex::LoadBeside& load) {
    const auto chunks = tex::gltf_chunks(bytes);
    if (!chunks) return;
    const auto document = tex::JsonDocument::parse(chunks->json);
    if (!document) return;
    const auto maps = tex::gltf_maps(document->root());
    if (!maps) return;
    tex::GltfBuffers buffers(document->root(), chunks->json.size(), chunks->binary, load);
    const auto images = tex::gltf_images(document->root(), buffers, *maps, true);
    const std::size_t materials = document->root()["materials"].size();
    for (const tex::ModelMap& map : *maps) {
        expect(map.material >= 0 && static_cast<std::size_t>(map.material) < materials);
        expect(map.image >= -1 && map.image < static_cast<int>(images.size()));
    }
    for (const tex::ModelImage& image : images) {
        const bool leaves = image.file.starts_with('/') || ("/" + image.file + "/").find("/../") != std::string::npos;
        expect(!leaves);
    }
}

// With other pictures in its slots, the file has the same maps, and reads as what was written.
void put_pictures(std::span<const std::byte> bytes, const tex::LoadBeside& load) {
    const auto maps_in = [&](std::span<const std::byte> file, std::vector<tex::ModelImage>* images) {
        std::vector<tex::ModelMap> none;
        const auto chunks = tex::gltf_chunks(file);
        if (!chunks) return none;
        const auto document = tex::JsonDocument::parse(chunks->json);
        if (!document) return none;
        auto maps = tex::gltf_maps(document->root());
        if (!maps) return none;
        tex::GltfBuffers buffers(document->root(), chunks->json.size(), chunks->binary, load);
        if (images != nullptr) *images = tex::gltf_images(document->root(), buffers, *maps, true);
        return *maps;
    };
    const auto maps = maps_in(bytes, nullptr);
    // Both forms, and back: the maps stay.
    for (const bool is_binary : {true, false}) {
        const auto other = tex::write_gltf(bytes, load, {true, is_binary ? "out.glb" : "out.gltf", is_binary, {}}, {});
        if (!other) continue;
        expect(maps_in(other->bytes, nullptr).size() == maps.size());
    }
    tex::ModelChanges added;
    added.adds_material = true;
    std::ignore = tex::write_gltf(bytes, load, {true, "out.gltf"}, added);
    for (std::size_t k = 0; k < maps.size() && k < 3; ++k) {
        tex::ModelPicture picture{{maps[k]}, tex::Container::png, std::vector<std::byte>(5 + 7 * k, std::byte{7})};
        for (std::size_t other = k + 1; other < maps.size() && k % 2 == 0; ++other) {
            const bool is_of_another_slot =
                maps[other].material != maps[k].material || maps[other].slot != maps[k].slot;
            if (maps[other].image == maps[k].image && is_of_another_slot) picture.maps.push_back(maps[other]);
        }
        const auto written = tex::write_gltf(bytes, load, {true, "out.gltf"}, {{picture}});
        if (!written) continue;
        std::vector<tex::ModelImage> images;
        const auto again = maps_in(written->bytes, &images);
        expect(again.size() == maps.size());
        for (std::size_t m = 0; m < again.size(); ++m) {
            expect(again[m].material == maps[m].material && again[m].slot == maps[m].slot);
            if (m != k || again[m].image < 0) continue;
            const tex::ModelImage& image = images[static_cast<std::size_t>(again[m].image)];
            expect(image.error || !image.file.empty() || image.bytes == picture.bytes);
        }
        for (const tex::BesideModel& file : written->beside) {
            expect(!file.path.starts_with('/') && ("/" + file.path + "/").find("/../") == std::string::npos);
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // A file beside it has a few bytes; every other one is missing.
    const tex::LoadBeside load = [](const std::string& path) -> tex::Result<std::vector<std::byte>> {
        if (path == "a.bin") return std::vector<std::byte>(256, std::byte{1});
        return tex::Error{tex::ErrorCode::io, path, "is missing"};
    };
    const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
    const tex::DecodeDraco draco = [](std::span<const std::byte> request) -> tex::Result<std::vector<std::byte>> {
        const auto buffer = request.subspan(std::min<std::size_t>(4, request.size()));
        return std::vector<std::byte>(buffer.begin(), buffer.end());
    };
    if (const auto mesh = tex::parse_gltf(bytes, load, draco, true)) {
        expect_whole(*mesh);
        expect_selected(*mesh);
    }
    look_at_maps(bytes, load);
    put_pictures(bytes, load);
    if (const auto files = tex::gltf_buffer_files(bytes)) {
        // No name leads out of the folder of the file.
        for (const std::string& file : *files) {
            const bool leaves = file.front() == '/' || ("/" + file + "/").find("/../") != std::string::npos;
            if (file.empty() || leaves) std::abort();
        }
    }
    return 0;
}
