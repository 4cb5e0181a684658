// SPDX-License-Identifier: Apache-2.0
// pipeline.h: from file to file, a few rows at a time; from model to model.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tex/bake.h>
#include <tex/blend.h>
#include <tex/file.h>
#include <tex/height.h>
#include <tex/mesh.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/surface.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- pipeline ------------------------------------------------------------------------------------------------------
//
// From file to file, row by row.
//
// The verbs of the other headers take and return whole images. The functions here read a file a few rows at a time and
// write each row of texel blocks as soon as it is finished. Memory therefore holds only a few strips of rows, and
// decoding runs in parallel with all other steps. The output has the same bytes as the verbs produce when they are
// called one after the other.

// Returns the name of the file for a level, if each level gets its own file. May throw std::bad_alloc only.
using LevelNames = std::function<std::string(int level)>;

// Another file with the same normals, made from the same reading. A file that can hold one level gets the base level.
struct MoreFile {
    std::string output;
    LevelNames level_names;  // as in BakeFileOptions
    Container container = Container::dds;
    int levels = 0;                                      // at most so many of the levels that are made; 0: all
    std::function<PackOptions(const SourceInfo&)> pack;  // as in PackFileOptions
    WriteOptions write;
};

// A tile of a terrain that is stored as a grid of pictures. The tile is baked together with as many rows and columns of
// the tiles around it as a normal depends on, so that the base levels of all tiles have the bytes of the bake of the
// whole terrain. Smaller levels are made from the base level of the tile alone, as of any picture.
struct TerrainTile {
    // The path of the tile so many places to the right and below (-1, 0 or 1 each, not both 0); empty if there is none:
    // the heights then continue as wrap_x and wrap_y say. The tile at the other end of a row or a column may stand for
    // the one that repeats there. May throw std::bad_alloc only.
    std::function<std::string(int right, int down)> neighbour;
    // Whether the first row and column of a tile are the last ones of the tile before it. None: they are if both sides
    // of the tile are 2^n + 1, or those of HGT (1201, 3601). HeightReport::remark counts heights that do not agree.
    std::optional<bool> shared_border;
};

// One channel of a picture, from 0 to 1, as read_image() and height_field() read it, with FileValues::unit and without
// a no-data value. Files read its rows with those of the normals, and do not hold it.
struct ExtraPicture {
    std::string file;
    ReadOptions read = {};
    HeightChannel channel = HeightChannel::automatic;
};

// Data that go into B, A or the lengths of the vectors, beside the normals of the base level (NormalMap::blue, alpha
// and length). MipOptions says what smaller levels get.
struct ExtraData {
    float value = 1.0f;  // the same everywhere, from 0 to 1,
    std::function<Result<Plane<float>>()> map =
        {};                                    // or, if set, what this returns: a map of the extent of the base level,
    bool heights = false;                      // or, if set, the heights that are baked; only for bake_file(),
    std::optional<ExtraPicture> picture = {};  // or, if set, this picture, which has the extent of the base level
    bool occlusion = false;  // or, if set, the occlusion of the heights that are baked; only for bake_file()
};
using ExtraInputs = Extras<std::optional<ExtraData>>;

// Puts data beside the normals of a map in memory, which is to be packed in this encoding, as the functions below do.
// Errors: bad_option (the encoding cannot hold them; a value is not from 0 to 1; a map has another extent; heights,
// which are not here; blue together with length), those of ExtraData::map, out_of_memory.
[[nodiscard]] TEX_API Result<void> put_others(NormalMap& map, const ExtraInputs& inputs, Encoding encoding);

// A file for the data that a source has beside its normals: one channel, the levels that the container holds.
struct ExtraFile {
    std::string output;
    Container container = Container::png;
    Format format = Format::r8_unorm;
};

