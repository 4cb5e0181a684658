// SPDX-License-Identifier: Apache-2.0
// tex.h: libtex, a toolkit for tangent-space normal maps. Includes all of it; read this first.
//
// Data flow
// ---------
//
//     file --read_image--> Image --height_field--> HeightField --bake--> NormalMap --build_mip_chain--> MipChain
//                                                                                                   |      ^
//                                                                                                 pack   unpack
//                                                                                                   v      |
//                                                                        file <--write_texture--   Texture
//                                                                        <--read_texture-- file
//
//     #include <tex/tex.h>
//
//     auto image = tex::read_image("bricks.png");
//     if (!image) return fail(image.error().message());
//     auto field = tex::height_field(*image, {});
//     ...
//     field->bumpiness_x = field->bumpiness_y = 8.0f;
//     auto normals = tex::bake(*field);
//     auto chain = tex::build_mip_chain(std::move(*normals));
//     auto texture = tex::pack(*chain, {tex::Encoding::dxt5nm});
//     auto written = tex::write_texture("bricks.dds", *texture);
//
// Five conventions
// ----------------
//
// 1. One convention in memory, conversions at the border. Planar float; x right, y up (OpenGL, Unity), z out of the
//    surface; components in [-1, 1]; unit length; rows from the top; linear. Only pack and unpack flip, swizzle and
//    quantise.
// 2. The border can fail; kernels cannot. Reading, parsing and writing return Result<T>. Verbs on whole images return
//    it for out_of_memory and cancelled (and for bad_option if their comment says so), and assert their preconditions.
//    No exception leaves libtex.
// 3. The same bytes everywhere: for every number of threads, instruction set and compiler. There are three exceptions:
//    heights converted by OpenColorIO; EXR inputs compressed with DWAA or DWAB, on processors without AVX; and the
//    compression of ASTC, PNG, EXR, TIFF, TGA, BMP, JPEG outputs, with another build of the encoding library.
// 4. The library is silent: no stdout, stderr, exit, environment or locale. Progress and cancellation are callbacks
//    (Execution).
// 5. Units are in the name or in the comment: texels, degrees, bytes. Strides are in elements, pitches in bytes.
//
// Threads: any number of threads may call any function at the same time, on different objects or on the same const
// object.

#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tex/angular_error.h>
#include <tex/execution.h>
#include <tex/format.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/mesh.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/normal_map.h>
#include <tex/result.h>
#include <tex/texture.h>

#include <tex/bake.h>
#include <tex/bake_options.h>
#include <tex/blend.h>
#include <tex/blend_options.h>
#include <tex/check.h>
#include <tex/compare.h>
#include <tex/convert.h>
#include <tex/convert_options.h>
#include <tex/curvature.h>
#include <tex/deband.h>
#include <tex/deband_options.h>
#include <tex/heat_map.h>
#include <tex/integrate.h>
#include <tex/integrate_options.h>
#include <tex/mesh_selection.h>
#include <tex/mip.h>
#include <tex/mip_options.h>
#include <tex/pack.h>
#include <tex/pack_options.h>
#include <tex/preview.h>
#include <tex/preview_options.h>
#include <tex/roughness.h>
#include <tex/roughness_options.h>
#include <tex/scale.h>
#include <tex/sheet.h>
#include <tex/swizzle.h>
#include <tex/tangents.h>
#include <tex/transfer.h>
#include <tex/transfer_options.h>
#include <tex/unpack.h>
#include <tex/unpack_options.h>

#include <tex/color.h>
#include <tex/container.h>
#include <tex/image_io.h>
#include <tex/mesh_io.h>
#include <tex/model.h>
#include <tex/pipeline.h>
#include <tex/probe.h>
#include <tex/source.h>
#include <tex/steps.h>

#pragma GCC visibility push(default)
namespace tex {

// The version of the library that is running, not of the header: "0.1.0".
[[nodiscard]] const char* version();

// The environment of libtex on this machine, for reports.
struct Runtime {
    std::string instruction_set;  // of the kernels, with Highway's name: "AVX2"; results do not depend on it
    // Linked libraries and their versions: ("libpng", "1.6.39").
    std::vector<std::pair<std::string, std::string>> dependencies;
};
[[nodiscard]] Runtime runtime();

}  // namespace tex
#pragma GCC visibility pop
