// SPDX-License-Identifier: Apache-2.0

#include "tasks/engines.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

using enum Container;
using enum Encoding;

// What importers take: pictures with z in B.
constexpr Container kPictures[] = {png, tiff, tga, bmp, jpeg, exr};
constexpr Encoding kRgb[] = {rgb8, rgba8, rgb16, rgba16, half, float_, rgba16f, rgba32f};
constexpr Encoding kRgbCodes[] = {rgb8, rgba8, rgb16, rgba16};
// Unity imports DDS as it is; its shaders multiply R by A, so they read x from DXT5nm and BC5.
constexpr Container kUnityTypes[] = {png, tiff, tga, bmp, jpeg, exr, dds};
constexpr Encoding kUnityEncodings[] = {rgb8, rgba8, rgb16, rgba16, half, float_, rgba16f, rgba32f, dxt5nm, bc5};
// Godot's materials rebuild z from R and G.
constexpr Container kGodotTypes[] = {png, tga, bmp, jpeg, webp, exr, dds, ktx2};
constexpr Encoding kGodotEncodings[] = {rgb8,    rgba8,   rgb16, rgba16, half,     float_,
                                        rgba16f, rgba32f, bc5,   bc7,    eac_rg11, uastc};
constexpr Container kGltfTypes[] = {png, jpeg};
constexpr Container kBasisTypes[] = {ktx2};
constexpr Encoding kBasisEncodings[] = {uastc};
constexpr Container kThreeTypes[] = {png, jpeg, webp, tga, tiff, exr, ktx2};
// KTX2Loader's formats without Basis Universal; the renderers rebuild z of those of two channels.
constexpr Container kThreePackedTypes[] = {ktx2};
constexpr Encoding kThreePackedEncodings[] = {bc5, eac_rg11, rg8, rgba8};
constexpr Encoding kThreeEncodings[] = {rgb8, rgba8, rgb16, rgba16, half, float_, rgba16f, rgba32f};
// FORMAT_MAP in KTX2Loader.js has no formats of three channels, and none of 16 bits that are normalised; of
// supercompression it takes BasisLZ and Zstandard.
constexpr Encoding kThreeKtx2[] = {rgba8, rgba16f, rgba32f, bc7, uastc};
// Babylon.js' materials take z from B; its loader of KTX2 is for Basis Universal, plain or with Zstandard.
constexpr Container kBabylonTypes[] = {png, jpeg, webp, tga, ktx2};
// PlayCanvas takes x from A of every texture of BC3, and z from B of others; its loader of KTX2 is for Basis Universal.
constexpr Container kPlayCanvasTypes[] = {png, jpeg, webp, dds, ktx2};
constexpr Encoding kPlayCanvasEncodings[] = {rgb8, rgba8, rgb16, rgba16, dxt5nm};
// Models alone.
constexpr Container kModelTypes[] = {png, jpeg, ktx2};
constexpr Encoding kModelEncodings[] = {rgb8, rgba8, rgb16, rgba16, uastc};
constexpr Container kPhaserTypes[] = {png, jpeg, webp};
constexpr Container kBevyTypes[] = {ktx2, dds, png, tiff, tga, bmp, jpeg, exr};
constexpr Encoding kBevyEncodings[] = {bc5,  eac_rg11, rg8,    rg16,    rgb8,    rgba8, rgb16,
                                       half, float_,   rgba16, rgba16f, rgba32f, bc7};
constexpr Container kPhoneTypes[] = {ktx2};
constexpr Encoding kPhoneEncodings[] = {eac_rg11, eac_rg11_snorm, astc_4x4, astc_5x4, astc_5x5, astc_6x5, astc_6x6,
                                        astc_8x5, astc_8x6,       astc_8x8, rg8,      rgb8,     rgba8};