// What bake_file() does: read_image(), to_linear() if color.space is not empty, height_field(), bake(),
// build_mip_chain(), pack(), write_texture().
struct BakeFileOptions {
    ReadOptions read;
    ColorOptions color;
    HeightOptions heights;  // wrap_x and wrap_y also apply to the height field
    // The bumpiness for a map of this extent. Empty: what the file of heights states, as those of integrate-normals do;
    // or else the slopes of the ground, if the file states the size of a texel (Image::ground); or 1. Must not throw.
    std::function<Strength(Extent)> strength;
    float vertical_scale = 1.0f;  // multiplies the strength, wherever it comes from; finite
    // The strength at which 99 % of the slopes are at most 1 (45 degrees), to three digits, instead of `strength`; 1 if
    // all heights are equal. The file is read once more before, and heights are debanded and filled twice.
    bool auto_strength = false;
    // If set, `input` is this tile. Not together with auto_strength or heights.deband, which look at whole pictures
    // (bad_option); heights.fill_invalid fills from the tile and the rows and columns around it.
    std::optional<TerrainTile> tile;
    BakeOptions bake;
    MipOptions mip;
    PackOptions pack;
    WriteOptions write;
    LevelNames level_names;      // one file for each level, and `output` is not written; empty: one file
    std::vector<MoreFile> more;  // appear after `output`, in this order
    ExtraInputs others;          // every output must have room for them
    bool slopes = false;         // whether BakeFileReport::slopes is computed
    // If set, BakeFileReport::occlusion gets what occlusion() makes of the heights. Its directions and its distance are
    // also those of ExtraData::occlusion. Texels that fill_invalid has filled are holes. Of a tile, the surface is that
    // of the tile and the tiles around it.
    std::optional<OcclusionOptions> occlusion;

    // Called when all rows were read, and before any file appears: an error means that none does. Must not throw.
    std::function<Result<void>(const HeightReport&)> accept;
};

// Whether every option is in its range. bake_file() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const BakeFileOptions& options);

struct BakeFileReport {
    Extent extent;  // of the base level
    int levels = 1;
    int left_out = 0;       // larger levels, which max_side leaves out
    std::size_t bytes = 0;  // of the output; the sum over all its files
    HeightReport heights;
    Strength strength;         // with which it was baked; on the ground, that of the middle row
    bool is_stated = false;    // the file states this strength
    bool on_ground = false;    // it is that of HeightReport::ground
    float usual_slope = 0.0f;  // the 99th percentile of the slopes of the base level, or of some rows of it
    // What BakeFileOptions::auto_strength would find, or has found; on the ground, the vertical_scale that would do the
    // same; 0: all is flat.
    float auto_strength = 0.0f;
    // How many times as steep the outermost columns or rows are as any inside; 0: less than 6 degrees. Above 2, the
    // heights do not repeat, and were baked with Wrap::repeat as if they did.
    double border_ratio = 0.0;
    SlopeRange slopes;              // zeros unless BakeFileOptions::slopes is set
    std::int64_t steep_texels = 0;  // of the base level: slopes above steepest_slope() of the encoding
    std::optional<RdoReport> rdo;   // of the first file whose blocks are optimised
    OcclusionMaps occlusion;        // empty unless BakeFileOptions::occlusion is set
    // The width of what occlusion saw around a tile, in texels, if what lies beyond could count, too; 0 if it could
    // not, or lies beyond the terrain.
    int occlusion_reach = 0;
};

// Bakes the height map `input` ("-" is standard input) and writes it to `output` as a file of type `container`.
//
// Memory holds a few rows, and in addition the data of each step that needs all rows:
//   an interlaced PNG   all rows, as they are decoded
//   fill_invalid        all heights, and for each the row of its nearest valid neighbour: 8 bytes a texel
//   deband              all heights, and what deband() needs besides: 13 bytes a texel
//   occlusion           all heights, the maps, and what occlusion() needs besides: 20 bytes a texel and the maps; 32
//                       if texels are filled; of a tile with its neighbours, thus up to nine times that
//   TIFF, JPEG out      all packed texels: the reader process encodes whole pictures
//   EXR out             compressed tiles of smaller levels, until the base level is done: up to 4 MB, and the rest in a
//                       file without a name in the folder of the output
// PNG and EXR are written from the top. If the heights repeat from bottom to top, the last rows are therefore decoded
// first: a PNG is decoded twice; the reader process holds all rows of a TIFF, JPEG ... as the file stores them. A
// picture that can hold only one level gets the base level.
//
// The output appears whole or not at all, see write_file(). If there is a file for each level, no file appears before
// all rows are done. The files then appear one after the other; if one fails, those after it do not appear. Output to
// standard output or a FIFO is held in memory until it is complete.
//
// Errors: those of the verbs. `file` is empty if the error concerns the heights and not a file. If there are several
// errors (a damaged picture, a missing directory), any one of them may be reported. The bytes are the same for every
// number of threads.
[[nodiscard]] TEX_API Result<BakeFileReport> bake_file(const std::string& input, const std::string& output,
                                                       Container container, const BakeFileOptions& options = {},
                                                       const Execution& execution = {});

