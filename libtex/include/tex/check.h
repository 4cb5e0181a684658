// SPDX-License-Identifier: Apache-2.0
// check.h: maps are compared and checked.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/height.h>
#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- compare -------------------------------------------------------------------------------------------------------
//
// The angles between two normal maps, in degrees.

struct Comparison {
    AngularError error;
    Plane<float> degrees;  // the angle of each texel
};

// Compares two maps of unit vectors, texel by texel:
//
//     angle = 2 asin(|a - b| / 2)
//
// This is accurate near 0, unlike acos(dot(a, b)): in float, acos returns no angle between 0 and 0.02 degrees. Here
// equal vectors are exactly 0 degrees apart. The error is below 0.0001 degrees up to 170 degrees, and below 0.03
// degrees beyond.
//
// Errors: bad_option (the maps have no texels, or different extents), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Comparison> compare(const NormalMap& a, const NormalMap& b,
                                                 const Execution& execution = {});

// With a mesh part, only texels covered by its triangles in UV set `uv_set` are compared (mesh.h defines coverage).
// What is between the charts of a map is never seen, and two bakers fill it differently. The other texels have an angle
// of 0 in Comparison::degrees and do not count in Comparison::error.
//
// Errors: also bad_data (check_part(part) fails), bad_option (there is no such set of UVs; no triangle covers a texel),
// unsupported (UVs, as in mesh.h).
[[nodiscard]] TEX_API Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const MeshPart& part,
                                                 int uv_set = 0, const Execution& execution = {});

// -- heat map ------------------------------------------------------------------------------------------------------
//
// Angles as a picture with a legend.

// The rows of the legend under the picture, and its minimum width.
inline constexpr int kHeatMapLegendRows = 36;
inline constexpr int kHeatMapLeastWidth = 128;

// A picture of angles in degrees, one pixel for each texel: planes R, G, B in [0, 1]. Black is 0, pale yellow is
// `full_scale` degrees or more. (The colours are those of matplotlib's "inferno", Smith and van der Walt 2015, in ten
// linear pieces. Their lightness grows evenly, so they are also readable in grey and with red-green colour blindness.)
// A legend of kHeatMapLegendRows rows is below the map: the colours from 0 on the left to full_scale on the right, with
// the values at both ends. If a map is narrower than kHeatMapLeastWidth, the rest of the picture is black.
//
// Precondition: `degrees` has no NaN.
// Errors: bad_option (`degrees` has no texels; full_scale is not above 0 and at most 180), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Image> heat_map(const Plane<float>& degrees, double full_scale,
                                             const Execution& execution = {});

// The angles for a smaller picture. The longer side is divided into at most `side` cells; each cell holds its largest
// angle, so that none is lost. Cells are square and span a whole number of texels, except those at the right and lower
// border.
// Errors: bad_option (`degrees` has no texels; side is below 1), out_of_memory.
[[nodiscard]] TEX_API Result<Plane<float>> largest_of_cells(const Plane<float>& degrees, int side);

// -- check ---------------------------------------------------------------------------------------------------------
//
// Finds what is wrong with a texture of normals, from its file and its texels.
//
// Every rule has an id that never changes ("N201"), a name, a severity, a sentence, an explanation and, if there is
// one, a fix in the form of a command. rules() lists them all; the commands, the manual, the reports and the tests
// read that one table.
//
// Rules that count (values, file) look at every texel. Rules that judge (damage, convention, pair) look at up to 2^20
// texels, spread over the map, and report their confidence.

enum class Severity { note, warning, error };

inline constexpr Named<Severity> kSeverityNames[] = {
    {Severity::note, "note", "worth knowing"},
    {Severity::warning, "warning", "looks wrong, and may be meant"},
    {Severity::error, "error", "is wrong"},
};

enum class RuleFamily { file, values, damage, convention, mips, pair, mesh, model };

