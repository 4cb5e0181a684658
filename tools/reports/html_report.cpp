// SPDX-License-Identifier: Apache-2.0

#include "reports/html_report.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "reports/html.h"
#include "reports/html_marks.h"
#include "reports/report_page.h"

namespace tex::cli {
namespace {

// The longest sides of levels. They are tried one after the other until the page is small enough.
constexpr std::array kSides = {1024, 512, 256, 128, 64, 32, 0};

constexpr int kWidePicture = 200;  // pixels; wider pictures take two columns

std::string image_tag(const HtmlPicture& picture, const std::string& of, const char* attributes) {
    return fmt::format("<img {} width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", attributes,
                       picture.extent.width, picture.extent.height,
                       html_text(picture.alt.empty() ? of : of + ": " + picture.alt), base64(picture.png));
}

std::string figure(const HtmlPicture& picture, const std::string& of) {
    const char* kind = picture.extent.width > kWidePicture ? " class=\"wide\"" : "";
    return fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n", kind,
                       image_tag(picture, of, "loading=\"lazy\" decoding=\"async\""), html_text(picture.caption));
}

std::string figures(const std::vector<HtmlPicture>& pictures, const std::string& of) {
    if (pictures.empty()) return {};
    std::string html = "<div class=\"views\">\n";
    for (const HtmlPicture& picture : pictures) html += figure(picture, of);
    return html + "</div>\n";
}

// Whether the page has the mesh of the map, and the map's levels.
bool is_live(const HtmlMap& map, const HtmlReport::MeshNumbers& meshes) {
    return map.on_mesh && meshes.contains(map.on_mesh->mesh.get()) && !map.shown().levels.empty();
}

// The stage of the mesh that the one before it is compared with.
std::string stage_beside(const HtmlMap& map, std::size_t number, const HtmlReport::MeshNumbers& meshes) {
    const HtmlBeside& beside = *map.beside;
    const auto mesh = meshes.find(beside.mesh.get());
    std::string html = "<div class=\"stage mesh beside\" style=\"--shape: 1 / 1\"";
    if (mesh != meshes.end() && is_live(map, meshes))
        html += fmt::format(" data-map=\"{}\" data-mesh=\"{}\" data-beside", number, mesh->second);
    html += ">\n" + figure(beside.still, map.file);
    return html + fmt::format("<p class=\"remark\">{}</p>\n</div>\n", html_text(beside.remark));
}

// The stage of the map on its mesh. If the page lacks the mesh or the map's levels, it stays a still picture.
// `role`: further attributes of a live stage.
std::string mesh_stage(const HtmlMap& map, std::size_t number, const HtmlReport::MeshNumbers& meshes,
                       const char* role = "") {
    const HtmlOnMesh& on_mesh = *map.on_mesh;
    const bool live = is_live(map, meshes);
    std::string html = "<div class=\"stage mesh\" style=\"--shape: 1 / 1\"";
    if (live) {
        html += fmt::format(" data-map=\"{}\" data-mesh=\"{}\" data-y=\"{}\" data-file=\"{}\"", number,
                            meshes.at(on_mesh.mesh.get()), name_of(kYAxisNames, on_mesh.y), html_text(on_mesh.map));
        html += role;
        if (map.beside && !map.beside->missed.empty()) html += fmt::format(" data-missed=\"missed-{}\"", number);
    }
    html += ">\n" + figure(on_mesh.still, map.file);
    if (!live && !map.shown().levels.empty()) {
        html += fmt::format("<p class=\"remark\">The light on this mesh cannot be moved, because {}.</p>\n",
                            on_mesh.mesh == nullptr
                                ? fmt::format("its {} triangles would make this report too large", on_mesh.triangles)
                                : "the meshes before it fill the space that this report has for meshes");
    }
    return html + "</div>\n";
}

// Meshes with their maps, under one light, turned together.
std::string row_of_meshes(const HtmlEntry& entry, std::size_t number, const HtmlReport::MeshNumbers& meshes) {
    std::string html = "<div class=\"pair row\">\n";
    const bool leads = is_live(entry.maps.back(), meshes);
    for (std::size_t k = 0; k < entry.maps.size(); ++k) {
        const char* const role = !leads ? "" : k + 1 < entry.maps.size() ? " data-follows" : " data-leads";
        html += mesh_stage(entry.maps[k], number + k, meshes, role);
    }
    return html + "</div>\n";
}

// The still pictures that the script replaces with canvases: of the map and, below it, of its mesh. `number` is the
// number of the first map in the page.
std::string stages(const HtmlEntry& entry, std::size_t number, const HtmlReport::MeshNumbers& meshes) {
    if (entry.maps.empty()) return {};
    if (entry.in_a_row) return row_of_meshes(entry, number, meshes);
    const HtmlMap& map = entry.maps.front();
    const HtmlPicture& still = map.lit.png.empty() ? map.thumbnail : map.lit;
    const bool has_levels = !map.shown().levels.empty();
    std::string html;
    if (map.beside) {  // both meshes side by side, and the map below them
        html += "<div class=\"pair\">\n";
        if (map.on_mesh) html += mesh_stage(map, number, meshes);
        html += stage_beside(map, number, meshes) + "</div>\n";
    }
    html += fmt::format("<div class=\"stages\">\n<div class=\"stage\" style=\"--shape: {} / {}\"", map.extent.width,
                        map.extent.height);
    if (has_levels) html += fmt::format(" data-map=\"{}\"", number);
    if (has_levels && entry.maps.size() > 1) html += fmt::format(" data-other=\"{}\"", number + 1);
    html += ">\n";
    html += figure(still, map.file);
    if (!has_levels) html += "<p class=\"remark\">This report has too many files for a light that you can move.</p>\n";
    html += "</div>\n";
    if (map.on_mesh && !map.beside) html += mesh_stage(map, number, meshes);
    return html + "</div>\n";
}

// The map as it is seen below the marks of findings.
const HtmlPicture& below_marks(const HtmlMap& map) { return map.lit.png.empty() ? map.thumbnail : map.lit; }

std::string section_style(const HtmlEntry& entry) {
    if (!has_marks(entry.body) || entry.maps.empty()) return {};
    return fmt::format(" style=\"--map: url(data:image/png;base64,{})\"", base64(below_marks(entry.maps.front()).png));
}

// The number of characters that text, pictures and levels take.
std::size_t size_of(const HtmlEntry& entry) {
    std::size_t sum = entry.body.size();
    if (has_marks(entry.body) && !entry.maps.empty()) sum += base64_size(below_marks(entry.maps.front()).png.size());
    for (const HtmlPicture& picture : entry.extras) sum += picture.png.size() * 4 / 3;
    for (const HtmlMap& map : entry.maps) sum += map.picture_size() + map.level_size();
    return sum;
}

// Replaces the mark `name` in the page with `text`.
void fill(std::string& page, std::string_view name, std::string_view text) {
    const std::string mark = fmt::format("<!--{}-->", name);
    const auto at = page.find(mark);
    if (at != std::string::npos) page.replace(at, mark.size(), text);
}

}  // namespace