// Engines that compress textures themselves get a picture that is not compressed: a second lossy step would add its
// error to the first one's, and the engine would read x and y from the wrong channels of DXT5nm and BC5.
constexpr Engine kEngines[] = {
    // docs.unity3d.com/Manual/StandardShaderMaterialParameterSmoothness.html: smoothness is alpha of the metallic map;
    // HDRP's mask map has occlusion in green besides.
    // docs.unity3d.com/Manual/texture-type-normal-map.html: Flip Green Channel is for other conventions than Unity's.
    // unity.huh.how/textures/normal-map-format.html: "Unity uses Y+ normal maps, known as OpenGL format".
    {"unity", png, rgb8, YAxis::up, false, "",
     "The importer compresses for each platform and builds the levels. It expects x, y and z in R, G and B and green "
     "up.",
     kUnityTypes, kUnityEncodings, RoughnessUse::smoothness},
    // Texture editor: Compression Settings, Normalmap (BC5), and Flip Green Channel for maps with green up.
    // Roughness: docs.unrealengine.com/4.26/en-US/RenderingAndGraphics/Textures/Composite.
    {"unreal",
     png,
     rgb8,
     YAxis::down,
     false,
     "",
     "The importer compresses to BC5 and builds the levels. It expects green down, as in DirectX.",
     kPictures,
     kRgb,
     {RoughnessUse::any, "set Composite Texture of the roughness texture to the normal map"}},
    // StandardMaterial3D, roughness_texture_channel: an ORM material reads green.
    // docs.godotengine.org, Importing images: Roughness > Src Normal; PNG has 8 bits after import; StandardMaterial3D:
    // X+, Y+ and Z+.
    {"godot",
     png,
     rgb8,
     YAxis::up,
     false,
     "",
     "The importer compresses, builds the levels and keeps 8 bits of a PNG file. It expects green up, as in OpenGL.",
     kGodotTypes,
     kGodotEncodings,
     {RoughnessUse::green, "set Roughness > Src Normal in its import settings to the normal map"}},
    // glTF 2.0 specification, 3.9.2: metalness is sampled from blue, roughness from green, occlusion from red.
    // glTF 2.0 specification, 3.8.3: images are PNG or JPEG; 3.9.3: normalTexture is RGB, +Y is up.
    {"gltf", png, rgb8, YAxis::up, false, "",
     "The core specification allows PNG and JPEG, of which only PNG is lossless; it requires x, y and z in R, G and B "
     "and green up.",
     kGltfTypes, kRgbCodes, RoughnessUse::green},
    // KHR_texture_basisu: RGB of UASTC or ETC1S, linear, sides that are multiples of 4, all levels or one.
    {"gltf-ktx2", ktx2, uastc, YAxis::up, true, "",
     "KHR_texture_basisu allows UASTC and ETC1S of Basis Universal, with x, y and z in R, G and B and green up. "
     "Viewers "
     "make of UASTC what their GPU reads; they build no levels.",
     kBasisTypes, kBasisEncodings, RoughnessUse::green},
    // normal_fragment_maps.glsl.js reads xyz; RG and BC5 need a release of 2026 (three.js pull request 32448).
    {"three", png, rgb8, YAxis::up, false, "",
     "TextureLoader reads PNG, and the renderer builds the levels. Releases before 2026 read z from B, so textures of "
     "two channels do not work in them.",
     kThreeTypes, kThreeEncodings, RoughnessUse::green, kThreeKtx2, false},
    // Drawn by tests/engines, which shows where the picture lies upside down. isPackedRGFormat() in WebGLPrograms.js:
    // RGFormat, RG11_EAC_Format and RED_GREEN_RGTC2_Format; for WebGPURenderer
    // NormalMapNode.js (three.js pull requests 31695, 32308, 31713). Neither knows ASTC or signed formats as packed.
    {"three-packed", ktx2, bc5, YAxis::up, true, "",
     "KTX2Loader loads BC5, EAC RG11 and RG8 as they are, and renderers of 2026 and later rebuild z for them. BC5 is "
     "for desktop GPUs, --format eac-rg11 for others. On geometry of three.js, repeat.y and normalScale.y are -1. The "
     "core of glTF does not allow such files in a model (issue 2602 of glTF).",
     kThreePackedTypes, kThreePackedEncodings, RoughnessUse::green, kThreePackedEncodings, false},
    // Drawn by tests/engines: in the default, left-handed scene, both x and y of +Y maps come out the other way, and of
    // -Y maps x does.
    {"babylon", png, rgb8, YAxis::up, false, "",
     "Babylon.js reads x, y and z from R, G and B and builds the levels. Green points up; on its own geometry in a "
     "left-handed scene, which is the default, materials need invertNormalMapX and invertNormalMapY. KTX2 of UASTC is "
     "for models of glTF; on its own geometry it lies upside down.",
     kBabylonTypes, kRgbCodes, RoughnessUse::any, kBasisEncodings, false},
    // Drawn by tests/engines.
    {"playcanvas", png, rgb8, YAxis::up, false, "",
     "PlayCanvas reads x, y and z of PNG from R, G and B, builds the levels and expects green up. With --format dxt5nm "
     "it reads DDS, too, and with --format uastc KTX2.",
     kPlayCanvasTypes, kPlayCanvasEncodings, RoughnessUse::any, kBasisEncodings, false},
    // Drawn by tests/engines, models alone: they read what the core of glTF allows.
    {"cesium", png, rgb8, YAxis::up, false, "",
     "Cesium reads the pictures of glTF models, x, y and z from R, G and B with green up. It needs TANGENT in models "
     "whose UVs are mirrored.",
     kModelTypes, kModelEncodings, RoughnessUse::green},
    {"filament", png, rgb8, YAxis::up, false, "",
     "filament reads the pictures of glTF models, x, y and z from R, G and B with green up. It needs TANGENT in models "
     "with KHR_texture_transform or another set of UVs.",
     kModelTypes, kModelEncodings, RoughnessUse::green},
    // Drawn by tests/engines: the maps of 2D lights.
    {"phaser", png, rgb8, YAxis::up, false, "",
     "The lights of Phaser read x, y and z from R, G and B and expect green up. They turn the normals with a rotated "
     "sprite, but not with flipX and flipY.",
     kPhaserTypes, kRgbCodes},
    // Blender's manual, Normal Map node: OpenGL convention by default, Non-Color images.
    {"blender", png, rgb16, YAxis::up, false, "",
     "Blender renders from the texels of the file, so 16 bits avoid steps in reflections. It expects green up.",
     kPictures, kRgb},
    // bevy_pbr: pbr_material.rs sets TWO_COMPONENT_NORMAL_MAP for Bc5RgUnorm; flip_normal_map_y is for DirectX maps.
    {"bevy", ktx2, bc5, YAxis::up, true, "",
     "Bevy loads GPU formats as they are and builds no levels. StandardMaterial rebuilds z for BC5 (not for DXT5nm or "
     "signed BC5) and expects green up. BC5 is for desktop GPUs.",
     kBevyTypes, kBevyEncodings, RoughnessUse::green},
    // ImageBuilder.settings maps _normal to the preset Normals (BC5 signed, box filter, R and G swapped on the way).
    // No documentation states y; pull request 18082 turned on Flip Y for Sponza's OpenGL maps.
    {"o3de", png, rgb8, YAxis::down, false, "_normal",
     "The asset processor chooses the preset Normals by the suffix, compresses and builds the levels. Its own OpenGL "
     "maps need Flip Y, so green points down.",
     kPictures, kRgb},
    // OpenGL ES 3.0 and Vulkan's textureCompressionETC2; ASTC: ES 3.2 and textureCompressionASTC_LDR. The direction is
    // OpenGL's.
    {"android", ktx2, eac_rg11, YAxis::up, true, "",
     "Every GPU with OpenGL ES 3.0 reads EAC RG11, which stores x and y in 8 bits a texel; the shader rebuilds z. "
     "Green points up, as in OpenGL. ASTC needs fewer bytes and a GPU with OpenGL ES 3.2: --format astc-6x6.",
     kPhoneTypes, kPhoneEncodings},
    // Metal: MTLPixelFormatEAC_RG11Unorm from A7 on, MTLPixelFormatASTC_4x4_LDR from A8 on.
    {"ios", ktx2, eac_rg11, YAxis::up, true, "",
     "Every Apple GPU since A7 reads EAC RG11, which stores x and y in 8 bits a texel; the shader rebuilds z. "
     "ASTC needs fewer bytes and a GPU since A8: --format astc-6x6.",
     kPhoneTypes, kPhoneEncodings},
};

