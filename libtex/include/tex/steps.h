// SPDX-License-Identifier: Apache-2.0
// steps.h: several steps from file to file, without files in between.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <tex/pipeline.h>

#pragma GCC visibility push(default)
namespace tex {

// What bake_file(), pack_file() or blend_file() does with these options.
using Step = std::variant<BakeFileOptions, PackFileOptions, BlendFileOptions>;

// A map that was read.
struct MapRead {
    std::string file;
    SourceInfo info;
};

struct StepsReport {
    Extent extent;  // of the base level
    int levels = 1;
    std::size_t bytes = 0;          // of all outputs
    PackOptions pack;               // of `output`
    HeightReport heights;           // if the first step bakes
    Strength strength;              // as in BakeFileReport, if the first step bakes
    float usual_slope = 0.0f;       // this and the next as in BakeFileReport, if the only step bakes
    std::int64_t steep_texels = 0;  // maps of floats hold all slopes
    std::vector<MapRead> maps;
};

// Whether there is a step, only the first one bakes, none before the last builds levels or writes roughness, and the
// options of each are in their ranges. Errors: bad_option.
[[nodiscard]] Result<void> validate(const std::vector<Step>& steps);

// Applies `steps` one after the other: the first to the file `input`, each further one to the result of the one before.
// The last one writes `output`, and the files of its option `more`. The bytes are the same as if each step before the
// last had written a file of floats (EXR, Encoding::float_, or rgba32f if there is alpha beside the normals) that the
// next one reads.
//
// Of the steps before the last, only the settings that concern normals count: source, heights, strength, bake, level,
// scale, layers and blend, others.alpha, and the direction of y that `pack` gives. Rows go from step to step, so memory
// holds what bake_file(), pack_file() and blend_file() say for each. If the layout of a file depends on its texels, a
// step before the last reads the file once more.
//
// Errors: bad_option (as validate(steps)), and those of the three functions.
[[nodiscard]] Result<StepsReport> apply_steps(const std::string& input, const std::vector<Step>& steps,
                                              const std::string& output, Container container,
                                              const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
