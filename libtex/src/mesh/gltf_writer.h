// SPDX-License-Identifier: Apache-2.0
// gltf_writer.h: a glTF file with other pictures in some of its slots.

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <tex/pipeline.h>
#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/gltf_names.h"

namespace tex::inline v1 {

// A file beside the model that is written, by relative paths.
struct BesideModel {
    std::string path;         // from the output
    std::string from;         // from the input: what it is a copy of, or whose place it takes; empty: neither
    bool is_changed = false;  // otherwise it is a copy
    std::vector<std::byte> bytes = {};
};

struct WrittenGltf {
    std::vector<std::byte> bytes;
    std::vector<BesideModel> beside;
    std::vector<std::string> outside;   // GltfNames::outside()
    std::vector<std::string> joined;    // relative paths from the input: ModelFiles::joined
    int compressed = 0;                 // ModelFiles::compressed
    int mirrors = 0, left_mirrors = 0;  // those of ModelFiles
};

// write_gltf() of gltf_output.h in the form of the file, without another material.
Result<WrittenGltf> write_same_form(std::span<const std::byte> file, const LoadBeside& load, const ModelPlace& place,
                                    const ModelChanges& changes);

}  // namespace tex::inline v1