HtmlReport::HtmlReport(std::string command, std::vector<std::string> columns)
    : command_(std::move(command)), columns_(std::move(columns)) {}

void HtmlReport::add(const std::string& key, HtmlEntry entry) {
    const std::lock_guard lock(mutex_);
    for (HtmlMap& map : entry.maps) {
        map.chain = {};
        map.limit(side_);
        if (map.on_mesh) share_mesh(map.on_mesh->mesh);
        if (map.beside) share_mesh(map.beside->mesh);
    }
    HtmlEntry& kept = entries_[key];
    size_ += size_of(entry) - size_of(kept);
    kept = std::move(entry);
    if (!fits()) keep_to_budget();
}

// Maps on the same mesh refer to one copy of it.
void HtmlReport::share_mesh(std::shared_ptr<const HtmlMesh>& mesh) {
    if (mesh == nullptr) return;
    const auto found = std::find_if(meshes_.begin(), meshes_.end(), [&](const auto& kept) { return *kept == *mesh; });
    if (found != meshes_.end()) {
        mesh = *found;
        return;
    }
    meshes_.push_back(mesh);
    mesh_size_ += mesh->size();
}

bool HtmlReport::fits() const { return size_ + std::min(mesh_size_, kHtmlMeshBudget) <= kHtmlBudget; }

