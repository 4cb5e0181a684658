// SPDX-License-Identifier: Apache-2.0

#include "options/scene.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>
#include <tex/height.h>
#include <tex/mesh.h>
#include <tex/mip.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/preview_fields.h"
#include "options/heights.h"
#include "options/mips.h"
#include "options/surface.h"

namespace tex::cli {
namespace {

constexpr int kLargestPicture = 16384;

// Parses numbers separated by commas.
std::vector<float> parse_floats(const std::string& text, std::size_t least, std::size_t most, Range range = {}) {
    std::vector<float> values;
    for (const std::string& part : split(text, ',')) values.push_back(parse_float(part, range));
    if (values.size() < least || values.size() > most) {
        throw UsageError(
            least == most
                ? fmt::format("'{}' is not {} numbers with commas between them", printable(text), least)
                : fmt::format("'{}' is not {} to {} numbers with commas between them", printable(text), least, most));
    }
    return values;
}

void add_color(Command& command, Rgb& target, const std::string& name, const std::string& help) {
    command
        .option(name, "C", help + ": one linear value, or R,G,B",
                [&target](const std::string& text) {
                    const std::vector<float> c = parse_floats(text, 1, 3, {0.0, 1e6});
                    if (c.size() == 2)
                        throw UsageError(fmt::format("'{}' is neither one value nor R,G,B", printable(text)));
                    target = c.size() == 3 ? Rgb{c[0], c[1], c[2]} : Rgb{c[0], c[0], c[0]};
                })
        .preset = fmt::format("{}", target.r);
}

void add_pair(Command& command, float& x, float& y, const std::string& name, const std::string& help) {
    command
        .option(name, "X[,Y]", help,
                [&x, &y](const std::string& text) {
                    const std::vector<float> values = parse_floats(text, 1, 2, {-1e4, 1e4});
                    x = values.front();
                    y = values.back();
                })
        .preset = fmt::format("{}", x);
}

void add_file(Command& command, std::string& target, const std::string& name, const std::string& help) {
    command.text(target, name, "FILE", help).completes = Completes::files;
}

// Throws UsageError if one of `names` is given without the option `needed`, which it requires.
void check_needs(Command& command, std::string needed, std::vector<std::string> names) {
    command.check([&command, needed = std::move(needed), names = std::move(names)] {
        if (command.given(needed)) return;
        for (const std::string& name : command.given_of(names))
            throw UsageError(fmt::format("{} needs {}", name, needed));
    });
}

}  // namespace

Extent parse_picture_size(const std::string& text) {
    const auto [width, height] = cut(text, 'x');
    if (text.find('x') == std::string::npos) return {parse_int(text, 1, kLargestPicture), 0};
    return {parse_int(width, 1, kLargestPicture), parse_int(height, 1, kLargestPicture)};
}

void SceneOptions::add(Command& command) {
    add_shape(command);
    add_light(command);
    add_material(command);
    add_detail(command);
    add_parallax(command);
    add_sampling(command);
}

void SceneOptions::add_shape(Command& command) {
    command.group("Shape");
    Option& row = command.option("--shape", "S", "what the map is put on", [this](const std::string& text) {
        const auto [word, tiles] = cut(text, ':');
        if (word != "tiled" || tiles.empty()) {
            preview.shape = parse_word(text, kShapeNames);
            return;
        }
        const auto [x, y] = cut(tiles, 'x');
        preview.tiles_x = parse_int(x, range_of(&PreviewOptions::tiles_x));
        preview.tiles_y =
            tiles.find('x') == std::string::npos ? preview.tiles_x : parse_int(y, range_of(&PreviewOptions::tiles_y));
    });
    row.words = words_of(kShapeNames);
    row.often(3, "what the map is put on: plane, sphere, cube, tiled:2x2")
        .words.push_back({"tiled:NxM", "a plane of N by M tiles"});
    row.preset = name_of(kShapeNames, preview.shape);
    command.flag(preview.mirror, "--mirror", "mirrored UVs: u runs from right to left");
    command
        .option("--camera", "YAW,PITCH[,FOV]", "where the viewer stands, in degrees; FOV 0 is a parallel projection",
                [this](const std::string& text) {
                    const std::vector<float> values = parse_floats(text, 2, 3);
                    Camera camera{values[0], values[1]};
                    if (values.size() == 3) camera.field_of_view = values[2];
                    if (!(camera.pitch >= -89.0f && camera.pitch <= 89.0f))
                        throw UsageError("the pitch is -89 to 89 degrees");
                    if (!(camera.field_of_view >= 0.0f && camera.field_of_view <= 120.0f))
                        throw UsageError("FOV is 0 to 120 degrees");
                    preview.camera = camera;
                })
        .preset = "0,0,30; of a cube -35,25,30; of a mesh 30,20,30";
}

void SceneOptions::add_light(Command& command) {
    command.group("Light");
    Light& light = preview.light;
    command
        .option("--light", "X,Y,Z", "the direction to the light, or its place; x right, y up, z to the viewer",
                [&light](const std::string& text) {
                    const std::vector<float> v = parse_floats(text, 3, 3, {-1e6, 1e6});
                    if (v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f)
                        throw UsageError("0,0,0 is neither a direction nor a place beside the surface");
                    light.x = v[0];
                    light.y = v[1];
                    light.z = v[2];
                })
        .often(3, "the direction to the light; y up, z to the viewer")
        .preset = fmt::format("{},{},{}", light.x, light.y, light.z);
    command.choice(light.kind, "--light-kind", "KIND", kLightKindNames, "which type of light");
    add_color(command, light.color, "--light-color", "its colour");
    add_color(command, preview.ambient, "--ambient", "light from everywhere");
}

void SceneOptions::add_material(Command& command) {
    command.group("Material");
    Material& material = preview.material;
    add_file(command, albedo, "--albedo", "the albedo map, in sRGB; linear if it holds floats");
    add_color(command, material.albedo, "--tint", "the albedo, multiplied with its map");
    add_file(command, occlusion, "--occlusion", "what reaches each texel of --ambient: 1 is open, 0 closed");
    add_color(command, material.specular, "--specular", "the colour of highlights");
    command.number(material.shininess, "--shininess", "S", range_of(&Material::shininess),
                   "the exponent of highlights");
    command.choice(material.model, "--specular-model", "M", kSpecularModelNames, "how highlights are computed");
    command.number(preview.bump_scale, "--bump-scale", "S", {}, "strength of the map");
    command.choice(preview.scale_mode, "--scale-mode", "MODE", kScaleModeNames,
                   "what --bump-scale and --detail-scale do");
}

void SceneOptions::add_detail(Command& command) {
    command.group("Detail");
    Detail& fine = preview.detail;
    add_file(command, detail, "--detail", "a normal map blended over each map by whiteout");
    add_file(command, detail_albedo, "--detail-albedo",
             "an albedo map multiplied with the albedo; grey 0.5 changes nothing");
    add_pair(command, fine.tiling_x, fine.tiling_y, "--detail-tiling", "how often it repeats across the map");
    add_pair(command, fine.offset_x, fine.offset_y, "--detail-offset", "its offset in its own widths");
    command.number(fine.scale, "--detail-scale", "S", {}, "its strength");
    add_y_in(command, "--detail-y-in", "which way green points in it", [this](YIn y) { detail_y_in = y; }).preset =
        "as the file says, else as --y-in";
    check_needs(command, "--detail", {"--detail-scale", "--detail-y-in"});
    command.check([&command] {
        if (command.given("--detail") || command.given("--detail-albedo")) return;
        for (const std::string& name : command.given_of({"--detail-tiling", "--detail-offset"})) {
            throw UsageError(fmt::format("{} needs --detail or --detail-albedo", name));
        }
    });
}

void SceneOptions::add_parallax(Command& command) {
    command.group("Parallax");
    Parallax& parallax = preview.parallax;
    add_file(command, height, "--height", "the height map, white being high; else heights come from the normals");
    command.choice(deband, "--deband", "WHEN", kDebandNames,
                   "regain the bits of --height that rounding to 8 bits took away");
    check_needs(command, "--height", {"--deband"});
    Option& row = command.option("--parallax", "P|auto", "height of white over black in widths of the map",
                                 [this, &parallax](const std::string& text) {
                                     parallax_of_map = text == "auto";
                                     parallax.amount = parallax_of_map ? 0.0f : parse_float(text, {});
                                 });
    row.words = {{"auto", "as high as the normals show"}};
    row.completes = Completes::words;
    row.preset = fmt::format("{}", parallax.amount);
    command.number(parallax.limit, "--parallax-limit", "L", {0.0, 1e6}, "the greatest offset, in widths of the map");
    command.number(parallax.steps, "--parallax-steps", "N", range_of(&Parallax::steps),
                   "march along the view ray in N steps; 0 is one offset");
    check_needs(command, "--parallax", {"--parallax-limit", "--parallax-steps"});
    command.check([this] {
        if (parallax_of_map && !height.empty())
            throw UsageError("--parallax auto is for the heights of the normals: leave out --height, or give a number");
    });
}

void SceneOptions::add_sampling(Command& command) {
    command.group("Sampling");
    Option& row = command.option(
        "--wrap", "W[,W]", "what lies beyond the border of all maps; two words set x and y separately",
        [this](const std::string& text) { std::tie(preview.wrap_x, preview.wrap_y) = parse_wraps(text); });
    row.words = {
        {"repeat", "the texture tiles"}, {"clamp", "the border texel again"}, {"mirror", "the texture is mirrored"}};
    row.completes = Completes::words;
    row.preset = name_of(kWrapNames, preview.wrap_x);
    command.number(preview.anisotropy, "--anisotropy", "N", range_of(&PreviewOptions::anisotropy),
                   "most samples along a texel's longer axis; 1 is trilinear");
}

bool SceneOptions::needs_heights() const {
    return height.empty() && (parallax_of_map || preview.parallax.amount != 0.0f);
}

float SceneOptions::parallax_on(const SampledMap& map) const {
    if (!parallax_of_map) return preview.parallax.amount;
    return map.highest / static_cast<float>(map.chain.levels.front().extent().width);
}

std::vector<std::string> SceneOptions::files() const {
    std::vector<std::string> names;
    for (const std::string* name : {&albedo, &occlusion, &detail, &detail_albedo, &height}) {
        if (!name->empty()) names.push_back(*name);
    }
    return names;
}

Result<SampledMap> read_sampled_map(Job& job, const std::string& path, NormalsReader& normals, const Sampling& sampling,
                                    const Execution& execution) {
    auto read = normals.read(job, path, execution, sampling.reading);
    if (!read) return read.error();
    SampledMap map;
    map.without_z =
        std::find(read->info.swizzle.begin(), read->info.swizzle.end(), Component::z) == read->info.swizzle.end();
    map.chain = std::move(read->chain);
    if (sampling.from_object != nullptr) {
        if (map.without_z) return Error{ErrorCode::bad_option, path, "stores no z, which object space needs"};
        auto tangent = to_tangent_space(map.chain.levels.front(), sampling.from_object->space(), {}, execution);
        if (!tangent) return tangent.error().of(path);
        map.chain.levels.clear();
        map.chain.levels.push_back(std::move(tangent->map));
    }
    if (sampling.with_heights) {
        IntegrateOptions with = integrate_options_for(read->info);
        with.wrap_x = sampling.wrap_x;
        with.wrap_y = sampling.wrap_y;
        auto found = integrate(map.chain.levels.front(), with, execution);
        if (!found) return found.error().of(path);
        map.heights = std::move(found->field.height);
        map.highest = found->highest;
    }
    if (map.chain.levels.size() == 1) {
        MipOptions mip;
        mip.wrap_x = sampling.wrap_x;
        mip.wrap_y = sampling.wrap_y;
        auto built = build_mip_chain(std::move(map.chain.levels.front()), mip, execution);
        if (!built) return built.error().of(path);
        map.chain = std::move(*built);
    }
    return map;
}

Result<SceneFiles> SceneOptions::read(Job& job, NormalsReader& normals, const Execution& execution) const {
    SceneFiles files;
    if (!detail.empty()) {
        const Sampling sampling = {{false, true, detail_y_in, false, true}, preview.wrap_x, preview.wrap_y, false};
        auto map = read_sampled_map(job, detail, normals, sampling, execution);
        if (!map) return map.error();
        files.detail = std::move(*map);
    }
    for (const auto& [path, target] : {std::pair{&albedo, &files.albedo}, {&detail_albedo, &files.detail_albedo}}) {
        if (path->empty()) continue;
        auto image = read_image(*path, job.read_options);
        if (!image) return image.error();
        if (image->sample != SampleKind::floating) {
            image = to_linear(std::move(*image), {"sRGB", {}});
            if (!image) return image.error().of(*path);
        }
        *target = std::move(*image);
    }
    if (!occlusion.empty()) {
        auto image = read_image(occlusion, job.read_options);
        if (!image) return image.error();
        auto field = height_field(*image, {}, execution);
        if (!field) return field.error().of(occlusion);
        files.occlusion = std::move(field->height);
    }
    if (!height.empty()) {
        auto image = read_image(height, job.read_options);
        if (!image) return image.error();
        HeightOptions options;
        options.deband = deband;
        options.wrap_x = preview.wrap_x;
        options.wrap_y = preview.wrap_y;
        auto field = height_field(*image, options, execution);
        if (!field) return field.error().of(height);
        if (deband != Deband::off) note_deband(job, field->report.deband, deband, height);
        files.height = std::move(field->height);
    }
    return files;
}

PreviewScene SceneFiles::with(const SampledMap& map) const {
    PreviewScene scene;
    scene.map = &map.chain;
    scene.map_without_z = map.without_z;
    scene.mesh = map.mesh ? &map.mesh->space : mesh;
    if (detail) {
        scene.detail = &detail->chain;
        scene.detail_without_z = detail->without_z;
    }
    if (albedo) scene.albedo = &*albedo;
    if (detail_albedo) scene.detail_albedo = &*detail_albedo;
    if (!occlusion.empty()) scene.occlusion = &occlusion;
    if (!height.empty()) {
        scene.height = &height;
    } else if (!map.heights.empty()) {
        scene.height = &map.heights;
        if (map.highest > 0.0f) scene.white = map.highest;
    }
    return scene;
}

}  // namespace tex::cli