inline constexpr Named<RuleFamily> kRuleFamilyNames[] = {
    {RuleFamily::file, "file", "the file and its header"},
    {RuleFamily::values, "values", "the vectors, texel by texel"},
    {RuleFamily::damage, "damage", "traces of what happened to the map"},
    {RuleFamily::convention, "convention", "which way green points"},
    {RuleFamily::mips, "mips", "the smaller levels"},
    {RuleFamily::pair, "pair", "the map beside its height map"},
    {RuleFamily::mesh, "mesh", "the map on its mesh"},
    {RuleFamily::model, "model", "the map in a glTF model"},
};

struct Rule {
    std::string_view id;    // "N201": never changes
    std::string_view name;  // "not-unit-length"
    RuleFamily family;
    Severity severity;             // unless the options change it
    bool on;                       // off: checked only if the options enable it or require what it checks
    std::string_view sentence;     // what is wrong, as one sentence
    std::string_view explanation;  // how it is detected, why it matters, what causes it
    // A command or a sentence, or empty. In a command, FILE stands for the file, FIXED for a new one, SAME for the
    // encoding that keeps every bit, WANTED and MEASURED for directions of green, LEVELS for a number of levels.
    std::string_view fix;
    // Ids of rules that this fault triggers too, separated by blanks: their findings are left out.
    std::string_view explains;
};

// All rules, by id.
[[nodiscard]] TEX_API std::span<const Rule> rules();

// The rule with this id or name; null if there is none.
[[nodiscard]] TEX_API const Rule* find_rule(std::string_view id_or_name);

// What an engine reads, for rule N113, and its name, for rule N808, which knows what it draws wrongly of models:
// "three", "playcanvas", "cesium", "filament"; "gltf" stands for all of them.
struct EngineNeeds {
    std::string engine;                  // its name in messages
    std::vector<Container> types;        // of files, by their extension; a name without one is not judged
    std::vector<Encoding> encodings;     // that it reads as normals
    bool levels = false;                 // it builds no levels; nor does any engine for block formats
    std::vector<Encoding> in_ktx2 = {};  // those of KTX2, if it reads others there
    bool inflates_zlib = true;           // of KTX2; Zstandard is read by all that read KTX2
};

// What a project requires of its files. By default only the sides are limited, to 16384 texels as in Direct3D 12.
struct Requirements {
    std::optional<Format> format;
    std::optional<Encoding> encoding;  // a format and a swizzle
    std::optional<int> levels;         // 0: a complete chain, down to 1x1
    std::optional<Extent> extent;
    std::optional<YAxis> y;
    int max_extent = 16384;  // texels along a side
    bool power_of_two = false;
    bool tiles = false;  // the map repeats without a seam
    std::vector<EngineNeeds> engines = {};
};

enum class RequirementKey { format, mips, extent, max_extent, y, pow2, tiles };

inline constexpr Named<RequirementKey> kRequirementKeyNames[] = {
    {RequirementKey::format, "format", "an encoding (dxt5nm) or a format (bc3-unorm)"},
    {RequirementKey::mips, "mips", "full, none, or the number of levels"},
    {RequirementKey::extent, "extent", "WIDTHxHEIGHT in texels"},
    {RequirementKey::max_extent, "max-extent", "the longest side in texels"},
    {RequirementKey::y, "y", "up or down: which way green points"},
    {RequirementKey::pow2, "pow2", "both sides are powers of two; has no value"},
    {RequirementKey::tiles, "tiles", "no seam where the map repeats; has no value"},
};

// Adds one requirement, written "KEY=VALUE" ("mips=full"), or "KEY" if it has no value ("pow2").
// Errors: bad_option (the reason lists what is allowed).
[[nodiscard]] TEX_API Result<void> add_requirement(Requirements& requirements, std::string_view text);