// A roughness map written beside the normal map: build_roughness_chain() of the base level with the levels of `mip`
// (one, if the file holds one; however many the file of normals holds), write_texture(). The format is one of
// pack_roughness(), where ASTC has the first channel in R, G and B, and UASTC A = 1; BC5 or EAC RG11; or two to four
// channels of 8 or 16 bits or floats, unsigned.
struct RoughnessFile {
    std::string output;
    LevelNames level_names;  // as in BakeFileOptions
    Container container = Container::dds;
    std::optional<Format> format = Format::bc4_unorm;
    Effort effort = Effort::normal;
    std::optional<int> zstd;  // WriteOptions::zstd of this file, if it holds KTX2; none: as the normals' file
    RoughnessModel model = RoughnessModel::toksvig;
    float own = 0.0f;                           // the material's roughness, the same everywhere
    std::function<Result<Plane<float>>()> map;  // if set, returns the roughness map, which replaces `own`
    RoughnessParts parts = {RoughnessPart::roughness, RoughnessPart::roughness, RoughnessPart::roughness,
                            RoughnessPart::one};
    // If set, returns the texture that holds what is kept. It has the extent of the normal map. Without `format`, the
    // file has its format; if that is none of the above: unsupported.
    std::function<Result<Texture>()> kept;
};

// What pack_file() does: read_normals(), scale() if `scale` is set, build_mip_chain() if `mip` is set, pack(),
// write_texture().
struct PackFileOptions {
    SourceOptions source;
    std::optional<int> level;       // only this level of the source, as the base level; none: all levels
    std::optional<Scaling> scale;   // none: the slopes stay as they are
    std::optional<MipOptions> mip;  // levels are built from the base level; none: the source's own levels are kept
    // MipOptions::max_side if `mip` is not set: larger levels of the source are left out. If it has none that is small
    // enough, one is built from its base level, or from `level`.
    int max_side = 0;
    // Codes stay as they are, apart from those of y if it is flipped, in each output that has the format of the source,
    // or, if neither has blocks, its sample kind and bits and a channel for z if the source has one. Vectors are not
    // made unit there, as if UnpackOptions::keep_length were set. Not if a level is built or `scale` is set.
    bool keep_codes = false;

    // Returns how the output is packed, given the properties of the source. Empty: default_encoding() of the container,
    // with y as in the source. Must not throw.
    std::function<PackOptions(const SourceInfo&)> pack;
    WriteOptions write;
    LevelNames level_names;                  // as in BakeFileOptions
    std::vector<MoreFile> more;              // as in BakeFileOptions
    std::optional<RoughnessFile> roughness;  // only if `mip` is set
    // Replace what the source has there; every output must have room for them. They are those of the base level, so
    // smaller levels are not taken from the source: bad_option if there are any, and `mip` is not set.
    ExtraInputs others;
    // Files that appear after those of normals. What goes into apart.length is no longer in the lengths of the normals.
    Extras<std::optional<ExtraFile>> apart;

    std::function<Result<void>(const SourceInfo&)> accept;  // as in BakeFileOptions
};

// Whether every option is in its range. pack_file() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const PackFileOptions& options);

struct PackFileReport {
    Extent extent;  // of the base level that was written
    int levels = 1;
    int left_out = 0;       // larger levels, which max_side leaves out
    std::size_t bytes = 0;  // of the output; the sum over all its files
    int roughness_levels = 0;
    std::size_t roughness_bytes = 0;
    Format roughness_format = Format::bc4_unorm;  // if a roughness file was written
    PackOptions pack;
    SourceInfo source;
    std::optional<RdoReport> rdo;  // of the first file whose blocks are optimised
};