std::vector<std::string> engine_names() {
    std::vector<std::string> names;
    for (const Engine& engine : kEngines) names.emplace_back(engine.name);
    return names;
}

}  // namespace

std::span<const Engine> engines() { return kEngines; }

std::vector<const Engine*> parse_engines(const std::string& text) {
    std::vector<const Engine*> chosen;
    for (const std::string& word : split(text, ',')) {
        const std::string name = known_word(word, engine_names());
        const Engine* const engine =
            std::find_if(std::begin(kEngines), std::end(kEngines), [&](const Engine& row) { return row.name == name; });
        if (std::find(chosen.begin(), chosen.end(), engine) != chosen.end())
            throw UsageError(fmt::format("{} is named twice", name));
        chosen.push_back(engine);
    }
    return chosen;
}

EngineNeeds needs_of(const Engine& engine) {
    return {std::string(engine.name),
            {engine.types.begin(), engine.types.end()},
            {engine.encodings.begin(), engine.encodings.end()},
            engine.has_mips,
            {engine.in_ktx2.begin(), engine.in_ktx2.end()},
            engine.inflates_zlib};
}

std::vector<Word> engine_words() {
    std::vector<Word> words;
    for (const Engine& engine : kEngines) words.push_back({std::string(engine.name), ""});
    words.push_back({"list", "print what each engine gets, and why, and exit"});
    return words;
}

std::string engine_table() {
    constexpr std::size_t kWidth = 80, kIndent = 13;
    std::string table =
        fmt::format("{:<13}{:<7}{:<10}{:<7}{:<8}{}\n", "ENGINE", "FILE", "FORMAT", "GREEN", "LEVELS", "NAME");
    for (const Engine& engine : kEngines) {
        table += fmt::format("{:<13}{:<7}{:<10}{:<7}{:<8}{{stem}}{}\n", engine.name, extension_of(engine.container),
                             name_of(kEncodingNames, engine.format), name_of(kYAxisNames, engine.y),
                             engine.has_mips ? "all" : "base", engine.suffix);
        for (const std::string& line : wrapped(std::string(engine.reason), kWidth - kIndent))
            table += std::string(kIndent, ' ') + line + "\n";
    }
    return table;
}

}  // namespace tex::cli
