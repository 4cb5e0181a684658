// SPDX-License-Identifier: Apache-2.0
// scene.h: the option groups of a picture of a normal map (shape, light, material), and the files that they name.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/preview.h>

#include "batch/job.h"
#include "cli/command.h"
#include "options/normals.h"

namespace tex::cli {

// A normal map as it is sampled: its own levels or, if the file has one only, levels made from it.
struct SampledMap {
    MipChain chain;
    bool without_z = false;
};

// Reading::keep_length is for pictures that show what is wrong with a map.
[[nodiscard]] Result<SampledMap> read_sampled_map(Job& job, const std::string& path, NormalsReader& normals,
                                                  const Reading& reading, const PreviewOptions& preview,
                                                  const Execution& execution);

// The files of a scene beside its map.
struct SceneFiles {
    std::optional<SampledMap> detail;
    std::optional<Image> albedo, detail_albedo;
    Plane<float> height;

    [[nodiscard]] PreviewScene with(const SampledMap& map) const;
};

struct SceneOptions {
    PreviewOptions preview;
    std::string albedo, detail, detail_albedo, height;  // paths, or empty
    std::optional<YAxis> detail_y_in;

    void add(Command& command);

    [[nodiscard]] std::vector<std::string> files() const;
    // The detail is read as `normals` says, but for its y.
    [[nodiscard]] Result<SceneFiles> read(Job& job, NormalsReader& normals, const Execution& execution) const;

private:
    void add_shape(Command& command);
    void add_light(Command& command);
    void add_material(Command& command);
    void add_detail(Command& command);
    void add_parallax(Command& command);
    void add_sampling(Command& command);
};

// "N" or "WxH" in pixels, as PreviewOptions::size means it.
[[nodiscard]] Extent parse_picture_size(const std::string& text);

}  // namespace tex::cli