// The mesh that a map is on, for the rules of the family "mesh". Refers to the caller's objects.
//
// y of the map points as Requirements::y demands; else as the file states; else down for Decoder::unreal, which reads
// maps that way, and up for all others.
struct MeshToCheck {
    const SelectedPart& selected;     // with at least one triangle
    Decoder decoder = Decoder::gltf;  // the engine that decodes the map
    std::string file = {};            // that errors name; may be empty
    double scale = 1.0;               // x and y of the map are multiplied by it at seams (normalTexture.scale)
};

// The model in which a map is, for the rules of the family "model". Refers to the caller's objects.
struct MapInModel {
    const Model& model;
    const ModelMap& map;
};

struct CheckOptions {
    Requirements require;
    std::vector<std::string> enable;                         // ids or names
    std::vector<std::string> disable;                        // takes precedence over enable
    std::vector<std::pair<std::string, Severity>> severity;  // by id or name; the last one applies
    bool any_length = false;                                 // lengths are data, or do not matter: no rule judges them
    std::optional<Swizzle> swizzle = {};  // the channels of x, y and z; none: as guess_swizzle() and the texels say
    const HeightField* height = nullptr;  // the map's heights, for the rules of the pair; not owned
    // The occlusion beside the map, from 0 (closed) to 1 (open), for rule N603; not owned.
    const Plane<float>* occlusion = nullptr;
    bool occlusion_in_blue = false;     // without `occlusion`: blue holds it, as in LabPBR
    const MeshToCheck* mesh = nullptr;  // the mesh that the map is on; not owned
    const MapInModel* model = nullptr;  // the model that uses the map; not owned
    // Above 0: findings have Marks, with at most so many squares on a side (kMostMarks at most). They take a look at
    // every texel for each finding.
    int marks = 0;
};

inline constexpr int kMostMarks = 4096;

// What a rule made of texels.
enum class Mark : std::uint8_t { none, spoke, background, transparent, padding };
inline constexpr int kMarkCount = 5;

inline constexpr Named<Mark> kMarkNames[] = {
    {Mark::none, "none", "was looked at, and did not speak for the finding"},
    {Mark::spoke, "spoke", "spoke for the finding"},
    {Mark::background, "background", "was left out: background, and what filters mixed with it"},
    {Mark::transparent, "transparent", "was left out: alpha is 0"},
    {Mark::padding, "padding", "was left out: streaks of padding between charts"},
};

// Which texels of the base level spoke for a finding, and which its rule left out, in squares for a picture.
struct Marks {
    Extent extent{1, 1};        // in squares
    int side = 1;               // of a square, in texels; those at the right and lower border may be cut
    std::vector<Mark> squares;  // in rows from the top: spoke if a texel of it did; else what most of them are
    std::array<std::int64_t, kMarkCount> texels{};  // of each mark
    [[nodiscard]] std::int64_t count(Mark mark) const { return texels[static_cast<std::size_t>(mark)]; }
};

// Texels [x, x + width) x [y, y + height) of a level; y counts rows from the top.
struct Region {
    int level = 0;
    int x = 0, y = 0, width = 0, height = 0;
};

// How an image editor changes levels: a value c became ((c - black) / (white - black))^(1 / gamma), limited to 0 to 1.
// Or the lightness of colours was multiplied while hue and saturation stayed (HSL, as of ImageMagick's -modulate).
struct ToneCurve {
    double black = 0.0, white = 1.0, gamma = 1.0;
    double lightness = 1.0;  // 1 unless the others are 0, 1, 1
};

// The curves of x, y and z, where each was changed by itself, as automatic levels do.
using ChannelTones = std::array<ToneCurve, 3>;