// Reads the normal map `input` ("-" is standard input) and writes it to `output` as a file of type `container`: in
// another encoding, with newly built levels, scaled, or reduced to one of its levels.
//
// Levels are processed one after the other. Memory holds a few rows, the additional data that bake_file() lists for
// interlaced PNGs and for outputs, and what RoughnessFile::map and RoughnessFile::kept return. A picture that can hold
// only one level gets the base level. The roughness files appear after the normal map files.
//
// What the texels alone can tell is settled before the first row is written: the layout of four channels without a
// swizzle, the order of x and y in BC5 (Texture::order_open), the range of floats, z from 0 to 1, and y if it is to be
// measured. Rows of the base level are read until they show it, all of them at most, and the file is then read again
// from its start.
//
// The output appears whole or not at all; files for each level appear as bake_file() describes. Output to standard
// output or a FIFO is held in memory until it is complete.
//
// Errors: those of the verbs; bad_option if the source lacks the requested level. If there are several errors, any one
// of them may be reported. The bytes are the same for every number of threads.
[[nodiscard]] TEX_API Result<PackFileReport> pack_file(const std::string& input, const std::string& output,
                                                       Container container, const PackFileOptions& options = {},
                                                       const Execution& execution = {});

// A detail map in a file.
struct LayerFile {
    std::string input;
    SourceOptions source;

    // These mean what they mean in Layer.
    float scale = 1.0f;
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
    float rotation = 0.0f;
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;
    float strength = 1.0f;
    std::function<Result<Plane<float>>()> mask = {};  // returns the mask; empty: 1 everywhere

    // Returns these settings as a Layer without detail and mask.
    [[nodiscard]] TEX_API Layer layer() const;
};

// Detail maps in memory, for calls of blend_file() that blend the same ones. Each is read, and its levels are built,
// once, unless its file changes meanwhile.
class SharedMaps;

// Maps that would make all of them together take more than `most_bytes` are not kept: each call reads them again. Any
// thread may use the maps. May throw std::bad_alloc.
[[nodiscard]] TEX_API std::shared_ptr<SharedMaps> share_maps(std::int64_t most_bytes);

// What blend_file() does: read_normals() of all maps, blend(), build_mip_chain(), pack(), write_texture().
struct BlendFileOptions {
    SourceOptions source;  // of the base
    std::vector<LayerFile> layers;
    BlendOptions blend;
    MipOptions mip;

    // What PackFileOptions has, given the properties of the base.
    std::function<PackOptions(const SourceInfo& base)> pack;
    WriteOptions write;
    LevelNames level_names;      // as in BakeFileOptions
    std::vector<MoreFile> more;  // as in BakeFileOptions
    ExtraInputs others;          // as in PackFileOptions; without them, those of the base go along

    std::shared_ptr<SharedMaps> shared;  // where the maps of the layers are kept; null: nowhere

    std::function<Result<void>(const SourceInfo& base)> accept;  // as in BakeFileOptions
};

// Whether every option is in its range. blend_file() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const BlendFileOptions& options);

struct BlendFileReport {
    Extent extent;  // of the base level
    int levels = 1;
    int left_out = 0;       // larger levels, which max_side leaves out
    std::size_t bytes = 0;  // of the output; the sum over all its files
    PackOptions pack;
    SourceInfo source;                // of the base
    std::vector<SourceInfo> details;  // of the layers
    std::optional<RdoReport> rdo;     // of the first file whose blocks are optimised
};

// Blends the maps of the layers onto the normal map `input` and writes the result to `output` as a file of type
// `container`. One of the input maps may be "-", standard input.
//
// The base is read row by row, and so are the details that have the result's extent and are not rotated, tiled or moved
// up or down, unless `shared` has room for them. The other details are held as whole maps, because any row of the
// result may need any of their rows. Interlaced PNGs and masks are also held whole. What
// only texels can tell is found out as pack_file() describes. TIFF and JPEG are encoded as whole pictures.
//
// The output appears whole or not at all; files for each level appear as bake_file() describes. Output to standard
// output or a FIFO is held in memory until it is complete.
//
// Errors: those of the verbs. If there are several errors, any one of them may be reported. The bytes are the same for
// every number of threads.
[[nodiscard]] TEX_API Result<BlendFileReport> blend_file(const std::string& input, const std::string& output,
                                                         Container container, const BlendFileOptions& options = {},
                                                         const Execution& execution = {});

