// SPDX-License-Identifier: Apache-2.0
// pipeline.h: from file to file, row by row.
//
// The verbs of the other headers take whole images and give whole images. Here a file is read a few rows at a time, and
// each row of texel blocks is written when it is finished, so that memory is needed for a few strips of rows only, and
// decoding runs beside everything else. The bytes are those of the verbs, one after the other.

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tex/bake.h>
#include <tex/blend.h>
#include <tex/color.h>
#include <tex/container.h>
#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/result.h>
#include <tex/roughness.h>
#include <tex/scale.h>
#include <tex/source.h>

#pragma GCC visibility push(default)
namespace tex {

// The names of files that hold one level each, by the level. May throw std::bad_alloc only.
using LevelNames = std::function<std::string(int level)>;

// What bake_file() does: read_image(), to_linear() where color.space is not empty, height_field(), bake(),
// build_mip_chain(), pack(), write_texture().
struct BakeFileOptions {
    ReadOptions read;
    ColorOptions color;
    HeightOptions heights;                     // wrap_x and wrap_y are those of the height field too
    std::function<Strength(Extent)> strength;  // the bumpiness for a map of this extent; empty: 1. Must not throw
    BakeOptions bake;
    MipOptions mip;
    PackOptions pack;
    WriteOptions write;
    LevelNames level_names;  // a file for each level, and no `output`; empty: one file
    bool slopes = false;     // BakeFileReport::slopes is wanted
};

struct BakeFileReport {
    Extent extent;  // of the base level
    int levels = 1;
    std::size_t bytes = 0;  // of the output, of all its files
    HeightReport heights;
    SlopeRange slopes;  // where they were wanted, else zeros
};

// Bakes the height map `input` ("-" is standard input) and writes it to `output` as a file of the kind `container`.
//
// Memory holds a few rows, and beyond that what a step needs that reaches over all rows:
//   an interlaced PNG   all rows, as they are decoded
//   fill_invalid        all heights, and for each the row of its nearest valid neighbour: 8 bytes a texel
//   TIFF, TGA ... out   all packed texels: the reader process encodes whole pictures
//   EXR out             the compressed tiles of smaller levels, until the base level is done
// PNG and EXR are written from the top: if the heights repeat from bottom to top, the last rows are decoded first
// (those of a PNG by decoding it twice; the reader process holds all rows of a TIFF, TGA, JPEG ..., as its file stores
// them). Pictures that hold one level get the base level.
//
// The output appears whole or not at all, see write_file(). Of files for each level none appears before all rows are
// done; then they do one after the other, up to one that fails. What goes to standard output or a FIFO is held in
// memory until it is whole.
//
// Preconditions (asserted): as those of the verbs.
// Errors: those of the verbs. `file` is empty where the heights are concerned, not a file. Of several errors (a damaged
// picture, a directory that is not there) any may be told. The same bytes for every number of threads.
[[nodiscard]] Result<BakeFileReport> bake_file(const std::string& input, const std::string& output, Container container,
                                               const BakeFileOptions& options = {}, const Execution& execution = {});

// A map of roughness beside the normals: build_roughness_chain() of the base level, with as many levels (one, where the
// file holds one), pack_roughness(), write_texture().
struct RoughnessFile {
    std::string output;
    LevelNames level_names;  // as in BakeFileOptions
    Container container = Container::dds;
    Format format = Format::bc4_unorm;
    Effort effort = Effort::normal;
    RoughnessModel model = RoughnessModel::toksvig;
    float own = 0.0f;                           // the material's roughness, the same everywhere,
    std::function<Result<Plane<float>>()> map;  // or what this reads
};

// What pack_file() does: read_normals(), scale() where there is a scale, build_mip_chain() where there is `mip`,
// pack(), write_texture().
struct PackFileOptions {
    SourceOptions source;
    std::optional<int> level;       // this level of the source alone, which becomes the base level; none: all of them
    std::optional<Scaling> scale;   // none: as they are
    std::optional<MipOptions> mip;  // levels are built of the base level; none: the source's own are kept