struct Finding {
    const Rule* rule = nullptr;
    Severity severity = Severity::warning;
    std::string message;      // a sentence with its figures: "3.1 % of the texels are not of unit length: 0.71 to 1.02"
    double figure = 0.0;      // what was measured, in `unit`
    std::string_view unit;    // "share", "degrees", "texels", "ratio", ... or empty
    double confidence = 1.0;  // 0.5 to 1; 1 if texels were counted
    std::vector<Region> regions;  // where; empty for the whole file
    bool has_texel = false;       // (column, row) is the first affected texel, on regions.front().level
    int column = 0, row = 0;
    // The rule tried its fix, and this is what the fix would do beside its purpose; then nobody ought to apply it.
    std::string fix_harms = {};
    std::optional<ToneCurve> tone = {};      // what the channels went through (N313, N314, and some N201, N209, N302)
    std::optional<ChannelTones> tones = {};  // or each of them (some N314)
    // N308 about x and y: the direction that green has if the picture was turned. If they were exchanged, it has the
    // other one.
    std::optional<YAxis> turned_y = {};
    // With CheckOptions::marks. Where no texel spoke, the rule judges statistics of the whole map, the smaller levels
    // or the file; nothing if it left out no texels, either.
    std::optional<Marks> marks = {};
};

// The direction of green, from the curl of the slopes. It shows that one of red and green is mirrored, but not which:
// y assumes that red points to the right. Heights that decide (PairEvidence) replace y.
struct YEvidence {
    double correlation = 0.0;  // +1: up, -1: down; 0.2 is enough, if the regions agree
    double confidence = 0.5;   // that its sign is not chance, 0.5 to 1, by how far the regions of the map agree
    std::optional<YAxis> y;    // nullopt: undecidable, or parts of the map differ (N402)
};

inline constexpr double kHeightsFollow = 0.6;  // PairEvidence::correlation of heights that belong to the map

// How the normals follow from the height map: slope = strength x difference of heights.
struct PairEvidence {
    double correlation = 0.0;  // mean of both axes, of magnitudes
    double strength = 0.0;     // height of value 1 in texel widths; below 0: white is low
    YAxis y = YAxis::up;
    int offset_x = 0, offset_y = 0;  // texels by which the normals are to the right of and below the heights

    // Whether the heights are those of the map: then y is right, and a strength below 0 means that red points left if y
    // is not what it ought to be, or else that white is low.
    [[nodiscard]] bool decides() const { return correlation >= kHeightsFollow && offset_x == 0 && offset_y == 0; }
};

// How an occlusion map follows the normals: beside the occlusion, heights and curvature of the surface they show.
struct OcclusionEvidence {
    double correlation = 0.0;                     // of both; below 0: open and closed may be exchanged
    bool mirrored_x = false, mirrored_y = false;  // the occlusion fits better when it is mirrored so
    double best = 0.0;                            // the correlation of the one that is mirrored so
};

// How well the map fits the mesh: the angles in degrees between the decoded normals on both sides of UV seams. Each
// seam edge counts by its length in object space.
struct SeamEvidence {
    std::int64_t edges = 0;        // that were measured
    double mean = 0.0, p99 = 0.0;  // of all points of all edges, in degrees
    double worst = 0.0;            // the mean of the worst edge
    Region worst_edge;             // the texels around one side of it
    // Maps that were baked for their mesh and decoder have a mean under this: 0.6 degrees, which rounding to 8 bits
    // explains, and five times what the map beside the seams changes from one texel to the next. (Measured: the table
    // of check-normals(1).)
    double usual = 0.0;
};

// What a picture holds, as its texels show. Grey pictures of 8 bits may be heights, roughness or occlusion: nothing in
// them tells.
enum class PictureKind { unknown, normals, object_space, heights, grey, colors, data, constant };

inline constexpr Named<PictureKind> kPictureKindNames[] = {
    {PictureKind::unknown, "unknown", "cannot be decoded"},
    {PictureKind::normals, "normals", "normals in tangent space"},
    {PictureKind::object_space, "object-space", "normals in object space"},
    {PictureKind::heights, "heights", "heights: grey with more than 8 bits, an elevation model, or a map tile"},
    {PictureKind::grey, "grey", "grey of 8 bits: heights, roughness, occlusion or a mask"},
    {PictureKind::colors, "colour", "colours"},
    {PictureKind::data, "data", "other data in several channels, such as occlusion, roughness and metalness"},
    {PictureKind::constant, "one-colour", "one colour"},
};