// The meshes that the page contains, in the order of its entries, as long as they fit.
HtmlReport::MeshNumbers HtmlReport::mesh_numbers() const {
    MeshNumbers numbers;
    std::size_t size = 0;
    for (const auto& [key, entry] : entries_) {
        for (const HtmlMap& map : entry.maps) {
            if (!map.on_mesh || map.on_mesh->mesh == nullptr || map.shown().levels.empty()) continue;
            for (const HtmlMesh* const mesh :
                 {map.on_mesh->mesh.get(), map.beside ? map.beside->mesh.get() : nullptr}) {
                if (mesh == nullptr || numbers.count(mesh) != 0 || size + mesh->size() > kHtmlMeshBudget) continue;
                size += mesh->size();
                numbers.emplace(mesh, numbers.size());
            }
        }
    }
    return numbers;
}

// More entries can only make a page larger, so the final limit is that of the whole set, in whatever order entries
// came.
void HtmlReport::keep_to_budget() {
    for (const int side : kSides) {
        if (side >= side_ || fits()) continue;
        side_ = side;
        size_ = 0;
        for (auto& [key, entry] : entries_) {
            for (HtmlMap& map : entry.maps) map.limit(side);
            size_ += size_of(entry);
        }
    }
}

void HtmlReport::explain(const Rule& rule) {
    const std::lock_guard lock(mutex_);
    rules_.emplace(rule.id, &rule);
}

std::string HtmlReport::table() const {
    std::string html =
        "<table id=\"files\">\n<thead><tr><th scope=\"col\" class=\"picture\"><span "
        "class=\"unseen\">picture</span></th><th scope=\"col\">file</th>";
    for (const std::string& column : columns_) html += fmt::format("<th scope=\"col\">{}</th>", html_text(column));
    html += "</tr></thead>\n<tbody>\n";
    int number = 0;
    for (const auto& [key, entry] : entries_) {
        ++number;
        html += fmt::format("<tr data-words=\"{}\"><td class=\"picture\">", html_text(entry.words));
        if (!entry.maps.empty() && !entry.maps.front().thumbnail.png.empty()) {
            // This picture is decoration: the name beside it gives the same information.
            HtmlPicture picture = entry.maps.front().thumbnail;
            html += fmt::format(
                "<img loading=\"lazy\" decoding=\"async\" width=\"{}\" height=\"{}\" alt=\"\" "
                "src=\"data:image/png;base64,{}\">",
                picture.extent.width, picture.extent.height, base64(picture.png));
        }
        html += fmt::format("</td><th scope=\"row\"><a href=\"#file-{}\">{}</a></th>{}</tr>\n", number,
                            html_text(entry.title), entry.row);
    }
    return html + "</tbody>\n</table>\n";
}

std::string HtmlReport::sections() const {
    const MeshNumbers meshes = mesh_numbers();
    std::string html;
    int number = 0;
    std::size_t map_number = 0;
    for (const auto& [key, entry] : entries_) {
        html += fmt::format(
            "<section class=\"file\" id=\"file-{}\" data-words=\"{}\"{}>\n<h2>{}</h2>\n<div class=\"columns\">\n",
            ++number, html_text(entry.words), section_style(entry), html_text(entry.title));
        // The pictures of a single map are beside it; those of two maps are below them.
        html += stages(entry, map_number, meshes) + "<div class=\"facts\">\n" + entry.body +
                figures(entry.extras, entry.title) +
                (entry.maps.size() == 1 ? figures(entry.maps.front().views, entry.title) : "") + "</div>\n</div>\n";
        for (const HtmlMap& map : entry.maps) {
            if (entry.maps.size() > 1 && !map.views.empty())
                html += fmt::format("<h3>{}</h3>\n", html_text(map.file)) + figures(map.views, map.file);
        }
        html += "</section>\n";
        map_number += entry.maps.size();
    }
    return html;
}

