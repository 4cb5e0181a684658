// SPDX-License-Identifier: Apache-2.0
// Opens the input; stream/bake_stream.cpp and stream/pack_stream.cpp do the rest.

#include <tex/pipeline.h>

#include <cassert>

#include "files/input_file.h"
#include "stream/bake_stream.h"
#include "stream/blend_stream.h"
#include "stream/pack_stream.h"
#include "threads/guard.h"

namespace tex {

Result<BakeFileReport> bake_file(const std::string& input, const std::string& output, Container container,
                                 const BakeFileOptions& options, const Execution& execution) {
    return guarded([&]() -> Result<BakeFileReport> {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        return bake_stream(*file, output, container, options, execution);
    });
}

Result<PackFileReport> pack_file(const std::string& input, const std::string& output, Container container,
                                 const PackFileOptions& options, const Execution& execution) {
    assert(!options.level || *options.level >= 0);
    assert(!options.roughness || options.mip);
    return guarded([&]() -> Result<PackFileReport> {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        return pack_stream(*file, output, container, options, execution);
    });
}

Layer LayerFile::layer() const {
    return {{}, scale, tiling_x, tiling_y, offset_x, offset_y, rotation, wrap_x, wrap_y, strength, {}};
}

Result<BlendFileReport> blend_file(const std::string& input, const std::string& output, Container container,
                                   const BlendFileOptions& options, const Execution& execution) {
    return guarded([&] { return blend_stream(input, output, container, options, execution); });
}

}  // namespace tex