// -- steps ---------------------------------------------------------------------------------------------------------
//
// Several steps from file to file, without files in between.

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
    int left_out = 0;       // larger levels, which max_side leaves out
    std::size_t bytes = 0;  // of all outputs
    PackOptions pack;       // of `output`
    HeightReport heights;   // if the first step bakes
    Strength strength;      // this and the next as in BakeFileReport, if the first step bakes
    bool on_ground = false;
    float usual_slope = 0.0f;  // this and the next two as in BakeFileReport, if the only step bakes
    float auto_strength = 0.0f;
    double border_ratio = 0.0;      // as there
    std::int64_t steep_texels = 0;  // maps of floats hold all slopes
    std::vector<MapRead> maps;
};

// Whether there is a step, only the first one bakes, none before the last builds levels or writes roughness, and the
// options of each are in their ranges. Errors: bad_option.
[[nodiscard]] TEX_API Result<void> validate(const std::vector<Step>& steps);

// Applies `steps` one after the other: the first to the file `input`, each further one to the result of the one before.
// The last one writes `output`, and the files of its option `more`. The bytes are the same as if each step before the
// last had written a file of floats (EXR, Encoding::float_, or rgba32f if there is alpha beside the normals) that the
// next one reads.
//
// Of the steps before the last, only the settings that concern normals count: source, heights, strength, bake, level,
// scale, layers and blend, others.alpha, and the direction of y that `pack` gives. Rows go from step to step, so memory
// holds what bake_file(), pack_file() and blend_file() say for each.
//
// Errors: bad_option (as validate(steps)), and those of the three functions.
[[nodiscard]] TEX_API Result<StepsReport> apply_steps(const std::string& input, const std::vector<Step>& steps,
                                                      const std::string& output, Container container,
                                                      const Execution& execution = {});

// -- model output --------------------------------------------------------------------------------------------------
//
// Writes a glTF model with other pictures in the slots of its normal maps, and with other tangents.
//
// All else keeps its bytes: the text of the JSON with the order of its keys, its numbers and extensions that libtex
// does not know; buffers, which stay compressed; other images and chunks. A picture stays where the old one was: in a
// buffer, in a data URI or in a file. Bytes that follow it in a buffer move by a multiple of 8.
//
// An image, a texture or bytes of a buffer that something else uses, too (a colour of the material, a material whose
// map stays), are left as they are, and new ones are added for the maps: in GLB in the binary chunk, if there is one. A
// texture names the new picture as its source, whatever extension named the old one (KHR_texture_basisu,
// MSFT_texture_dds, EXT_texture_webp, EXT_texture_avif); WebP is named by EXT_texture_webp, and KTX2 by
// KHR_texture_basisu, which the model then requires. An extension that no texture uses any more leaves the lists of the
// extensions.
//
// Tangents are an attribute of vertices. A vertex whose corners have different ones is copied to the end of all of its
// attributes, with all of its morph targets; other vertices and their numbers stay. Attributes that grow are no longer
// compressed by meshoptimizer. What Draco compresses keeps its tangents, or has none.
//
// Files beside the model. If the output is in another folder than the input, all files that the model names are copied
// to the same places beside the output. A file that changes (a picture, a buffer with one) is written there, a picture
// with the extension of its type. In the folder of the input, and where the name belongs to another file of the model,
// its name begins with the stem of the output: "fixed_stone_n.png".
//
// The name of the output decides its form. If text becomes GLB, all of its buffers become one, in the file, and so do
// images, but for those that cannot be read or are not in its folder. If GLB becomes text, the binary chunk with all
// that is in it, images included, becomes a file beside it, which is called as the output: "fixed.bin".

