// SPDX-License-Identifier: Apache-2.0

#include "reports/html_map.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/preview.h>

#include "reports/html.h"

namespace tex::cli {
namespace {

// Packed levels with sides below this are small enough for every page.
constexpr int kSmallLevel = 64;

int longest(Extent extent) { return std::max(extent.width, extent.height); }

// What report_blocks.js decodes. Maps in EAC and ASTC are shown as pictures.
constexpr Format kDecodedInThePage[] = {Format::bc1_unorm, Format::bc2_unorm, Format::bc3_unorm, Format::bc5_unorm,
                                        Format::bc5_snorm};

bool is_packed(Format format) {
    return std::find(std::begin(kDecodedInThePage), std::end(kDecodedInThePage), format) != std::end(kDecodedInThePage);
}

struct View {
    Show show;
    const char* caption;
    const char* alt;
    bool needs_z = false;
};
constexpr View kViews[] = {
    {Show::normals, "normals", "the colours of the map with green up: x, y and z as red, green and blue"},
    {Show::mips, "mip chain", "all levels beside each other, largest first"},
    {Show::tilt, "tilt", "the angle to the surface in degrees, from dark (0) to light (90)"},
    {Show::curl, "curl",
     "curl in blue and orange, pale where the map can come from a height field; the legend says whether y is up or "
     "down"},
    {Show::length, "length", "length of the stored vectors minus 1, pale where it is right", true},
    {Show::z_error, "z error", "stored z minus the z that x and y imply, pale where it is right", true},
    {Show::seams, "seams", "the mesh, with its UV seams coloured by the angle between both sides in degrees"},
    {Show::uv, "UVs", "the outlines of the mesh's triangles over the map; mirrored ones in orange"},
};

// All levels of a texture, with green as `y` says. Lengths are kept, so that errors stay visible.
Result<MipChain> all_levels(const Texture& texture, const Swizzle& swizzle, YAxis y, const Execution& execution) {
    UnpackOptions options;
    options.swizzle = swizzle;
    options.y_axis = y;
    options.keep_length = true;
    auto chain = unpack(texture, options, execution);
    if (!chain || chain->levels.size() > 1) return chain;
    return build_mip_chain(std::move(chain->levels.front()), {}, execution);
}

// What the pictures of one map are drawn from.
struct Drawing {
    HtmlMap& map;
    const MapOnMesh* mesh;       // may be null
    const MipChain& mesh_chain;  // the map as the mesh has it: green may point the other way than in the map's pictures
    const HtmlSizes& sizes;
    const Execution& execution;
};

Result<HtmlPicture> draw(const Drawing& from, const PreviewScene& scene, Show show, int size, std::string caption,
                         const char* alt) {
    PreviewOptions options;
    options.show = show;
    options.size = {size, 0};
    const auto picture = preview(scene, options, from.execution);
    if (!picture) return picture.error();
    return html_picture(*picture, std::move(caption), alt);
}

Result<HtmlPicture> draw_flat(const Drawing& from, Show show, int size, std::string caption, const char* alt) {
    PreviewScene scene;
    scene.map = &from.map.chain;
    scene.map_without_z = from.map.without_z();
    return draw(from, scene, show, size, std::move(caption), alt);
}

Result<HtmlPicture> draw_on_mesh(const Drawing& from, Show show, int size, const char* caption, const char* alt) {
    PreviewScene scene;
    scene.map = &from.mesh_chain;
    scene.map_without_z = from.map.without_z();
    scene.mesh = &from.mesh->space;
    return draw(from, scene, show, size, caption, alt);
}

Result<void> add_view(const Drawing& from, const View& view) {
    std::string caption = view.caption;
    if (view.show == Show::curl && from.map.y == YAxis::down) caption += ", with green read as down";
    const bool is_wide = view.show == Show::mips || view.show == Show::seams;
    const int size = (is_wide ? 2 : 1) * from.sizes.view;
    auto drawn = needs_mesh(view.show) ? draw_on_mesh(from, view.show, size, view.caption, view.alt)
                                       : draw_flat(from, view.show, size, std::move(caption), view.alt);
    if (!drawn) return drawn.error();
    from.map.views.push_back(std::move(*drawn));
    return {};
}

Result<void> add_mesh(const Drawing& from) {
    auto still =
        draw_on_mesh(from, Show::lit, from.sizes.lit, "on the mesh", "the mesh with the map, lit from the upper left");
    if (!still) return still.error();
    const MapOnMesh& mesh = *from.mesh;
    from.map.on_mesh = HtmlOnMesh{std::move(*still), html_mesh(mesh.space, mesh.arguments), mesh.space.part.triangles(),
                                  mesh.y, mesh.map};
    return {};
}

// The occlusion as a grey picture for the page: a white plane under ambient light alone. Its size is not the map's.
Result<std::vector<std::byte>> occlusion_picture(const Drawing& from, const PreviewScene& scene) {
    PreviewOptions options;
    options.size = {std::min(kLargestHtmlLevel, longest(scene.occlusion->extent())), 0};
    options.ambient = options.material.albedo = {1.0f, 1.0f, 1.0f};
    options.light.color = {};
    const auto picture = preview(scene, options, from.execution);
    if (!picture) return picture.error();
    return encode_picture(*picture);
}

// Occlusion darkens ambient light alone, of which there is more here than in the other pictures.
Result<void> add_occluded(const Drawing& from, const MapOcclusion& occlusion) {
    PreviewScene scene;
    scene.map = &from.map.chain;
    scene.map_without_z = from.map.without_z();
    scene.occlusion = occlusion.plane;
    PreviewOptions options;
    options.size = {from.sizes.view, 0};
    options.ambient = {0.6f, 0.6f, 0.6f};
    const auto picture = preview(scene, options, from.execution);
    if (!picture) return picture.error();
    auto drawn = html_picture(*picture, "with occlusion", "the map in much ambient light, which its occlusion darkens");
    if (!drawn) return drawn.error();
    from.map.views.push_back(std::move(*drawn));
    auto png = occlusion_picture(from, scene);
    if (!png) return png.error();
    from.map.occlusion = std::move(*png);
    from.map.occlusion_file = occlusion.file;
    return {};
}

bool applies(const Drawing& from, const View& view) {
    if (view.needs_z && from.map.without_z()) return false;
    if (view.show == Show::mips && from.map.stored_levels == 1) return false;
    if (needs_mesh(view.show) && from.mesh == nullptr) return false;
    return view.show != Show::seams || from.mesh->has_seams;
}

Result<void> draw_pictures(const Drawing& from) {
    constexpr const char* kLit = "lit from the upper left";
    auto thumbnail = draw_flat(from, Show::lit, from.sizes.thumbnail, kLit, kLit);
    if (!thumbnail) return thumbnail.error();
    from.map.thumbnail = std::move(*thumbnail);
    if (from.sizes.lit == 0) return {};
    auto lit = draw_flat(from, Show::lit, from.sizes.lit, kLit, kLit);
    if (!lit) return lit.error();
    from.map.lit = std::move(*lit);
    if (from.sizes.view == 0) return {};
    if (from.mesh != nullptr) {
        if (auto added = add_mesh(from); !added) return added;
    }
    for (const View& view : kViews) {
        if (!applies(from, view)) continue;
        if (auto added = add_view(from, view); !added) return added;
    }
    return {};
}

// The levels from the first one that is small enough, as 8-bit PNGs.
Result<HtmlLevels> decoded_levels(const MipChain& chain, const Execution& execution) {
    HtmlLevels result;
    for (const NormalMap& level : chain.levels) {
        if (longest(level.extent()) > kLargestHtmlLevel) {
            ++result.first;
            continue;
        }
        MipChain one;
        one.levels.emplace_back();
        one.levels.front().x = level.x.clone();
        one.levels.front().y = level.y.clone();
        one.levels.front().z = level.z.clone();
        PackOptions options;
        options.encoding = Encoding::rgb8;
        const auto texture = pack(one, options, execution);
        if (!texture) return texture.error();
        auto png = encode_file(*texture, Container::png);
        if (!png) return png.error();
        result.levels.push_back({level.extent(), std::move(*png)});
    }
    return result;
}

// The channel that holds a component, or -1.
int channel_of(const Swizzle& swizzle, Component component) {
    const auto found = std::find(swizzle.begin(), swizzle.end(), component);
    return found == swizzle.end() ? -1 : static_cast<int>(found - swizzle.begin());
}

}  // namespace

HtmlSizes html_sizes(std::size_t files) {
    if (files <= 40) return {72, 256, 192};
    if (files <= 150) return {64, 192, 128};
    if (files <= 600) return {48, 128, 0};
    return {48, 0, 0};
}

void HtmlLevels::limit(int side) {
    while (!levels.empty() && longest(levels.front().extent) > side) {
        levels.erase(levels.begin());
        ++first;
    }
}

std::size_t HtmlLevels::bytes() const {
    std::size_t sum = 0;
    for (const One& level : levels) sum += level.bytes.size();
    return sum;
}

bool HtmlMap::without_z() const { return channel_of(swizzle, Component::z) < 0; }

const HtmlLevels& HtmlMap::shown() const { return packed.levels.empty() ? decoded : packed; }

void HtmlMap::limit(int side) {
    packed.limit(side);
    decoded.limit(side);
}

std::size_t HtmlMap::picture_size() const {
    std::size_t sum = base64_size(thumbnail.png.size()) + base64_size(lit.png.size()) + base64_size(occlusion.size());
    for (const HtmlPicture& view : views) sum += base64_size(view.png.size());
    if (on_mesh) sum += base64_size(on_mesh->still.png.size());
    if (beside) sum += base64_size(beside->still.png.size()) + base64_size(beside->missed.size());
    return sum;
}

std::size_t HtmlMap::level_size() const { return base64_size(shown().bytes()); }

Json HtmlMap::json() const {
    Json json;
    const HtmlLevels& levels = shown();
    json["file"] = file;
    json["y"] = name_of(kYAxisNames, y);
    json["format"] = name_of(kFormatNames, format);
    json["packed"] = !packed.levels.empty();
    json["channels"] = {channel_of(swizzle, Component::x), channel_of(swizzle, Component::y),
                        channel_of(swizzle, Component::z)};
    if (!occlusion.empty()) json["occlusion"] = occlusion_file;
    json["first"] = levels.first;
    json["levels"] = Json::array();
    for (const HtmlLevels::One& level : levels.levels) {
        json["levels"].push_back({level.extent.width, level.extent.height, level.bytes.size()});
    }
    return json;
}

Result<HtmlPicture> html_picture(const Texture& picture, std::string caption, std::string alt) {
    auto png = encode_picture(picture);
    if (!png) return png.error();
    return HtmlPicture{std::move(caption), std::move(alt), picture.extent(), std::move(*png)};
}

Result<HtmlMap> draw_html_map(const std::string& file, const Texture& texture, const Swizzle& swizzle, YAxis y,
                              const MapOnMesh* mesh, const HtmlSizes& sizes, const Execution& execution,
                              const MapOcclusion* occlusion) {
    HtmlMap map;
    map.file = file;
    map.format = texture.format;
    map.swizzle = swizzle;
    map.y = y;
    map.extent = texture.extent();
    map.stored_levels = static_cast<int>(texture.levels.size());

    auto chain = all_levels(texture, swizzle, y, execution);
    if (!chain) return chain.error();
    map.chain = std::move(*chain);
    MipChain turned;
    if (mesh != nullptr && mesh->y != y) {
        auto other = all_levels(texture, swizzle, mesh->y, execution);
        if (!other) return other.error();
        turned = std::move(*other);
    }
    const MipChain& mesh_chain = turned.levels.empty() ? map.chain : turned;
    if (const auto drawn = draw_pictures({map, mesh, mesh_chain, sizes, execution}); !drawn) return drawn.error();
    if (occlusion != nullptr && sizes.view > 0) {
        if (auto added = add_occluded({map, mesh, mesh_chain, sizes, execution}, *occlusion); !added)
            return added.error();
    }

    // A mesh needs smaller levels, and those of packed maps cannot be made in the page.
    const bool needs_levels = mesh != nullptr && map.stored_levels == 1;
    if (is_packed(texture.format) && !needs_levels) {
        for (const Level& level : texture.levels) map.packed.levels.push_back({level.extent, level.bytes});
        map.packed.limit(kLargestHtmlLevel);
    }
    if (!is_packed(texture.format) || needs_levels || longest(texture.levels.back().extent) > kSmallLevel) {
        auto levels = decoded_levels(map.chain, execution);
        if (!levels) return levels.error();
        map.decoded = std::move(*levels);
    }
    return map;
}

}  // namespace tex::cli
