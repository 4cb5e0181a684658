// SPDX-License-Identifier: Apache-2.0

#include "checks/rules.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "checks/mesh_rule_rows.h"

namespace tex::inline v1 {
namespace {

using enum RuleFamily;
using enum Severity;

constexpr Rule kTextureRules[] = {
    // -- the file ---------------------------------------------------------------------------------------------
    {"N101", "unreadable", file, error, true, "The file cannot be decoded.",
     "It is damaged, truncated, empty or of a kind that is not supported. Nothing else can be said about it.", "", ""},
    {"N102", "header-disagrees", file, warning, true, "The header contradicts the data, or leaves a choice.",
     "A size, count or flag in the header contradicts the data or another part of the header, or the file holds more "
     "than one picture that could be meant. Other readers refuse the file or read other texels.",
     "pack-normals FILE --keep-length --format SAME -o FIXED", ""},
    {"N103", "mips-incomplete", file, warning, true, "The mip chain ends before 1x1.",
     "A texture with some levels but not all is incomplete in OpenGL and samples as black there unless the application "
     "limits the levels.",
     "mip-normals FILE --keep-length --format SAME -o FIXED", ""},
    {"N104", "trailing-bytes", file, warning, true, "The file has bytes beyond its levels.",
     "They are not part of the texture: an appended file, levels or a second surface that the header does not mention, "
     "or an exporter's wrong size.",
     "pack-normals FILE --keep-length --format SAME -o FIXED", ""},
    {"N105", "not-power-of-two", file, error, false, "A side is not a power of two.",
     "Old hardware and some engines cannot mip-map or repeat such textures. Off unless pow2 is required.", "", ""},
    {"N106", "not-multiple-of-4", file, warning, true, "A side of a block-compressed texture is not a multiple of 4.",
     "Direct3D refuses to create block-compressed textures of such sizes.", "", "N105"},
    {"N107", "too-large", file, error, true, "A side is longer than allowed.",
     "16384 texels are the limit of Direct3D 12; max-extent requires less.", "", ""},
    {"N108", "wrong-format", file, error, true, "The format is not the required one.",
     "format=NAME requires an encoding (format and swizzle) or a format.", "pack-normals FILE --format SAME -o FIXED",
     ""},
    {"N109", "wrong-levels", file, error, true, "The number of levels is not the required one.",
     "mips=full requires a chain down to 1x1, mips=none a single level, mips=N that many.",
     "mip-normals FILE --keep-length --mips LEVELS --format SAME -o FIXED", "N103"},
    {"N110", "wrong-extent", file, error, true, "The extent is not the required one.",
     "extent=WIDTHxHEIGHT requires it.", "", ""},
    {"N111", "srgb-format", file, error, true, "The file declares its colours as sRGB.",
     "A GPU that believes it decodes every normal with the sRGB curve: flat becomes a lean of 51 degrees.",
     "pack-normals FILE --keep-length --format SAME -o FIXED", ""},
    {"N112", "wrong-declared-y", file, error, true, "The file declares another direction of green than required.",
     "KTX2 and EXR files of libtex say which way y points.",
     "pack-normals FILE --keep-length --y-in WANTED --y WANTED --format SAME -o FIXED", ""},
    {"N113", "unfit-for-engine", file, error, true, "The file is not what the engine reads.",
     "The engine named by --for does not read its file type, does not read normals from its format, gets too few "
     "levels, or decodes 2c - 1 where floats hold x, y and z themselves. Engines do not build levels for block "
     "formats.",
     "Make the file again with bake-normals or pack-normals and the same --for.", "N103"},
    {"N114", "uastc-without-alpha", file, error, true, "The file has no y.",
     "A file of Basis Universal (UASTC, ETC1S) says which channels it has. This one has a single value for each texel, "
     "which is x at best. Normal maps of glTF are RGB; others have x in R, G and B and y in A (RRRG).",
     "Encode the source again with R, G and B.", ""},
    {"N115", "astc-layout", file, warning, true, "The channels are not those of ASTC normal maps.",
     "Encoders store x in R, G and B and y in A in their mode for normal maps (astcenc -normal), and shaders read them "
     "there. Compressed as colours, a map has y = 1 everywhere for such a shader, and three components share the bits "
     "of two. Compress its source again if you have it; compressing the file again loses a little.",
     "pack-normals FILE --format SAME -o FIXED", "N211"},
    {"N116", "turned-by-tag", file, warning, true, "The file asks its readers to turn or mirror the picture.",
     "Cameras and scanners state an orientation (TIFF, EXIF) instead of turning the texels. Some programs follow it, "
     "others show the texels as they are stored, so a map does not lie on the mesh as it did where it was painted. The "
     "commands follow it, except in PNG, whose texels they read as they are stored. Vectors stay as they are stored, "
     "and what the commands write has no orientation.",
     "pack-normals FILE --keep-length --format SAME -o FIXED", ""},

    // -- the vectors ------------------------------------------------------------------------------------------
    {"N201", "not-unit-length", values, note, true, "Vectors are not of unit length.",
     "More than 5 % of the vectors are shorter or longer than 1 by more than two codes of 8 bits. Shaders that do not "
     "normalise light them wrongly. Filters and blends without renormalisation do this, painting too. If the mean "
     "length is above 1.06, as after a contrast, this is a warning. Some maps hold occlusion in the lengths "
     "(Terrain3D); --length-in occlusion says so.",
     "pack-normals FILE --normalize --format SAME -o FIXED", ""},
    {"N202", "z-below-zero", values, warning, true, "Vectors point into the surface.",
     "z is below zero by more than two codes, and below -0.1 in three of ten such texels: steep sides that were "
     "rounded do not count. Encodings that rebuild z cannot hold that, and lighting from the front turns black.",
     "", "N201"},
    {"N203", "beyond-unit", values, warning, true, "x and y lie outside the unit circle.",
     "x^2 + y^2 is above 1 by more than two codes in more than 0.1 % of the texels of an encoding without z, so z "
     "cannot be rebuilt.",
     "", "N207"},
    {"N204", "not-finite", values, error, true, "Texels are NaN or infinite.",
     "One such texel spreads through mip levels and bilinear filters.", "", "N201 N202 N203 N206 N207 N307"},
    {"N205", "null-vector", values, error, true, "Vectors point nowhere.",
     "They are shorter than 0.1: middle grey, where a mask or a border was painted into the map. Normalising them "
     "gives NaN in a shader.",
     "pack-normals FILE --normalize --format SAME -o FIXED", "N201"},
    {"N206", "constant", values, note, true, "All texels are the same.",
     "A placeholder or a failed bake: a texture of 1x1 would do.", "", "N115 N201 N207 N208 N209 N305 N403 N219"},
    {"N207", "leaning", values, warning, true, "The map leans as a whole.",
     "The mean of the normals is more than 10 degrees off (0, 0, 1). A map over a flat surface has no lean; one "
     "channel was shifted, or the surface behind a bake was not flat.",
     "Bake the map again over a flat surface. If an image editor changed its levels or colours, take the file from "
     "before.",
     ""},
    {"N208", "biased-flat", values, note, false, "Flat texels are biased.",
     "8 bits have no exact zero: code 127 means -0.0039, code 128 +0.0039. A quarter of the map or more is flat, and "
     "all of it leans the same way, by 0.32 degrees. Off by default, because nobody sees it; blended as detail, such a "
     "map tilts the base.",
     "unpack-normals FILE --keep-length --snap-flat --level all --format SAME -o FIXED", ""},
    {"N209", "blue-not-z", values, warning, true, "Blue does not hold z.",
     "Blue is constant while x and y vary so much that z ought to: the file has two components, and its third channel "
     "is a filler. Readers that do not rebuild z get bent normals.",
     "pack-normals FILE --normalize --swizzle rg --format SAME -o FIXED",
     "N115 N201 N202 N205 N207 N213 N214 N215 N220"},
    {"N210", "grey-picture", values, error, true, "The picture is grey.",
     "R, G and B are equal everywhere: this is a height or bump map, not a normal map.",
     "bake-normals FILE --bumpiness auto --format SAME -o FIXED",
     "N115 N201 N202 N203 N205 N206 N207 N208 N209 N213 N214 N215 N301 N302 N303 N304 N305 N306 N308 N309 N310 N401 "
     "N402 N403 N404 N501 N502 N503 N504 N219"},
    {"N211", "dxt5nm-red", values, note, true, "R is not 255 in the layout of DXT5nm.",
     "Unity's shaders multiply R and A to read x from either; where R is not 255, x comes out too small (or 0). "
     "Shaders that read A and G alone are right. Require format=dxt5nm where R matters.",
     "pack-normals FILE --format SAME -o FIXED", ""},
    {"N212", "alpha-not-one", values, note, true, "x is in R, but alpha is not 255.",
     "Unity's UnpackNormalmapRGorAG multiplies x by A. A height or gloss there bends the normals, unless the shader "
     "reads R, G and B alone. With --swizzle, which says what the channels hold, the rule is silent.",
     "pack-normals FILE --keep-length --drop --format SAME -o FIXED", ""},
    {"N213", "object-space", values, error, true, "The normals are not in tangent space.",
     "z points away from the surface in many texels and the vectors face all directions: an object-space or "
     "world-space map.",
     "Convert it on its mesh with convert-normals --from object --mesh MESH, or bake it again in tangent space.",
     "N115 N201 N202 N205 N207 N215 N305 N310 N401 N402 N403 N404 N501 N502 N504"},
    {"N214", "not-a-normal-map", values, error, true, "The picture is no normal map.",
     "Colours or data, not vectors: few are of unit length, with and without the damages that other rules know, R and "
     "G rise and fall together, or do not centre on the middle. No other rule judges the texels.",
     "Give the slot of the normal map the picture that belongs there. If these are normals in other channels, "
     "--swizzle names them, such as dxt5nm.",
     "N115 N201 N202 N205 N207 N213 N215 N304 N305 N306 N310 N401 N402 N403 N404 N501 N502 N504"},

    {"N215", "background", values, warning, true, "The background is not filled.",
     "A colour that is no normal (black, grey, white; also normalised) fills areas around the charts. Filters and "
     "block compression mix it into charts, and smaller levels mix in more: dark lines along seams. Other rules leave "
     "it out. The fix is tried first: no command is printed if it would turn texels beside charts that hold normals of "
     "their own.",
     "pack-normals FILE --keep-length --fill-background --format SAME -o FIXED", ""},
    {"N216", "occlusion-roughness-metal", values, error, true, "The picture holds occlusion, roughness and metalness.",
     "Blue is 0 or 1 nearly everywhere, red is far from the middle, and no vector is of unit length. So are the "
     "textures that glTF and engines read occlusion, roughness and metalness from (ORM), which stand in the slot of "
     "the normal map if slots were mixed up. A picture in colours without blue looks the same.",
     "Give the slot of the normal map the picture that belongs there.",
     "N115 N201 N202 N205 N207 N208 N209 N213 N214 N215 N301 N302 N303 N304 N305 N306 N308 N309 N310 N401 N402 N403 "
     "N404 N501 N502 N504 N219"},

    {"N217", "alpha-is-mask", values, note, true, "Alpha is a mask of 0 and 1.",
     "Most often it is the cut-out of the colour texture, which nobody reads here. It takes 8 bits a texel where 1 "
     "would do, levels blur its border, and Unity's UnpackNormalmapRGorAG takes x for 0 where A is 0.",
     "If nothing reads the mask, pack-normals --drop leaves it out; unpack-normals --alpha-out writes it to a file of "
     "its own.",
     "N212"},
    {"N218", "alpha-repeats", values, note, true, "Alpha repeats another channel.",
     "A equals R, G or B in every texel, so that it says nothing new. Exporters that fill A with a grey copy do this, "
     "and channel packers that were given the same file twice.",
     "pack-normals FILE --keep-length --drop --format SAME -o FIXED", "N212"},
    {"N219", "blue-other-data", values, warning, true, "Blue holds other data than z.",
     "It varies, and does not follow x and y as the z of unit vectors does: occlusion, roughness or heights. If alpha "
     "varies, too, as heights of LabPBR do, this is a note. One texel in ten or more has less than 0.45 of a unit "
     "vector's length; or vectors are longer and shorter at random; or z falls below 0, or with a rebuilt z the slopes "
     "have less curl. Nearly flat maps whose blue stays light look like vectors of uneven length (N201). Readers that "
     "do not rebuild z get bent normals. Floats are not judged; the other rules judge x and y alone.",
     "Read the map with --swizzle rg, which rebuilds z; unpack-normals --swizzle rg --blue-out writes the data to a "
     "separate file.",
     "N201 N202 N205 N207 N213 N214 N305 N308 N309 N310 N402 N403 N404"},

    {"N220", "blue-inverted", values, error, true, "Blue is inverted.",
     "z is below 0 nearly everywhere, while x and y lie about 0, as in tangent space. An exporter or an image editor "
     "inverted blue, or the whole picture. Lit from the front, the surface is black. If it was the picture, "
     "invert it in an image editor: inverting blue alone would make dents of its bumps.",
     "repair-normals FILE --likely -o FIXED", "N115 N201 N202 N205 N207 N213 N214 N215 N305 N310 N402"},
    {"N221", "blue-from-zero", values, warning, true, "Blue holds z from 0 to 1.",
     "Vectors are of unit length if z is blue, and not if it is 2 blue - 1. Readers that do not rebuild z get bent "
     "normals, which point into the surface where it is steep.",
     "pack-normals FILE --normalize --swizzle rg --format SAME -o FIXED", "N115 N201 N202 N205 N207 N213 N214 N219"},
    {"N222", "x-lost", values, error, true, "x of the normals is lost.",
     "R and B are constant, and there is no alpha, which holds x in the layout of DXT5nm. Tools that extract textures "
     "from games leave alpha out, and so does DXT1. Nothing can bring x back.",
     "Export the map again with its alpha.", ""},
    {"N223", "x-ray-layout", values, note, true, "The channels are those of the X-Ray engine.",
     "x, y and z are in A, B and G, and R holds gloss. Other engines need another layout. The other rules judge the "
     "map in this one.",
     "For other engines, let pack-normals read it with --swizzle abg; R, the gloss, is left out then.", ""},

    // -- damage -----------------------------------------------------------------------------------------------
    {"N301", "srgb-decoded", damage, error, true, "The map is too dark, as the sRGB curve makes it.",
     "x and y centre on 0.21 instead of 0.5: somebody read the file as colour and stored linear values. Export the map "
     "again as data (Non-Color, Raw, sRGB off) if you have its source: turning the curve back leaves coarser steps.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N203 N205 N206 N207 N213 N214 N215 N305 N307 N308 N309 N310 N401 N402 N403 N404 N501 N502 N504 N219"},
    {"N302", "srgb-encoded", damage, error, true, "The map is too light, as the sRGB curve makes it.",
     "x and y centre on 0.74 instead of 0.5: linear values were stored as if they were colour. Export the map again "
     "as data (Non-Color, Raw, sRGB off) if you have its source: turning the curve back leaves coarser steps.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N203 N205 N206 N207 N214 N215 N305 N307 N308 N309 N310 N401 N402 N403 N404 N501 N502 N504 N219"},
    {"N303", "premultiplied", damage, error, true, "R, G and B were multiplied by alpha.",
     "No channel exceeds alpha, and dividing by it makes the vectors longer and even. Image libraries do this on "
     "reading unless told otherwise (OpenImageIO: oiio:UnassociatedAlpha). Under a low alpha, little is left.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N205 N207 N212 N213 N214 N215 N301 N305 N308 N309 N310 N401 N402 N403 N404 N501 N502 N504 N219"},
    {"N304", "jpeg-blocks", damage, warning, true, "The map shows the 8x8 blocks of lossy JPEG.",
     "The cosine transform of aligned blocks is quantised as JPEG of about quality 65 or less does it, or steps stand "
     "out at every eighth column and row. A picture that was enlarged without a filter looks alike. Chroma subsampling "
     "halves the resolution of x; go back to a lossless source.",
     "", "N201 N202 N310"},
    {"N305", "banding", damage, warning, true, "The slopes lie on a lattice.",
     "The map was baked from heights of few values, 8 bits say: slopes take few values too, which shows as terraces in "
     "reflections. Bake from 16 bits, or smooth the steps of the heights.",
     "Bake it again from heights of 16 bits or floats, or with --deband on. Without the heights, repair-normals "
     "--likely "
     "finds them where the slopes are central differences.",
     ""},
    {"N306", "bc-blocks", damage, warning, true, "The map shows the 4x4 blocks of texture compression.",
     "Either an uncompressed file holds texels that were BC-compressed before, or the steps between the blocks of a "
     "compressed one are twice those inside. DXT1 and DXT5 with normals in R, G and B do this.",
     "Compress it again from its uncompressed source, as BC5 or DXT5nm.", "N201 N202 N304 N310"},
    {"N307", "seam", damage, error, false, "The map does not meet itself at its borders.",
     "Where the map repeats, x or y changes more from its last line to its first than between any two lines inside, by "
     "a fifth or more, and at least 1.8 times as much as between 98 % of them, joints of bricks too; or a wall stands "
     "along the border, as in bakes of heights that do not repeat. Off unless tiles is required.",
     "Make the map from heights that repeat, and bake it with --wrap repeat; or do not require tiles of it.", ""},
    {"N308", "channels-exchanged", damage, error, true, "Two channels are exchanged, or the picture was turned.",
     "Either another channel than the third holds z (blue, green, red order), or the slopes have curl as they stand "
     "and none when x and y are exchanged. Then the channels of x and y changed places (also where the order of BC5's "
     "blocks was mistaken), or the picture was turned by 90 degrees while its vectors stayed. Maps whose structures "
     "are diagonal (rope, braids) fit either way and are not judged.",
     "If channels are exchanged, pack-normals --swizzle gr reads them in their right order. If the picture was turned, "
     "repair-normals --turned left (or right) turns its vectors, too. repair-normals --height FILE finds out which.",
     "N201 N202 N205 N207 N209 N213 N214 N215 N401 N402 N403 N404"},
    {"N309", "turned", damage, error, true, "The picture was turned, but its vectors were not.",
     "Its normals lean by the angle of the turn: what is lit from above on one side is lit from the left on the other. "
     "Image editors turn pictures so, and tools that pack atlases. Angles from 15 to 75 degrees are found in maps of "
     "height fields; a quarter turn is N308.",
     "Turn the picture back. To turn a map with its vectors, blend it over a flat one with blend-normals --rotate.",
     "N308 N310 N401 N402 N403 N404"},
    {"N310", "no-surface", damage, note, true, "The slopes are those of no surface.",
     "They have as much curl as noise has. Noise was painted or stored instead of normals, or compression left nothing "
     "of faint bumps. Less curl than that is no finding: intact maps from high-poly models have up to 40 %.",
     "Bake the map again, or compress it less.", "N403"},
    {"N311", "wrong-sign", damage, error, true, "The file declares the wrong sign.",
     "Its texels are those of the signed format, and the header names the unsigned one, or the other way round. Then "
     "flat texels point outwards along a diagonal. The message names the right format; only the header changes.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N203 N205 N206 N207 N208 N213 N214 N215 N301 N302 N305 N306 N307 N308 N309 N310 N401 N402 N403 N404 "
     "N501 N502 N503 N504"},
    {"N312", "scaled-up", damage, note, true, "The map was enlarged.",
     "Its texels repeat, or lie on lines between those of a smaller map: it holds the details of that one alone.",
     "Bake the map at this size, or use the smaller one. Pixel art is meant to be so.", ""},
    {"N313", "darkened", damage, error, true, "All channels were multiplied by the same number.",
     "An opacity below 1 that was flattened on black does this, and programs that darken a picture. All vectors "
     "then lean to the lower left. A bit is lost where half is left: export the map again at full opacity if you have "
     "its source.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N205 N207 N209 N213 N214 N215 N301 N305 N308 N309 N310 N401 N402 N403 N404 N501 N502 N504 N219 N221"},
    {"N314", "levels-changed", damage, error, true, "Gamma, brightness, lightness or contrast were changed.",
     "x and y do not centre on the middle, and one curve for all channels (gamma, levels, a shift) or the lightness of "
     "HSL brings them back and makes z fit x and y. Or automatic levels stretched each channel to reach from 0 to 255, "
     "and z fits once each is taken back. Image editors change levels so, and viewers that write what they show. Flat "
     "areas then lean. Export the map again without it if you have its source: taking the change back leaves coarser "
     "steps.",
     "repair-normals FILE -o FIXED",
     "N201 N202 N205 N207 N209 N213 N214 N215 N305 N308 N309 N310 N401 N402 N403 N404 N501 N502 N504 N219 N221"},
    {"N315", "posterised", damage, note, true, "x and y take few values.",
     "The picture was reduced to few colours: posterised, or stored with 4 or 5 bits a channel. Smooth surfaces show "
     "facets in reflections. Pixel art is meant to be so. Export the map again with 8 bits or more if you have its "
     "source: smooth values between the steps are a guess.",
     "repair-normals FILE --likely -o FIXED", "N201 N305"},
    {"N316", "chroma-subsampled", damage, warning, true, "Colours have half the resolution of lightness.",
     "JPEG, lossy WebP and video store colours so (4:2:0). Of bumps of two texels and less, only lightness is left, "
     "which is the same in R, G and B: x and y are smaller there and follow each other, and z does not follow them. "
     "Nothing brings them back. Maps without such bumps are not judged.",
     "Go back to the source, and export PNG, or JPEG with 4:4:4.", "N201 N202 N203 N219"},
    {"N317", "palette", damage, warning, true, "The map has few colours, which lie apart.",
     "GIF, PNG with a palette and programs that make PNGs smaller (pngquant, TinyPNG) keep 256 colours or fewer, which "
     "they choose for the eye. Smooth surfaces then show facets or grain in reflections. Nothing brings back what lay "
     "between the colours.",
     "Go back to the source, and make PNGs smaller without loss (oxipng, lossless WebP).", "N305 N306"},

    // -- convention -------------------------------------------------------------------------------------------
    {"N401", "wrong-y", convention, error, true, "Green or red points the wrong way.",
     "The slopes along x and along y are those of one surface, so that each limits the other. Those of this map fit "
     "together only if one of them is turned over. Mostly that is y: green up is OpenGL, Unity, Blender, glTF; green "
     "down is DirectX, Unreal. But a picture that was mirrored in an image editor, or whose red was inverted, looks "
     "the same, and turning its green over makes dents of its bumps. The height map tells the two apart: "
     "check-normals --height FILE. So does a look at the occlusion map or the mesh: bumps are light in one and stand "
     "out of the other. The correlation is 1 if the map fits y=up everywhere, -1 if it fits y=down; from 0.2 or "
     "-0.2 on it counts, if parts of the map agree (confidence 0.99) and at least half of the texels hold normals. "
     "Lines and bevels along the axes show nothing.",
     "pack-normals FILE --keep-length --y-in MEASURED --y WANTED --format SAME -o FIXED", "N112 N404"},
    {"N402", "mixed-y", convention, error, true, "Green points up in one part of the map and down in another.",
     "Maps of both conventions were pasted together, or a part of the map was mirrored. No setting of y is right for "
     "all of it, and --y-in measured refuses it. Judged only where most regions show one direction clearly.",
     "Turn green over in one of the parts, or of the layers that were blended, before they are put together: the "
     "report shows which. In a part that was mirrored from left to right, red points the wrong way instead.",
     "N310 N401 N403 N404"},
    {"N403", "y-undecidable", convention, note, true, "Which way green points cannot be told.",
     "The map is flat, noise, or no height field, as many maps baked from high-poly meshes: the message names the "
     "limit of N401 that it misses. Reported where y is required.",
     "Look at it with preview-normals, or state what its author says: --y-in up or --y-in down.", ""},
    {"N404", "y-contradicts-file", convention, error, true, "Green points the other way than the file declares.",
     "The file's own mark of y (KTX2, EXR) is not what the texels show. Either the mark is wrong, or red is mirrored; "
     "N401 explains why the slopes do not show which.",
     "pack-normals FILE --keep-length --y-in MEASURED --format SAME -o FIXED", ""},

    // -- the smaller levels -------------------------------------------------------------------------------------
    {"N501", "level-not-unit", mips, warning, true, "Levels were not renormalised.",
     "Averages of vectors are shorter than 1: without renormalising, distant surfaces turn dull and dark.",
     "mip-normals FILE --keep-length --format SAME -o FIXED", ""},
    {"N502", "level-unrelated", mips, error, true, "A level does not follow from the base level.",
     "It correlates by less than 0.44 with the filtered base level: another image, a level sampled instead of "
     "filtered, or one that was shifted by more than a texel.",
     "mip-normals FILE --keep-length --format SAME -o FIXED", "N501 N504"},
    {"N503", "level-shifted", mips, warning, true, "A level is shifted against the base level.",
     "Its texels lie off the centres of those that they stand for: the map crawls as levels change. Filters of the "
     "wrong phase do this, and sizes that are not powers of two.",
     "mip-normals FILE --keep-length --format SAME -o FIXED", "N502 N504"},
    {"N504", "fade-unfinished", mips, warning, true, "The chain fades, but its end is not flat.",
     "Detail fades from level to level and then stops fading: distant surfaces keep a faint pattern.",
     "mip-normals FILE --keep-length --fade FIRST,LAST --format SAME -o FIXED", ""},

    // -- the pair ---------------------------------------------------------------------------------------------
    {"N601", "height-mismatch", pair, error, true, "The normals do not follow from the height map.",
     "Their slopes correlate by less than 0.6 with its differences, or only after a shift: another version, another "
     "crop or another map.",
     "Make sure that this is the height map of these normals. If it is, bake them again from it, with their old "
     "strength.",
     "N602"},
    {"N602", "height-inverted", pair, warning, true, "White is low in the height map.",
     "The normals follow from it with the opposite sign. Where they are right it is a depth map, and shaders want to "
     "be told; else bake them again.",
     "If this is a height map, bake the normals again from it. If it is a depth map, keep both.", ""},
    {"N603", "occlusion-mismatch", pair, note, true, "The occlusion does not follow the normals.",
     "It is compared with the occlusion, the heights and the curvature of the surface that the normals show. None "
     "correlates with it by 0.15, or one does only with the mirrored or inverted occlusion. Then it is of another map, "
     "was mirrored without the normals, or 1 is closed in it. Where the direction of green does not show, only "
     "mirrored and inverted maps are found, and where occlusion hardly varies: that of a mesh or by hand does not "
     "follow from normals either.",
     "Make sure that this is the occlusion of these normals. integrate-normals --occlusion-out makes one from them.",
     ""},
};

constexpr auto kRules = [] {
    std::array<Rule, std::size(kTextureRules) + std::size(kMeshRules)> all{};
    std::copy(std::begin(kMeshRules), std::end(kMeshRules),
              std::copy(std::begin(kTextureRules), std::end(kTextureRules), all.begin()));
    return all;
}();

}  // namespace

std::span<const Rule> rules() { return kRules; }

const Rule* find_rule(std::string_view id_or_name) {
    for (const Rule& row : kRules) {
        if (row.id == id_or_name || row.name == id_or_name) return &row;
    }
    return nullptr;
}

}  // namespace tex::inline v1
