// SPDX-License-Identifier: Apache-2.0

#include "reports/transfer_report.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/preview.h>

#include "cli/text.h"
#include "options/missed_texels.h"
#include "options/rays.h"
#include "reports/html.h"
#include "reports/lod_report.h"
#include "reports/page_mesh.h"
#include "reports/report_file.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

std::string with_commas(std::size_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
    return text;
}

std::string dl_row(const char* name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_text(value));
}

std::string percent_text(std::int64_t part, std::int64_t whole) {
    if (part == 0) return "none";
    return fmt::format("{} ({:.3g} %)", with_commas(static_cast<std::size_t>(part)),
                       whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

// The mesh as preview() draws one: with a flat map.
Result<HtmlPicture> still_of(const MeshPart& part, const std::vector<Float4>& tangents, int size,
                             const std::string& caption, const Execution& execution) {
    MipChain flat;
    NormalMap& map = flat.levels.emplace_back(Extent{1, 1});
    map.x.at(0, 0) = map.y.at(0, 0) = 0.0f;
    map.z.at(0, 0) = 1.0f;
    const TangentSpace space{part, tangents};
    PreviewScene scene;
    scene.map = &flat;
    scene.mesh = &space;
    PreviewOptions options;
    options.size = {size, 0};
    const auto picture = preview(scene, options, execution);
    if (!picture) return picture.error();
    return html_picture(*picture, caption, "the high mesh, lit from the upper left");
}

std::string facts_of(const TransferReport::Entry& entry) {
    const TransferredMaps& maps = entry.maps;
    const Extent extent = entry.texture.extent();
    std::string text = "<dl>\n";
    text += dl_row("low mesh", fmt::format("{}, {} triangles", printable(entry.low.file()),
                                           with_commas(entry.low.selected().part.triangles())));
    for (const std::string& name : entry.high.names) text += dl_row("high mesh", printable(name));
    text += dl_row("", fmt::format("{} triangles", with_commas(entry.high.triangles())));
    text += dl_row("map", fmt::format("{} x {}, {}, {}", extent.width, extent.height,
                                      name_of(kFormatNames, entry.texture.format), layout_name(entry.texture.swizzle)));
    text += dl_row("decoder", std::string(name_of(kDecoderNames, entry.low.decoder())));
    text += dl_row("tangents", std::string(name_of(kTangentSourceNames, entry.low.source())));
    text += dl_row("texels", with_commas(static_cast<std::size_t>(maps.covered)));
    text += dl_row("missed", percent_text(maps.missed, maps.covered));
    text += dl_row("reach", fmt::format("{:.4g} in front, {:.4g} behind", maps.front, maps.back));
    text += dl_row("heights", fmt::format("{:.4g} to {:.4g}", static_cast<double>(maps.lowest),
                                          static_cast<double>(maps.highest)));
    return text + "</dl>\n";
}

std::string warnings_of(const Job& job) {
    if (job.warnings().empty()) return "<p class=\"nothing\">Nothing to warn of.</p>\n";
    std::string text = "<ul class=\"findings\">\n";
    for (const FileWarning& warning : job.warnings())
        text += fmt::format("<li class=\"finding\"><span class=\"chip warning\">warning</span>\n<p>{}: {}</p></li>\n",
                            html_text(warning.file), html_text(warning.message));
    return text + "</ul>\n";
}

Result<HtmlPicture> missed_view(const TransferredMaps& maps, int side) {
    const auto picture = picture_of(missed_picture(maps.origin, side));
    if (!picture) return picture.error();
    return html_picture(*picture, "missed texels are red", "the texels of the map: missed ones red, those hit grey");
}

// The output as preview-normals names it: of a tile, by the pattern of all of them.
std::string map_for_shell(const Task& task) {
    std::string name = with_level(task.output, 0);
    if (!task.is_tile_of_mesh()) return shell_file(name);
    const std::string number = std::to_string(task.tile);
    const std::size_t at = name.rfind(number);
    return at == std::string::npos ? shell_file(name) : shell_file(name.replace(at, number.size(), kTileMark));
}

}  // namespace

TransferReport::TransferReport()
    : page_("transfer-normals", {"missed", "low", "high", "extent", "format"}),
      models_("transfer-normals", lod_columns()) {}

void TransferReport::add(Command& command) {
    add_report_option(command, path_,
                      "write a page with the map on the low mesh beside the high one, under a light that can be moved",
                      4, "write a page with the map on the low mesh");
}

void TransferReport::check(const std::vector<Task>& tasks, std::vector<NamedFile> others) {
    check_report(path_, tasks, std::move(others));
    maps_ = std::max<std::size_t>(1, tasks.size());
}

Result<HtmlBeside> TransferReport::beside(const Entry& entry, const HtmlSizes& sizes,
                                          const Execution& execution) const {
    const std::size_t triangles = entry.high.triangles(), most = std::max<std::size_t>(1000, kPageTriangles / maps_);
    const auto visit_high = [&](const VisitPart& visit) { entry.high.visit_standing(visit); };
    const MeshPart part = page_mesh(visit_high, most);
    const std::vector<Float4> tangents(part.indices.size(), Float4{1.0f, 0.0f, 0.0f, 1.0f});
    auto still = still_of(part, tangents, sizes.lit, "the high mesh", execution);
    if (!still) return still.error();
    HtmlBeside beside;
    beside.still = std::move(*still);
    beside.mesh = html_mesh_beside({part, tangents}, entry.low.selected().part);
    beside.remark = part.triangles() == triangles
                        ? fmt::format("The high mesh, all {} triangles.", with_commas(triangles))
                        : fmt::format(
                              "The high mesh has {} triangles, of which this page shows {}: those of a copy "
                              "whose near vertices are merged.",
                              with_commas(triangles), with_commas(part.triangles()));
    if (entry.maps.missed == 0) return beside;
    const auto mask = picture_of(missed_mask(entry.maps.origin, kLargestHtmlLevel));
    if (!mask) return mask.error();
    auto png = encode_picture(*mask);
    if (!png) return png.error();
    beside.missed = std::move(*png);
    return beside;
}

Result<void> TransferReport::add(Job& job, const Entry& entry) {
    const HtmlSizes sizes = html_sizes(maps_);
    const Execution execution{job.threads(), {}};
    const MapOnMesh on_mesh{entry.low.space(), entry.texture.y_axis, false, entry.arguments, map_for_shell(job.task)};
    auto map = draw_html_map(with_level(job.task.output, 0), entry.texture, entry.texture.swizzle, entry.texture.y_axis,
                             &on_mesh, sizes, execution);
    if (!map) return map.error();
    if (sizes.view > 0) {
        auto drawn = beside(entry, sizes, execution);
        if (!drawn) return drawn.error();
        map->beside = std::move(*drawn);
        if (entry.maps.missed > 0) {
            auto view = missed_view(entry.maps, sizes.view);
            if (!view) return view.error();
            map->views.insert(map->views.begin(), std::move(*view));
        }
    }
    HtmlEntry page;
    page.title = printable(with_level(job.task.output, 0));
    page.words = job.code() != ExitCode::done ? "error" : job.warnings().empty() ? "clean" : "warning";
    const Extent extent = entry.texture.extent();
    page.row = fmt::format("<td><span class=\"chip {}\">{}</span></td>", page.words,
                           percent_text(entry.maps.missed, entry.maps.covered));
    for (const std::string& cell :
         {with_commas(entry.low.selected().part.triangles()), with_commas(entry.high.triangles()),
          fmt::format("{} x {}", extent.width, extent.height),
          std::string(name_of(kFormatNames, entry.texture.format))})
        page.row += fmt::format("<td>{}</td>", html_text(cell));
    page.body = facts_of(entry) + warnings_of(job);
    page.maps.push_back(std::move(*map));
    page_.add(job.task.output, std::move(page));
    const std::lock_guard lock(mutex_);
    texels_[job.task.output] = {entry.maps.covered, entry.maps.missed, false};
    return {};
}

Result<void> TransferReport::add_model(Job& job, const std::vector<std::string>& originals) {
    auto entries = lod_entries(job, originals, html_sizes(3 * maps_));
    if (!entries) return entries.error();
    for (std::size_t k = 0; k < entries->size(); ++k) {
        HtmlEntry& entry = (*entries)[k];
        entry.body += warnings_of(job);
        if (!job.warnings().empty()) entry.words = "warning";
        models_.add(fmt::format("{}: {:06}", job.task.output, k), std::move(entry));
    }
    if (entries->empty()) job.warn("is not in the report: the high mesh has none of its materials", job.task.output);
    const std::lock_guard lock(mutex_);
    ++lods_;
    return {};
}

void TransferReport::add_failure(const Job& job, const Error& error) {
    if (job.task.model_output) {
        HtmlEntry model;
        model.title = printable(job.task.output);
        model.words = "error";
        model.row = "<td></td><td></td><td></td><td></td>";
        model.body = fmt::format("<p><b>{}</b></p>\n", html_text(error.of(job.task.input).message()));
        models_.add(job.task.output, std::move(model));
        const std::lock_guard lock(mutex_);
        ++failed_lods_;
        return;
    }
    HtmlEntry page;
    page.title = printable(with_level(job.task.output, 0));
    page.words = "error";
    page.row = fmt::format("<td><span class=\"chip error\">{}</span></td><td></td><td></td><td></td><td></td>",
                           html_text(error.reason));
    page.body = fmt::format("<p><b>{}</b></p>\n", html_text(error.of(job.task.input).message()));
    page_.add(job.task.output, std::move(page));
    const std::lock_guard lock(mutex_);
    texels_[job.task.output] = {0, 0, true};
}

ExitCode TransferReport::write(Console& console) const {
    if (!is_given()) return ExitCode::done;
    const auto is_failed = [](const auto& row) { return row.second.failed; };
    // A page without any result would replace the page of a run that had some.
    if (lods_ == 0 && std::all_of(texels_.begin(), texels_.end(), is_failed)) return ExitCode::done;
    if (lods_ + failed_lods_ > 0) {
        std::string models = fmt::format("{} model{}", lods_, lods_ == 1 ? "" : "s");
        if (failed_lods_ > 0) models += fmt::format("; {} failed", failed_lods_);
        return write_report(path_, models_, models, console);
    }
    std::int64_t covered = 0, missed = 0;
    std::size_t made = 0, failed = 0;
    for (const auto& [output, texels] : texels_) {
        covered += texels.covered;
        missed += texels.missed;
        ++(texels.failed ? failed : made);
    }
    std::string summary = fmt::format("{} map{}", made, made == 1 ? "" : "s");
    const std::string all = with_commas(static_cast<std::size_t>(covered));
    if (made > 0 && missed == 0) summary += fmt::format("; no texel of {} is missed", all);
    if (missed > 0)
        summary += fmt::format("; {} of {} texels are missed", with_commas(static_cast<std::size_t>(missed)), all);
    if (failed > 0) summary += fmt::format("; {} failed", failed);
    return write_report(path_, page_, summary, console);
}

}  // namespace tex::cli
