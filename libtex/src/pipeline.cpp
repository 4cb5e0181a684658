// SPDX-License-Identifier: Apache-2.0
// Opens the input; stream/bake_stream.cpp and stream/pack_stream.cpp do the rest.

#include <tex/pipeline.h>

#include <cmath>

#include "fields/blend_fields.h"
#include "fields/field_check.h"
#include "fields/mip_fields.h"
#include "files/input_file.h"
#include "rows/usable.h"
#include "stream/bake_stream.h"
#include "stream/blend_stream.h"
#include "stream/given_extras.h"
#include "stream/occluded_heights.h"
#include "stream/pack_stream.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

namespace {

// Errors: bad_option if there are several outputs, and the bytes of one are to stay in memory.
Result<void> check_one_output(const WriteOptions& write, bool has_more) {
    return write.into && has_more ? Result<void>(bad_option("into: the output must be one file")) : Result<void>();
}

}  // namespace

Result<void> validate(const BakeFileOptions& options) {
    if (auto valid = check_one_output(options.write, static_cast<bool>(options.level_names)); !valid) return valid;
    if (auto valid = validate(options.bake); !valid) return valid;
    if (!std::isfinite(options.vertical_scale)) return bad_option("vertical_scale: must be finite");
    if (options.occlusion) {
        if (auto valid = validate(*options.occlusion); !valid) return valid;
    }
    if (auto valid = validate(options.mip); !valid) return valid;
    return validate(options.pack);
}

Result<void> validate(const PackFileOptions& options) {
    const bool has_more =
        options.level_names || options.roughness || options.apart.blue || options.apart.alpha || options.apart.length;
    if (auto valid = check_one_output(options.write, has_more); !valid) return valid;
    if (options.level && *options.level < 0) return bad_option("level: must be 0 or more");
    if (options.scale) {
        if (auto valid = check_fields(*options.scale); !valid) return valid;
    }
    if (!contains(kNoLimit, options.max_side)) return bad_option("max_side: " + requirement(kNoLimit));
    if (options.roughness && !options.mip) return bad_option("roughness: needs mip");
    if (options.roughness && !options.roughness->format && !options.roughness->kept)
        return bad_option("roughness: needs a format");
    if (auto valid = check_no_heights(options.others); !valid) return valid;
    return options.mip ? validate(*options.mip) : Result<void>();
}

Result<void> validate(const BlendFileOptions& options) {
    if (auto valid = check_one_output(options.write, static_cast<bool>(options.level_names)); !valid) return valid;
    for (const LayerFile& layer : options.layers) {
        if (auto valid = validate(layer.layer()); !valid) return valid;
    }
    if (auto valid = validate(options.blend); !valid) return valid;
    if (auto valid = check_no_heights(options.others); !valid) return valid;
    return validate(options.mip);
}

Result<BakeFileReport> bake_file(const std::string& input, const std::string& output, Container container,
                                 const BakeFileOptions& options, const Execution& execution) {
    return no_throw([&]() -> Result<BakeFileReport> {
        if (auto valid = validate(options); !valid) return valid.error();
        Result<InputFile> file = open_input(input, options.read);
        if (!file) return file.error();
        return bake_stream(*file, output, container, options, execution);
    });
}

Result<PackFileReport> pack_file(const std::string& input, const std::string& output, Container container,
                                 const PackFileOptions& options, const Execution& execution) {
    return no_throw([&]() -> Result<PackFileReport> {
        if (auto valid = validate(options); !valid) return valid.error();
        Result<InputFile> file = open_input(input, options.source.read);
        if (!file) return file.error();
        return pack_stream(*file, output, container, options, execution);
    });
}

Layer LayerFile::layer() const {
    return {{}, scale, tiling_x, tiling_y, offset_x, offset_y, rotation, wrap_x, wrap_y, strength, {}};
}

Result<BlendFileReport> blend_file(const std::string& input, const std::string& output, Container container,
                                   const BlendFileOptions& options, const Execution& execution) {
    return no_throw([&]() -> Result<BlendFileReport> {
        if (auto valid = validate(options); !valid) return valid.error();
        return blend_stream(input, output, container, options, execution);
    });
}

}  // namespace tex::inline v1