struct CheckReport {
    std::string file;
    std::string map = {};  // of a map in a model: its material and image, "Leather: leather_n.png"; else empty
    // The material of such a map, as MeshSelection names it; empty if that has another normal map, too.
    std::string material = {};
    std::vector<Finding> findings;  // by rule id, then level
    int explained = 0;              // findings left out because another one explains them
    std::optional<Error> error;     // the file could not be read (see check_file()) or checked

    // What the file is, if it could be read.
    Format format = Format::rgba8_unorm;
    Swizzle swizzle{};  // guess_swizzle(): what the file states or the texels suggest
    PictureKind kind = PictureKind::unknown;
    double kind_confidence = 0.5;  // that it is that kind, 0.5 to 1
    // How R, G and B hold heights, if they are the bytes of heights: terrain_rgb or terrarium.
    std::optional<HeightChannel> height_bytes = {};
    Extent extent;
    int levels = 0;
    bool more_data = false;  // a channel varies that holds no component of the normals: roughness, a mask
    YEvidence y;
    std::optional<PairEvidence> pair;
    std::optional<OcclusionEvidence> occlusion;  // nothing: there is none, or nothing to compare
    std::optional<SeamEvidence> seams;           // nothing: there is no mesh, or it has no seams
    std::optional<YAxis> y_on_mesh;              // where green of the map points on the mesh, as MeshToCheck says
};

// Checks that all rules in the options exist. Errors: bad_option.
[[nodiscard]] TEX_API Result<void> validate(const CheckOptions& options);

// Checks a texture. `file` is its name in the report.
//
// Preconditions (asserted): the texture has at least one level, each with level_bytes() bytes; if there is a mesh,
// check_part() succeeds.
// Errors: bad_option (see validate()), out_of_memory, cancelled; with a mesh, also those of mesh.h.
// The same report for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<CheckReport> check(const std::string& file, const Texture& texture,
                                                const CheckOptions& options = {}, const Execution& execution = {});

struct ModelCheckOptions {
    CheckOptions checks = {};                    // without `mesh` and `model`
    std::string material = {};                   // only the maps of this one: a name, or a number from 0
    Decoder decoder = Decoder::gltf;             // the engine that decodes the maps
    std::optional<TangentSource> tangents = {};  // none: those of the model, or MikkTSpace where it has none
};

// Checks a normal map of a model, on its mesh, with the rules of the families "mesh" and "model". Unless y is demanded,
// N401 warns if green points down, which is not glTF's. If the image cannot be read, the report has N101 and the Error,
// as that of check_file(). If its triangles cannot be examined, the report has a finding (N807).
//
// Preconditions (asserted): the model is one of read_model(), and the map one of its maps.
// Errors: bad_option (see validate())
[[nodiscard]] TEX_API Result<CheckReport> check_map(const Model& model, const ModelMap& map,
                                                    const ModelCheckOptions& options = {}, const ReadOptions& read = {},
                                                    const Execution& execution = {});

// Reads a model and checks every normal map that its materials use, as check_map() does. Returns a report for each, in
// the order of Model::maps; none if no material uses a map.
//
// Errors: those of read_model(); bad_option (also: there is no such material); out_of_memory, cancelled
[[nodiscard]] TEX_API Result<std::vector<CheckReport>> check_model(const std::string& path,
                                                                   const ModelCheckOptions& options = {},
                                                                   const ReadOptions& read = {},
                                                                   const Execution& execution = {});

// Reads a file and checks it. If its content cannot be read (bad_data, unsupported), the report has a finding, N101,
// and the Error. If the file cannot be opened, memory runs out or the check is cancelled, the report has only
// CheckReport::error. Errors: bad_option (see validate()).
[[nodiscard]] TEX_API Result<CheckReport> check_file(const std::string& path, const CheckOptions& options = {},
                                                     const ReadOptions& read = {}, const Execution& execution = {});

}  // namespace tex::inline v1
