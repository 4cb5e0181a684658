// SPDX-License-Identifier: Apache-2.0

#include "reports/lod_report.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/text.h"
#include "reports/html.h"
#include "reports/lod_difference.h"

namespace tex::cli {
namespace {

constexpr int kSide = 350;  // of the pictures that are compared: a quarter of the time of kLodSide

using Materials = std::vector<LodMaterial>;

// Takes the one that belongs to a material out of the original: of the same name or, where both models have one
// material, that one.
std::optional<LodMaterial> take_partner(const LodMaterial& material, bool is_alone, Materials& originals) {
    const auto found = std::find_if(originals.begin(), originals.end(), [&](const LodMaterial& other) {
        return other.name == material.name || (is_alone && originals.size() == 1);
    });
    if (found == originals.end()) return std::nullopt;
    LodMaterial taken = std::move(*found);
    originals.erase(found);
    return taken;
}

Result<HtmlMap> drawn(const LodMaterial& material, const std::string& caption, const std::string& model,
                      const HtmlSizes& sizes, const Execution& execution) {
    PackOptions with;
    with.encoding = Encoding::rgb8;
    const auto texture = pack(material.map, with, execution);
    if (!texture) return texture.error();
    const TangentSpace space{material.selected.part, material.selected.tangents};
    const MapOnMesh on_mesh{space, YAxis::up, false, "--material " + shell_file(material.name), shell_file(model)};
    return draw_html_map(caption, *texture, texture->swizzle, YAxis::up, &on_mesh, sizes, execution);
}

std::string difference_row(const char* of, const LodDifference& difference) {
    return fmt::format("<tr><th scope=\"row\">{}</th><td>{:.2f}</td><td>{:.2f}</td></tr>\n", of, difference.codes,
                       difference.degrees);
}

std::string body_of(const LodDifference& old_map, const LodDifference& new_map) {
    return "<div class=\"scroll\"><table class=\"levels\">\n<caption>Mean difference from the original from 26 "
           "directions, where it is lit and at least two pixels inside of the silhouettes</caption>\n<thead><tr><th "
           "scope=\"col\">LOD with</th><th scope=\"col\">codes of light (0 to 255)</th><th "
           "scope=\"col\">degrees</th></tr></thead>\n<tbody>\n" +
           difference_row("the old map", old_map) + difference_row("the new map", new_map) +
           "</tbody>\n</table></div>\n";
}

// The three models of a material.
struct Trio {
    std::array<LodMaterial, 3> models;
    std::array<std::string, 3> files;
};

Result<HtmlEntry> entry_of(Job& job, Trio trio, const HtmlSizes& sizes, const Execution& execution) {
    const std::string name = trio.models[2].name;
    const std::size_t low = trio.models[2].selected.part.triangles();
    const std::size_t high = trio.models[0].selected.part.triangles();
    std::array<Materials, 3> framed;
    for (std::size_t k = 0; k < 3; ++k) {
        trio.models[k].name = name;  // they belong together
        framed[k].push_back(std::move(trio.models[k]));
    }
    frame_together({&framed[0], &framed[1], &framed[2]});
    const auto differences = lod_differences(framed[0], {&framed[1], &framed[2]}, kSide, execution);
    if (!differences) return differences.error();
    HtmlEntry entry;
    entry.title = printable(trio.files[2] + ": " + name);
    entry.words = "clean";
    entry.in_a_row = true;
    const LodDifference none{};
    const LodDifference& of_old = differences->empty() ? none : (*differences)[0];
    const LodDifference& of_new = differences->empty() ? none : (*differences)[1];
    entry.row =
        fmt::format("<td>{:.2f}</td><td>{:.2f}</td><td>{}</td><td>{}</td>", of_old.codes, of_new.codes, low, high);
    entry.body = differences->empty() ? "<p>No pixel is lit in all three of them.</p>\n" : body_of(of_old, of_new);
    job.report["seen"].push_back({{"material", name},
                                  {"old", {{"codes", of_old.codes}, {"degrees", of_old.degrees}}},
                                  {"new", {{"codes", of_new.codes}, {"degrees", of_new.degrees}}}});
    constexpr std::array kCaptions = {"the original", "the LOD with the old map", "the LOD with the new map"};
    for (std::size_t k = 0; k < 3; ++k) {
        auto map = drawn(framed[k].front(), kCaptions[k], trio.files[k], sizes, execution);
        if (!map) return map.error();
        if (map->on_mesh) map->on_mesh->still.caption = kCaptions[k];
        entry.maps.push_back(std::move(*map));
    }
    return entry;
}

}  // namespace

std::vector<std::string> lod_columns() { return {"old map: codes of light", "new map: codes of light", "low", "high"}; }

Result<std::vector<HtmlEntry>> lod_entries(Job& job, const std::vector<std::string>& originals,
                                           const HtmlSizes& sizes) {
    const Execution execution{job.threads(), {}};
    Materials original;
    for (const std::string& file : originals) {
        auto read = lod_materials(file, job.read_options, execution);
        if (!read) return read.error().of(file);
        for (LodMaterial& material : *read) original.push_back(std::move(material));
    }
    auto low = lod_materials(job.task.input, job.read_options, execution);
    if (!low) return low.error().of(job.task.input);
    auto made = lod_materials(job.task.output, job.read_options, execution);
    if (!made) return made.error().of(job.task.output);
    std::vector<HtmlEntry> entries;
    const bool is_alone = made->size() == 1;
    for (std::size_t k = 0; k < made->size() && k < low->size(); ++k) {
        auto high = take_partner((*made)[k], is_alone, original);
        if (!high) continue;
        Trio trio{{std::move(*high), std::move((*low)[k]), std::move((*made)[k])},
                  {originals.front(), job.task.input, job.task.output}};
        auto entry = entry_of(job, std::move(trio), sizes, execution);
        if (!entry) return entry.error();
        entries.push_back(std::move(*entry));
    }
    return entries;
}

}  // namespace tex::cli