    // How the output is packed, told by what the source is. Empty: default_encoding() of the container, y as in the
    // source. Must not throw. Where the texels tell the swizzle, it may be called more than once; the last call counts.
    std::function<PackOptions(const SourceInfo&)> pack;
    WriteOptions write;
    LevelNames level_names;                  // as in BakeFileOptions
    std::optional<RoughnessFile> roughness;  // only where there is `mip`
};

struct PackFileReport {
    Extent extent;  // of the base level that was written
    int levels = 1;
    std::size_t bytes = 0;  // of the output, of all its files
    std::size_t roughness_bytes = 0;
    PackOptions pack;
    SourceInfo source;
};

// Reads the normal map `input` ("-" is standard input) and writes it to `output` as a file of the kind `container`, in
// another encoding, with levels built of it, scaled, or one level of it.
//
// Levels come one after the other. Memory holds a few rows, and beyond that what bake_file() says of an interlaced PNG
// and of outputs, and the plane of RoughnessFile::map. Pictures that hold one level get the base level. The file of
// roughness appears after those of normals.
//
// Streams cannot look at all texels before the first is written. Where these decide (four channels without a swizzle;
// floats without a range), the likeliest layout of the format is assumed: x, y, z in R, G, B; x in A and y in G in BC3;
// signed floats. Where the texels turn out to say otherwise, the file is read once more, and nothing of the first
// attempt remains.
//
// The output appears whole or not at all, and files for each level as bake_file() says. What goes to standard output or
// a FIFO is held in memory until it is whole.
//
// Preconditions (asserted): as those of the verbs.
// Errors: those of the verbs; bad_option where the source has no such level. Of several errors any may be told.
// The same bytes for every number of threads.
[[nodiscard]] Result<PackFileReport> pack_file(const std::string& input, const std::string& output, Container container,
                                               const PackFileOptions& options = {}, const Execution& execution = {});

// A detail map in a file.
struct LayerFile {
    std::string input;
    SourceOptions source;

    // As in Layer.
    float scale = 1.0f;
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
    float rotation = 0.0f;
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;
    float strength = 1.0f;
    std::function<Result<Plane<float>>()> mask = {};  // what this reads; empty: 1 everywhere

    // A Layer without detail and mask.
    [[nodiscard]] Layer layer() const;
};

// What blend_file() does: read_normals() of all maps, blend(), build_mip_chain(), pack(), write_texture().
struct BlendFileOptions {
    SourceOptions source;  // of the base
    std::vector<LayerFile> layers;
    BlendOptions blend;
    MipOptions mip;

    // As in PackFileOptions, told by what the base is.
    std::function<PackOptions(const SourceInfo& base)> pack;
    WriteOptions write;
    LevelNames level_names;  // as in BakeFileOptions
};

struct BlendFileReport {
    Extent extent;  // of the base level
    int levels = 1;
    std::size_t bytes = 0;  // of the output, of all its files
    PackOptions pack;
    SourceInfo source;                // of the base
    std::vector<SourceInfo> details;  // of the layers
};

// Blends the maps of the layers on the normal map `input` ("-" is standard input, for one of them) and writes the
// result to `output` as a file of the kind `container`.
//
// The base, and details of the result's extent that are not turned, tiled or moved up or down, come row by row, side by
// side. The others are held as whole maps, as any row of the result may need any of their rows; so are interlaced PNGs
// and masks. Layouts that the texels decide are assumed as pack_file() says. TIFF, TGA, BMP and JPEG are encoded as
// whole pictures.
//
// The output appears whole or not at all, and files for each level as bake_file() says. What goes to standard output or
// a FIFO is held in memory until it is whole.
//
// Preconditions (asserted): as those of the verbs.
// Errors: those of the verbs. Of several errors any may be told. The same bytes for every number of threads.
[[nodiscard]] Result<BlendFileReport> blend_file(const std::string& input, const std::string& output,
                                                 Container container, const BlendFileOptions& options = {},
                                                 const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
