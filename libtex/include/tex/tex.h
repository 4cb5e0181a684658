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
//    compression of PNG, EXR, TIFF, TGA, BMP, JPEG outputs, with another build of the encoding library.
// 4. The library is silent: no stdout, stderr, exit, environment or locale. Progress and cancellation are callbacks
//    (Execution).
// 5. Units are in the name or in the comment: texels, degrees, bytes. Strides are in elements, pitches in bytes.
//
// Headers
// -------
//
//     types.h     names, results, execution; extents, planes, images; normal maps, mip chains
//     format.h    formats, swizzles, encodings, textures
//     height.h    height_field(), deband(), strength of units, colour spaces
//     bake.h      bake()                                mip.h       build_mip_chain(), build_roughness_chain()
//     blend.h     scale(), blend()                      pack.h      pack(), unpack(), pack_roughness()
//     surface.h   integrate(), curvature(), occlusion() mesh.h      meshes, models, tangents, convert
//     file.h      reading, writing, probing             pipeline.h  bake_file(), pack_file(), steps, write_model()
//     check.h     check(), compare(), heat_map()        preview.h   preview(), contact sheets, animations
//     repair.h    repair()                              transcode.h transcode()
//     transfer.h  transfer()                            tex_c.h     the same for C, Rust and C#
//
// Options stand beside their verb. Everything is in the inline namespace v1. Its number is that of the shared library
// (libtex.so.1): both change with the binary interface, so that no program links to one that it was not built for.
//
// Threads: any number of threads may call any function at the same time, on different objects or on the same const
// object.

#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tex/bake.h>
#include <tex/blend.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/height.h>
#include <tex/mesh.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>
#include <tex/preview.h>
#include <tex/repair.h>
#include <tex/surface.h>
#include <tex/transcode.h>
#include <tex/transfer.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The version of the library that is running, not of the header: "1.0.0".
[[nodiscard]] TEX_API const char* version();

// The environment of libtex on this machine, for reports.
struct Runtime {
    std::string instruction_set;  // of the kernels, with Highway's name: "AVX2"; results do not depend on it
    // Linked libraries and their versions: ("libpng", "1.6.39").
    std::vector<std::pair<std::string, std::string>> dependencies;
};
[[nodiscard]] TEX_API Runtime runtime();

}  // namespace tex::inline v1
