// SPDX-License-Identifier: Apache-2.0
// scene.h: the option groups of a picture of a normal map (shape, light, material), and the files that they name.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/preview.h>

#include "cli/command.h"
#include "options/normals.h"
#include "options/tangent_space.h"
#include "tasks/job.h"

namespace tex::cli {

// The mesh that one map of a picture is on.
struct OwnMesh {
    explicit OwnMesh(MeshSpace its_mesh) : mesh(std::move(its_mesh)), space(mesh.space()) {}

    MeshSpace mesh;
    TangentSpace space;
};

// A normal map for sampling: its own levels or, if the file has only one, levels made from it.
struct SampledMap {
    MipChain chain;
    bool without_z = false;
    Plane<float> heights;  // those that the normals show, in texels, if a picture needs them
    float highest = 0.0f;
    std::shared_ptr<const OwnMesh> mesh;  // of a map in a model
    float scale = 1.0f;                   // and what its material multiplies x and y by
};

// What a picture needs of a map, beyond its levels.
struct Sampling {
    Reading reading;  // keep_length is for pictures that show what is wrong with a map
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;
    bool with_heights = false;
    const MeshSpace* from_object = nullptr;  // the map is in object space, on this mesh
};

[[nodiscard]] Result<SampledMap> read_sampled_map(Job& job, const std::string& path, NormalsReader& normals,
                                                  const Sampling& sampling, const Execution& execution);

// The files of a scene besides its map.
struct SceneFiles {
    std::optional<SampledMap> detail;
    std::optional<Image> albedo, detail_albedo;
    Plane<float> height, occlusion;
    const TangentSpace* mesh = nullptr;  // of maps that have none of their own; or none; must outlive this

    [[nodiscard]] PreviewScene with(const SampledMap& map) const;
};

struct SceneOptions {
    PreviewOptions preview;
    std::string albedo, occlusion, detail, detail_albedo, height;  // paths, or empty
    Deband deband = Deband::off;                                   // of the heights of `height`
    std::optional<YIn> detail_y_in;
    bool parallax_of_map = false;  // as high as the normals show, instead of preview.parallax.amount

    void add(Command& command);

    // Whether parallax takes its heights from the normals, and how strong it is on this map.
    [[nodiscard]] bool needs_heights() const;
    [[nodiscard]] float parallax_on(const SampledMap& map) const;

    [[nodiscard]] std::vector<std::string> files() const;
    // The detail is read as `normals` specifies, except for its y.
    [[nodiscard]] Result<SceneFiles> read(Job& job, NormalsReader& normals, const Execution& execution) const;

private:
    void add_shape(Command& command);
    void add_light(Command& command);
    void add_material(Command& command);
    void add_detail(Command& command);
    void add_parallax(Command& command);
    void add_sampling(Command& command);
};

// Parses "N" or "WxH" in pixels, with the meaning of PreviewOptions::size.
[[nodiscard]] Extent parse_picture_size(const std::string& text);

}  // namespace tex::cli