std::string HtmlReport::rules_text() const {
    if (rules_.empty()) return {};
    std::string html = "<section id=\"rules\">\n<h2>Rules</h2>\n<dl>\n";
    for (const auto& [id, rule] : rules_) {
        html += fmt::format("<dt id=\"{0}\">{0} {1}</dt><dd>{2} {3}</dd>\n", html_text(id), html_text(rule->name),
                            html_text(rule->sentence), html_text(rule->explanation));
    }
    return html + "</dl>\n</section>\n";
}

// #mesh-n contains the bytes of mesh n. Nothing of this is there without a mesh.
std::string HtmlReport::mesh_data() const {
    const MeshNumbers numbers = mesh_numbers();
    if (numbers.empty()) return {};
    std::vector<const HtmlMesh*> meshes(numbers.size());
    for (const auto& [mesh, number] : numbers) meshes[number] = mesh;
    Json json;
    json["decoders"] = Json::array();
    for (const auto& row : kDecoderNames)
        json["decoders"].push_back(
            {row.name, name_of(kDecoderKindNames, decoder_kind(row.value)), row.meaning, rebuilds_z(row.value)});
    json["meshes"] = Json::array();
    std::string bytes;
    for (const HtmlMesh* mesh : meshes) {
        bytes += fmt::format("<script type=\"text/plain\" id=\"mesh-{}\">{}</script>\n", json["meshes"].size(),
                             base64(mesh->bytes));
        json["meshes"].push_back(mesh->json());
    }
    return fmt::format("<script type=\"application/json\" id=\"meshes\">{}</script>\n", script_json(json)) + bytes;
}

// #map-n contains the bytes of the levels of map n, one level after the other.
std::string HtmlReport::data() const {
    Json maps = Json::array();
    std::string bytes;
    for (const auto& [key, entry] : entries_) {
        for (const HtmlMap& map : entry.maps) {
            std::vector<std::byte> all;
            for (const HtmlLevels::One& level : map.shown().levels)
                all.insert(all.end(), level.bytes.begin(), level.bytes.end());
            bytes += fmt::format("<script type=\"text/plain\" id=\"map-{}\">{}</script>\n", maps.size(), base64(all));
            if (map.beside && !map.beside->missed.empty())
                bytes += fmt::format("<script type=\"text/plain\" id=\"missed-{}\">{}</script>\n", maps.size(),
                                     base64(map.beside->missed));
            if (!map.occlusion.empty())
                bytes += fmt::format("<script type=\"text/plain\" id=\"occlusion-{}\">{}</script>\n", maps.size(),
                                     base64(map.occlusion));
            maps.push_back(map.json());
        }
    }
    return fmt::format("<script type=\"application/json\" id=\"maps\">{}</script>\n", script_json(maps)) + bytes;
}

std::string HtmlReport::page(const std::string& summary) const {
    const std::lock_guard lock(mutex_);
    std::string html(kReportHtml);
    // Fills the page from its end, so that no mark is searched for in inserted text.
    fill(html, "script", fmt::format("<script>\n{}</script>\n", kReportScript));
    fill(html, "data", data() + mesh_data());
    fill(html, "version", html_text(version()));
    fill(html, "rules", rules_text());
    fill(html, "sections", sections());
    fill(html, "table", table());
    fill(html, "summary", html_text(summary));
    fill(html, "command", html_text(command_));
    fill(html, "style", fmt::format("<style>\n{}</style>\n", kReportStyle));
    fill(html, "title", html_text(command_ + ": " + summary));
    return html;
}

}  // namespace tex::cli