// Which slots of a material get a picture.
enum class PictureUse {
    normals,    // the slot of the map
    occlusion,  // occlusionTexture, which reads red
    orm,        // occlusionTexture and metallicRoughnessTexture, which reads green and blue
};

// A picture that some maps of a model get. All of them have the same image, or images of the same file or bytes.
//
// Occlusion is for the materials of the maps, which need no image then: `slot` and `scale` do not count, and sets of
// UVs and transforms become those of the maps. A material without the slots gets them.
struct ModelPicture {
    std::vector<ModelMap> maps;
    Container container = Container::png;  // png, jpeg, webp, or ktx2 with UASTC
    std::vector<std::byte> bytes = {};     // of the file
    // Whether the slots get scale, uv_set and uv_transform of `maps`, too. Then materials without a normal map, of
    // which ModelMap::image is -1, get one.
    bool sets_slots = false;
    PictureUse use = PictureUse::normals;
};

// Tangents that a part gets. Where nodes mirror the part, its mesh is mirrored itself, and the node no longer mirrors:
// the scene stays as it is, and engines that disagree about tangents below such nodes draw it alike. A mesh that other
// nodes show unmirrored gets a copy.
struct ModelTangents {
    int mesh = 0, primitive = 0;   // MeshPart::mesh and primitive
    std::vector<Float4> tangents;  // one for each element of MeshPart::indices
};

// What changes in a model.
struct ModelChanges {
    std::vector<ModelPicture> pictures;
    std::vector<ModelTangents> tangents = {};  // at most one for each part
    // Triangles with UVs and normals that have no material get one, which is called as the model's next number: maps
    // may be for that. It is what glTF draws without a material.
    bool adds_material = false;
};

// A file of the model that is written.
struct ModelFile {
    std::string path;
    std::string from = {};    // the file beside the input that is copied or replaced; empty: none
    bool is_changed = false;  // otherwise it is a copy
};

struct ModelFiles {
    std::vector<ModelFile> files;           // in the order in which they take their places; the model is the last one
    std::vector<std::string> missing = {};  // files that the model names and that do not exist: they are not copied
    std::vector<std::string> outside = {};  // URIs of what is not in its folder: they stay as they are
    std::vector<std::string> joined = {};   // files beside the input that are in the model now: it has become GLB
    int compressed = 0;                     // parts that get no tangents, because Draco compresses them
    int mirrors = 0;                        // nodes that mirrored parts with these tangents, and no longer do
    int left_mirrors = 0;                   // nodes that still do: they have instances, or animations point at them,
                                            // as KHR_animation_pointer does
};

// The files that write_model() would write. The bytes of the pictures do not matter, nor do values of tangents.
//
// Errors: those of read_model_maps(); io (a file beside the model is no regular file); unsupported (the output is
// called neither .glb nor .gltf; GLB would become text, and has chunks that text cannot hold; a file beside the model
// that would be written has an extension that models do not use; there are tangents, and no buffer that can hold them);
// bad_option (a map is not one of the model, or has no image; two pictures are for one map; another container; tangents
// are not those of a part).
[[nodiscard]] TEX_API Result<ModelFiles> model_files(const std::string& input, const std::string& output,
                                                     const ModelChanges& changes, const MeshReadOptions& options = {});

// Writes the model `input` to `output`, with the files beside it. Missing folders below that of the output are created.
//
// All files are written to the disk first. Then they take their places, one after the other, as write_file() describes,
// and the model comes last: an interrupted run leaves the old model, and some of the files beside it may be new. Names
// beside the model come from the model. So links there are replaced and not followed, and a file that exists is
// replaced only if the old model at `output` names it, or if it has the same bytes; with options.no_clobber, such a
// file stays.
//
// Errors: those of model_files() and write_file(); io (a file that would be replaced is not known to belong to the
// output); bad_data (a buffer with a picture is damaged); unsupported (a GLB
// file would have 4 GiB or more).
[[nodiscard]] TEX_API Result<ModelFiles> write_model(const std::string& input, const std::string& output,
                                                     const ModelChanges& changes, const MeshReadOptions& options = {},
                                                     const WriteOptions& writing = {});

}  // namespace tex::inline v1
