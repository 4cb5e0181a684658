// SPDX-License-Identifier: Apache-2.0

#include "options/sheet.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

constexpr int kPanelSize = 320;  // of a sheet, unless the user sets a size

// The Execution of step `k` of `count` equal steps.
Execution step(const Execution& whole, std::size_t k, std::size_t count) {
    Execution one;
    one.threads = whole.threads;
    one.progress = [&whole, k, count](double done) {
        return !whole.progress || whole.progress((static_cast<double>(k) + done) / static_cast<double>(count));
    };
    return one;
}

}  // namespace

void SheetOptions::add_shows(Command& command) {
    Option& row =
        command.option("--show", "WHAT[,WHAT...]", "what pictures show, side by side", [this](const std::string& text) {
            shows_.clear();
            for (const std::string& word : split(text, ',')) shows_.push_back(parse_word(word, kShowNames));
        });
    row.often(3, "lit, normals, tilt, curl, height ...").words = words_of(kShowNames);
    row.completes = Completes::words;
    row.preset = "lit";
}

void SheetOptions::add(Command& command, SceneOptions& scene) {
    scene_ = &scene;
    command.group("Picture");
    add_shows(command);
    command
        .option("--size", "N|WxH", "pixels of a picture's longer side, or both",
                [&scene](const std::string& text) { scene.preview.size = parse_picture_size(text); })
        .often(3, "pixels of a picture's longer side, or both")
        .preset = fmt::format("the map's own, up to 1024; 512 for sphere, cube and mesh; {} on sheets", kPanelSize);
    command.number(columns_, "--columns", "N", 0, 1000, "pictures in a row of a sheet").preset =
        "the number of --show, else as many as rows";
    command.flag(split_, "--split", "two maps: the left half of one picture and the right half of the other")
        .often(4, "two maps, half of each");
    command.flag(difference_, "--difference", "two maps of one size: the angles between them, in false colours");
    command
        .number(turntable_, "--turntable", "N", 0, 1000,
                "an animated PNG of N pictures in which the shape, or over a plane the light, turns once")
        .preset = "";
    command
        .number(scene.preview.maximum, "--legend-max", "V", {0.0, 1e9},
                "the legend's end for slope, tilt, length, z-error, curl, curvature and seams")
        .preset = "a round number that suits the map";
    command.flag(no_legend_, "--no-legend", "no legends");
    command.flag(no_captions_, "--no-captions", "no captions on sheets");
}

std::vector<std::string> SheetOptions::names_of_shows() const {
    std::vector<std::string> names;
    for (const Show show : shows_) names.emplace_back(name_of(kShowNames, show));
    return names;
}

bool SheetOptions::shows(Show show) const { return std::find(shows_.begin(), shows_.end(), show) != shows_.end(); }

void SheetOptions::check(const Task& task) const {
    if (turntable_ > 0 && task.container != Container::png) {
        throw UsageError(printable(task.output), "--turntable writes PNG");
    }
    const std::size_t maps = 1 + task.joined.size();
    if ((split_ || difference_) && maps != 2) {
        throw UsageError(fmt::format("{} takes two maps and -o, {} given", split_ ? "--split" : "--difference",
                                     maps == 1 ? "one is" : fmt::format("{} are", maps)));
    }
}

void SheetOptions::check_mesh(bool has_mesh) const {
    for (const Show show : shows_) {
        if (!has_mesh && needs_mesh(show))
            throw UsageError(fmt::format("--show {} needs --mesh, or a model", name_of(kShowNames, show)));
    }
}

// The shortest name of a map that no other map has: its material, or the file with as many folders as it needs.
std::string SheetOptions::name_apart(const std::vector<MapName>& names, std::size_t map) {
    const auto tail = [](const std::string& file, int folders) {
        const std::string path = slashed(file);
        std::size_t slash = path.size();
        for (int k = 0; k <= folders && slash != std::string::npos; ++k)
            slash = slash == 0 ? slash : path.rfind('/', slash - 1);
        return slash == std::string::npos || slash == 0 ? path : path.substr(slash + 1);
    };
    const MapName& own = names[map];
    const auto is_unique = [&](const auto& name_of_map) {
        return std::count_if(names.begin(), names.end(),
                             [&](const MapName& other) { return name_of_map(other) == name_of_map(own); }) == 1;
    };
    const auto material = [](const MapName& name) { return name.material; };
    if (!own.material.empty() && is_unique(material)) return own.material;
    for (int folders = 0; tail(own.file, folders) != slashed(own.file); ++folders) {
        const auto name = [&](const MapName& other) { return tail(other.file, folders); };
        if (is_unique(name)) return name(own);
    }
    return own.file;
}

