// SPDX-License-Identifier: Apache-2.0

#include "cli/foreign_words.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/value.h"

namespace tex::cli {
namespace {

constexpr ForeignOption kForeignOptions[] = {
    {"--strength --intensity --amount --scale --height-scale --normal-strength", "--bumpiness"},
    {"--strength --intensity --scale --normal-strength", "--bump-scale"},
    {"--strength --intensity --amount --factor --normal-strength", "--scale"},
    {"--strength --intensity --scale --normal-strength", "scale-normals --scale"},
    {"--size --resize --resolution --res --dimensions", "--extent"},
    {"--size --resize --resolution --res --dimensions", "--max-size, which leaves out larger levels"},
    {"--resize --resolution --res --dimensions", "--size"},
    {"--ext --extension --file-type -ft", "--container, or the extension of the output"},
    {"--suffix --prefix --postfix -sx -px", "--name, such as '{stem}_n.dds'"},
    {"--out --outfile --dst", "--output"},
    {"--output-dir --outdir --output-folder --out-folder --dest", "--out-dir"},
    {"-i --input --infile", "inputs are named without an option"},
    {"--inplace --overwrite -i", "--in-place"},
    {"--in-place --inplace", "repair-normals --in-place writes over its inputs; here, -o or --out-dir names outputs"},
    {"-r -R --recursive --recurse", "--files-from, or a pattern such as 'art/**/*.png'"},
    {"-v", "--version, or --json for all that is known"},
    {"--verbose", "--json, which prints all that is known"},
    {"-V", "--version"},
    {"-q -s --silent --no-warnings", "--quiet"},
    {"-j -t --jobs --parallel --cores --nthreads --num-threads", "--threads"},
    {"-y --force --overwrite", "files are replaced anyway; --no-clobber keeps them"},
    {"-f -fd --fd -F --fmt --codec --encoder --pixel-format --encode", "--format"},
    {"--compress --compression", "--format of the texels, --supercompress of the file"},
    {"-f --format --reporter", "--json, --sarif, --junit or --github"},
    {"-m --mipmap --mipmaps --genmipmap --generate-mipmaps --miplevels -miplevels --levels", "--mips"},
    {"-nomips -nomipmap --nomips --no-mips --no-mipmaps", "--mips none"},
    {"-z --zfactor --z-factor --exaggeration --vertical-exaggeration --zscale --z-scale", "--vertical-scale"},
    {"--filter", "--kernel for slopes, --mip-filter for levels"},
    {"--filter -mipfilter --mipmap-filter", "--mip-filter"},
    {"--filter", "--kernel"},
    {"--tile --tiles --repeat", "--tiling"},
    {"--tile --tileable --seamless --repeat --wrap-mode -wrap", "--wrap"},
    {"-clamp --clamp", "--wrap clamp"},
    {"--margin --dilation --dilate --bleed --gutter --edge-padding", "--padding"},
    {"--extrusion --cage-extrusion --ray-distance --max-distance --max-ray-distance", "--front and --back"},
    {"--cage-mesh --cage-file", "--cage"},
    {"--samples --aa --antialiasing --supersampling --oversampling", "--subsamples"},
    {"--ao-samples --occlusion-samples --secondary-rays", "--rays-per-hit"},
    {"--ao --ao-out --occlusion --ambient-occlusion", "--occlusion-out"},
    {"--ao --occlusion --ambient-occlusion",
     "--blue FILE writes it into blue, for LabPBR; glTF reads occlusion from red of another texture"},
    {"--displacement --displacement-out --disp", "--height-out"},
    {"--bent --bent-normal --bent-normals", "--bent-out"},
    {"--id --id-map", "--id-out"},
    {"--gamma --srgb --colorspace --oetf --assign_oetf --assign-oetf", "--color-space, of heights"},
    {"--gamma --srgb --colorspace --color-space --oetf --assign_oetf --assign-oetf",
     "normals are not colours, and are never converted"},
    {"-highest -production --high-quality --slow", "--effort best"},
    {"-fast --fast", "--effort fast"},
    {"--flip-y --flip-green --invert-y --invert-green --flip-g -inverty --inverty", "--y-in up --y down"},
    {"--flip-y --flip-green --invert-y --invert-green --flip-g -inverty --inverty", "--y"},
    {"-tonormal --tonormal -nmap --nmap --to-normal", "heights become normals without an option; --kernel chooses how"},
    {"-tonormal --tonormal -nmap --nmap --to-normal", "bake-normals HEIGHTS makes normals of heights"},
    {"-nmapamp --nmapamp --amplitude --mulc", "--bumpiness"},
    {"-normal --normal --normal-map --normal_mode --normal-mode -reconstructz --reconstructz --reconstruct-z",
     "normals need no option; z is rebuilt where the format has none"},
    {"--webp", "--container webp"},
    {"--bc3 --bc3n --dxt5 --dxt5nm -bc3 -bc3n", "--format dxt5nm"},
    {"--bc5 -bc5", "--format bc5"},
    {"--bc7 -bc7", "--format bc7"},
    {"--uastc", "--format uastc"},
    {"--astc", "--format astc-4x4"},
    {"--texel-size --pixel-size --cell-size --cellsize", "--world-size, the width of the whole map"},
    {"--warn-as-error --werror --warnings-as-errors", "--fail-on warning"},
    {"--bits --depth --bit-depth", "--format, such as rgb16 or half"},
    {"--opacity --alpha-blend --weight --mix", "--strength"},
    {"--smoothness --smoothness-in --gloss --glossiness", "--roughness-in, from which --for unity makes smoothness"},
    {"--method --blend --blend-mode --algorithm", "--mode"},
    {"--roughness --roughness-map", "--roughness-in, of the material, and --roughness-out, which suits the levels"},
    {"--roughness --roughness-out --gloss-out --smoothness-out",
     "mip-normals --roughness-out, which makes roughness follow from the normals that levels average"},
    {"--metric", "the angle in degrees is the measure; --max-mean and --max limit it"},
    {"--fix --autofix", "repair-normals FILE -o FIXED"},
    {"--flip-y --flip-green --invert-y --invert-green --flip-g", "--y-in"},
    {"--flip-y --flip-green --invert-y --invert-green --flip-g", "--y-b"},
    {"--gl --ogl --opengl", "--y up"},
    {"--dx --d3d --directx", "--y down"},
    {"--gl --ogl --opengl --y --y-in", "--require y=up"},
    {"--dx --d3d --directx", "--require y=down"},
    {"--zcmp --zstd", "--supercompress zstd"},
    {"--engine --target --platform", "--for"},
    {"--width --max-width --maxsize", "--max-size"},
    {"--generate-tangents --make-tangents --compute-tangents --gen-tangents", "--tangents mikktspace"},
    {"--detail-tiling --detail-scale --detail-repeat", "--tiling"},
    {"--check", "--dry-run, which says what would be made"},
    {"--force --rebuild --always-make -B",
     "what an output depends on decides, and --dry-run shows it; remove an output to make it again"},
    {"--rdo --lambda --rdo-lambda --uastc_rdo_l", "--rdo-mean"},
    {"--threshold --tolerance --epsilon", "--max-mean"},
    {"--diff --diff-out", "--heatmap"},
    {"--html", "--report"},
    {"--report --html --page", "check-normals FILES --report PAGE"},
    {"--t2 --ktx2", "-o NAME.ktx2: the extension decides"},
    {"--uastc_quality --uastc-quality --clevel --qlevel", "--effort fast, normal or best"},
    {"--rules --list-rules", "--list"},
    {"--ignore --skip", "--disable"},
    {"--select", "--enable"},
    {"--strict --max-warnings", "--fail-on"},
    {"-n --dryrun --just-print", "--dry-run"},
    {"-C --directory", "--root"},
    {"--clean", "--prune, for what no rule makes any more"},
    // Known, and only some commands have it: nothing that is merely spelt like it is suggested.
    {"--quality --normalize --normalise", ""},
};

constexpr ForeignWord kForeignWords[] = {
    {"opengl gl ogl", "up", true},
    {"directx d3d dx", "down", true},
    {"ati2 ati2n 3dc", "bc5", true},
    {"bc3nm bc3n", "dxt5nm", true},
    {"dxt5 bc3 bc3_unorm", "dxt5nm", false},
    {"bc5_unorm bc5u bc5n rgtc2 latc2", "bc5", false},
    {"bc7_unorm bc7_unorm_srgb bptc", "bc7", false},
    {"bc5_snorm bc5s", "bc5-snorm", false},
    {"eac etc2 etc2-rg eac_rg11 rg11 eac_r11g11", "eac-rg11", false},
    {"dxn", "bc5", false},
    {"dxt5_agbr dxt5_xgbr dxt5_xgxr", "dxt5nm", false},
    {"r8g8 r8g8_unorm", "rg8", false},
    {"r16g16 r16g16_unorm", "rg16", false},
    {"r8g8b8_unorm", "rgb8", false},
    {"r8g8b8a8_unorm", "rgba8", false},
    {"edge clamp-to-edge clamp_to_edge extend", "clamp", false},
    {"wrap tile tiled loop", "repeat", false},
    {"astc astc_4x4 astc4x4", "astc-4x4", false},
    {"astc_6x6 astc6x6", "astc-6x6", false},
    {"astc_8x8 astc8x8", "astc-8x8", false},
    {"rgb rgb24 rgb888 r8g8b8", "rgb8", false},
    {"rgba rgba32 rgba8888 r8g8b8a8", "rgba8", false},
    {"rgb48 r16g16b16", "rgb16", false},
    {"float32 fp32", "float", false},
    {"float16 fp16", "half", false},
    {"jpg", "jpeg", false},
    {"tif", "tiff", false},
    {"ktx", "ktx2", false},
    {"ue ue4 ue5 unreal4 unreal5", "unreal", false},
    {"threejs three.js", "three", false},
    {"model-viewer modelviewer", "three", false},
    {"cesiumjs", "cesium", false},
};

constexpr ForeignClause kForeignClauses[] = {
    // What the channels hold, and not what its numbers are.
    {"terrain-rgb terrarium", "stored", "--channel {0} reads it"},
    {"labpbr minecraft optifine iris", "unity",
     "LabPBR is a layout of channels: check-normals reads it with --swizzle labpbr, pack-normals and bake-normals "
     "write it with --layout labpbr"},
    {"terrain3d source skyrim", "unity", "that is a layout of channels: pack-normals --layout {0} writes it"},
    {"webgl webgpu web browser", "three", "name what draws it: three, babylon, playcanvas, cesium or gltf"},
    {"webp png jpeg jpg exr tiff tif tga bmp dds ktx2", "dxt5nm",
     "{0} is a file type: the name of the output ends in .{0}, or --container {0}"},
};

constexpr UnwrittenType kUnwrittenTypes[] = {
    {"avif", "avifenc --lossless n.png n.avif"},
    {"etc1s basis", "basisu -ktx2 -normal_map n.png"},
};

bool has_name(std::string_view names, std::string_view name) {
    const std::vector<std::string> all = split(names, ' ');
    return std::find(all.begin(), all.end(), name) != all.end();
}

// Whether the command has every option of an answer. Those behind the name of another command are that one's.
bool applies(std::string_view answer, const std::function<bool(std::string_view option)>& has) {
    if (answer.empty() || answer.find("-normals ") != std::string_view::npos) return !answer.empty();
    for (const std::string& word : split(answer, ' ')) {
        const std::string option = word.substr(0, word.find_last_not_of(",;") + 1);
        if (option.starts_with("--") && !has(option)) return false;
    }
    return true;
}

}  // namespace

std::span<const ForeignOption> foreign_options() { return kForeignOptions; }
std::span<const ForeignWord> foreign_words() { return kForeignWords; }
std::span<const UnwrittenType> unwritten_types() { return kUnwrittenTypes; }

bool is_foreign_option(std::string_view name) {
    return std::any_of(std::begin(kForeignOptions), std::end(kForeignOptions),
                       [name](const ForeignOption& row) { return has_name(row.names, name); });
}

std::string foreign_option_answer(std::string_view name, const std::function<bool(std::string_view option)>& has) {
    for (const ForeignOption& row : kForeignOptions) {
        if (!has_name(row.names, name) || !applies(row.answer, has)) continue;
        const bool is_clause =
            row.answer.find("--") == std::string_view::npos || row.answer.find("; ") != std::string_view::npos;
        return fmt::format("; {}{}", is_clause ? "" : "here it is ", row.answer);
    }
    return {};
}

std::string foreign_word_answer(std::string_view name, const std::vector<std::string>& words) {
    const auto known = [&words](std::string_view word) {
        return std::find(words.begin(), words.end(), word) != words.end();
    };
    const std::string small = lower_case(std::string(name));
    for (const ForeignWord& row : kForeignWords) {
        if (has_name(row.names, small) && known(row.word)) return fmt::format("; here it is {}", row.word);
    }
    for (const ForeignClause& row : kForeignClauses) {
        if (has_name(row.names, small) && known(row.among))
            return "; " + fmt::format(fmt::runtime(row.answer), common_word(small));
    }
    return known("dxt5nm") || known("png") ? unwritten_type_answer(small) : std::string();
}

std::string unwritten_type_answer(std::string_view name) {
    const std::string small = lower_case(std::string(name));
    if (small == "html") return "; pages are written by --report: check-normals n.png --report page.html";
    for (const UnwrittenType& row : kUnwrittenTypes) {
        if (has_name(row.names, small))
            return fmt::format("; {} is not written: make n.png, then run {}", small, row.command);
    }
    return {};
}

std::string common_word(std::string word) {
    word = lower_case(std::string(word));
    for (const ForeignWord& row : kForeignWords) {
        if (row.is_same && has_name(row.names, word)) return std::string(row.word);
    }
    return word;
}

}  // namespace tex::cli