std::string SheetOptions::caption(const std::vector<MapName>& names, std::size_t map, Show show) const {
    if (no_captions_) return {};
    std::string text;
    if (shows_.size() > 1) text = name_of(kShowNames, show);
    if (names.size() > 1) text += (text.empty() ? "" : ": ") + name_apart(names, map);
    return text;
}

// The heat map that compare-normals writes.
Result<Texture> SheetOptions::draw_difference(const std::string& name, const NormalMap& a, const NormalMap& b,
                                              const Execution& execution) const {
    if (a.extent() != b.extent()) return Error{ErrorCode::bad_option, name, "is not as large as the other map"};
    const auto compared = compare(a, b, execution);
    if (!compared) return compared.error();
    constexpr double kScales[] = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 90.0, 180.0};
    double scale = std::min(static_cast<double>(scene_->preview.maximum), 180.0);
    if (!(scale > 0.0)) scale = *std::lower_bound(std::begin(kScales), std::end(kScales) - 1, compared->error.p999);
    const auto map = heat_map(compared->degrees, scale, execution);
    if (!map) return map.error();
    return picture_of(*map);
}

bool SheetOptions::can_leave_out(const Error& error, std::size_t maps) const {
    return maps > 1 && !split_ && !difference_ && error.code != ErrorCode::out_of_memory &&
           error.code != ErrorCode::cancelled;
}

Result<Texture> SheetOptions::draw_frame(const std::vector<MapName>& names, Maps& maps, const SceneFiles& with,
                                         PreviewOptions options, const Execution& execution) const {
    if (options.size == Extent{} && !split_ && (maps.size() * shows_.size() > 1 || difference_))
        options.size = {kPanelSize, 0};
    std::vector<Panel> panels;
    for (std::size_t k = 0; k < maps.size(); ++k) {
        for (const Show show : shows_) {
            Panel& panel = panels.emplace_back();
            panel.caption = caption(names, k, show);
            if (maps[k]) {
                options.show = show;
                options.parallax.amount = scene_->parallax_on(*maps[k]);
                options.bump_scale = scene_->preview.bump_scale * maps[k]->scale;
                const Execution part = step(execution, panels.size() - 1, maps.size() * shows_.size());
                auto picture = preview(with.with(*maps[k]), options, part);
                if (picture) {
                    panel.picture = std::move(*picture);
                    continue;
                }
                const bool names_another = !picture.error().file.empty();  // the mesh, which all maps share
                const Error error = picture.error().of(names[k].file);
                if (names_another || !can_leave_out(error, maps.size())) return error;
                maps[k] = error;
            }
            panel.note = maps[k].error().reason;
        }
    }
    if (split_) {
        std::vector<Panel> halves;
        for (std::size_t k = 0; k < shows_.size(); ++k) {
            auto joined = split_view(panels[k], panels[k + shows_.size()]);
            if (!joined) return joined.error().of(names[1].file);
            halves.push_back({std::move(*joined), {}});
        }
        panels = std::move(halves);
    }
    if (difference_) {
        auto angles =
            draw_difference(names[1].file, maps[0]->chain.levels.front(), maps[1]->chain.levels.front(), execution);
        if (!angles) return angles.error();
        panels.push_back({std::move(*angles), no_captions_ ? "" : "difference, degrees"});
    }
    if (panels.size() == 1) return std::move(panels.front().picture);
    const int row = columns_ > 0 ? columns_ : shows_.size() > 1 && !difference_ ? static_cast<int>(shows_.size()) : 0;
    return contact_sheet(panels, row);
}

Result<std::vector<Texture>> SheetOptions::draw(const std::vector<MapName>& names, Maps& maps, const SceneFiles& with,
                                                const Execution& execution) const {
    std::vector<Texture> frames;
    const int count = std::max(1, turntable_);
    for (int k = 0; k < count; ++k) {
        PreviewOptions options = scene_->preview;
        options.legend = !no_legend_;
        options.spin = 360.0f * static_cast<float>(k) / static_cast<float>(count);
        const Execution frame = step(execution, static_cast<std::size_t>(k), static_cast<std::size_t>(count));
        auto picture = draw_frame(names, maps, with, options, frame);
        if (!picture) return picture.error();
        frames.push_back(std::move(*picture));
    }
    return frames;
}

}  // namespace tex::cli
