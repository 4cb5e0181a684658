// SPDX-License-Identifier: Apache-2.0
// preview-normals: light on normal maps, and false colours.

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/name_pattern.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/scene.h"
#include "options/source.h"

namespace {

using namespace tex;

constexpr int kPanelSize = 320;  // of a sheet, where the user chooses none

struct PreviewNormals {
    cli::Command command{
        "preview-normals",
        "Renders normal maps: lit as a GPU would, or in false colours that show what is wrong with them."};
    cli::FileOptions files;
    cli::SourceOptions source;
    cli::SceneOptions scene;
    std::vector<Show> shows = {Show::lit};
    int columns = 0;
    int turntable = 0;
    bool split = false;
    bool difference = false;
    bool no_legend = false;
    bool no_captions = false;
    cli::OutputOptions output;
    cli::RunOptions run;

    PreviewNormals();
    void add_picture();
    void check(const std::vector<cli::Task>& tasks) const;
    Result<void> process(cli::Job& job);
    Result<Texture> draw(const std::vector<std::string>& names, const std::vector<cli::SampledMap>& maps,
                         const cli::SceneFiles& with, const PreviewOptions& options, const Execution& execution) const;
    Result<Texture> draw_difference(const std::string& name, const NormalMap& a, const NormalMap& b,
                                    const Execution& execution) const;
    [[nodiscard]] std::string caption(const std::vector<std::string>& names, std::size_t map, Show show) const;
};

// How step `k` of `count` equal ones runs.
Execution step(const Execution& whole, std::size_t k, std::size_t count) {
    Execution one;
    one.threads = whole.threads;
    one.progress = [&whole, k, count](double done) {
        return !whole.progress || whole.progress((static_cast<double>(k) + done) / static_cast<double>(count));
    };
    return one;
}

PreviewNormals::PreviewNormals() {
    command.usage("MAP... -o PICTURE");
    command.usage("MAP... --out-dir DIR [--name PATTERN]");
    command.input("MAP...", "normal maps; with -o all come onto one sheet; - is standard input");
    files.joins = true;
    files.add(command);
    command
        .choice(output.container, "--container", "KIND", kContainerNames,
                "the kind of file, where the output's name does not tell (a pipe)")
        .preset = "by extension; png for -";
    add_picture();
    source.add(command, false);
    scene.add(command);
    run.add(command);
    command.example("preview-normals bricks.dds -o bricks.png", "The map under a light from the upper left.");
    command.example("preview-normals bricks.dds -o sphere.png --shape sphere --detail grain.dds --detail-tiling 8",
                    "On a sphere, with detail blended in.");
    command.example("preview-normals *.dds -o sheet.png --show lit,normals,tilt,curl",
                    "A contact sheet, a row for each map.");
    command.example("preview-normals before.dds after.dds -o split.png --split --difference",
                    "Two maps in one picture, and the angles between them.");
}

void PreviewNormals::add_picture() {
    command.group("Picture");
    cli::Row& row = command.option("--show", "WHAT[,WHAT...]", "what pictures show, one beside the other",
                                   [this](const std::string& text) {
                                       shows.clear();
                                       std::string rest = text;
                                       while (true) {
                                           const auto [word, more] = cli::cut(rest, ',');
                                           shows.push_back(cli::parse_word(word, kShowNames));
                                           if (rest.find(',') == std::string::npos) break;
                                           rest = more;
                                       }
                                   });
    row.words = cli::words_of(kShowNames);
    row.completes = cli::Completes::words;
    row.preset = "lit";
    command
        .option("--size", "N|WxH", "pixels of a picture's longer side, or both",
                [this](const std::string& text) { scene.preview.size = cli::parse_picture_size(text); })
        .preset = fmt::format("the map's own, up to 1024; 512 for sphere and cube; {} on sheets", kPanelSize);
    command.number(columns, "--columns", "N", 0, 1000, "pictures in a row of a sheet").preset =
        "the number of --show, else as many as rows";
    command.flag(split, "--split", "two maps: the left half of one picture and the right half of the other");
    command.flag(difference, "--difference", "two maps of one size: the angles between them, in false colours");
    command
        .number(turntable, "--turntable", "N", 0, 1000,
                "an animated PNG of N pictures in which the shape, or over a plane the light, turns once")
        .preset = "";
    command
        .number(scene.preview.maximum, "--legend-max", "V", {0.0, 1e9},
                "the legend's end for slope, tilt, length, z-error and curl")
        .preset = "a round number that suits the map";
    command.flag(no_legend, "--no-legend", "no legends");
    command.flag(no_captions, "--no-captions", "no captions on sheets");
    command.check([this] {
        if (scene.height.empty() && std::find(shows.begin(), shows.end(), Show::height) != shows.end()) {
            throw cli::UsageError("--show height needs --height");
        }
        scene.preview.legend = !no_legend;
        files.shared = scene.files();
    });
}

void PreviewNormals::check(const std::vector<cli::Task>& tasks) const {
    for (const cli::Task& task : tasks) {
        cli::OutputOptions::check_holds(task.output, task.container, Encoding::rgb8);
        if (cli::has_level(task.output)) throw cli::UsageError("--name: {level} has no meaning for pictures");
        if (turntable > 0 && task.container != Container::png) {
            throw cli::UsageError(fmt::format("{}: --turntable writes PNG", cli::printable(task.output)));
        }
        const std::size_t maps = 1 + task.also.size() - files.shared.size();
        if ((split || difference) && maps != 2) {
            throw cli::UsageError(fmt::format("{} takes two maps and -o, {} given", split ? "--split" : "--difference",
                                              maps == 1 ? "one is" : fmt::format("{} are", maps)));
        }
    }
}

std::string PreviewNormals::caption(const std::vector<std::string>& names, std::size_t map, Show show) const {
    if (no_captions) return {};
    std::string text;
    if (shows.size() > 1) text = name_of(kShowNames, show);
    if (names.size() > 1) {
        const cli::NameFields fields = cli::name_fields(names[map]);
        text += (text.empty() ? "" : ": ") + fields.stem + fields.ext;
    }
    return text;
}

// The heat map that compare-normals writes.
Result<Texture> PreviewNormals::draw_difference(const std::string& name, const NormalMap& a, const NormalMap& b,
                                                const Execution& execution) const {
    if (a.extent() != b.extent()) return Error{ErrorCode::bad_option, name, "is not as large as the other map"};
    const auto compared = compare(a, b, execution);
    if (!compared) return compared.error();
    constexpr double kScales[] = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 90.0, 180.0};
    double scale = std::min(static_cast<double>(scene.preview.maximum), 180.0);
    if (!(scale > 0.0)) scale = *std::lower_bound(std::begin(kScales), std::end(kScales) - 1, compared->error.p999);
    const auto map = heat_map(compared->degrees, scale, execution);
    if (!map) return map.error();
    return picture_of(*map);
}

Result<Texture> PreviewNormals::draw(const std::vector<std::string>& names, const std::vector<cli::SampledMap>& maps,
                                     const cli::SceneFiles& with, const PreviewOptions& base,
                                     const Execution& execution) const {
    PreviewOptions options = base;
    if (options.size == Extent{} && !split && (maps.size() * shows.size() > 1 || difference))
        options.size = {kPanelSize, 0};
    std::vector<Panel> panels;
    for (std::size_t k = 0; k < maps.size(); ++k) {
        for (const Show show : shows) {
            options.show = show;
            auto picture =
                preview(with.with(maps[k]), options, step(execution, panels.size(), maps.size() * shows.size()));
            if (!picture) return Error{picture.error().code, names[k], picture.error().reason};
            panels.push_back({std::move(*picture), caption(names, k, show)});
        }
    }
    if (split) {
        std::vector<Panel> halves;
        for (std::size_t k = 0; k < shows.size(); ++k) {
            auto joined = split_view(panels[k], panels[k + shows.size()]);
            if (!joined) return Error{joined.error().code, names[1], joined.error().reason};
            halves.push_back({std::move(*joined), {}});
        }
        panels = std::move(halves);
    }
    if (difference) {
        auto angles = draw_difference(names[1], maps[0].chain.levels.front(), maps[1].chain.levels.front(), execution);
        if (!angles) return angles.error();
        panels.push_back({std::move(*angles), no_captions ? "" : "difference, degrees"});
    }
    if (panels.size() == 1) return std::move(panels.front().picture);
    const int row = columns > 0 ? columns : shows.size() > 1 && !difference ? static_cast<int>(shows.size()) : 0;
    return contact_sheet(panels, row);
}

Result<void> PreviewNormals::process(cli::Job& job) {
    std::vector<std::string> names = {job.task.input};
    names.insert(names.end(), job.task.also.begin(),
                 job.task.also.end() - static_cast<std::ptrdiff_t>(files.shared.size()));
    for (const std::string& name : job.task.also) job.depends_on(name);

    std::vector<cli::SampledMap> maps;
    for (std::size_t k = 0; k < names.size(); ++k) {
        auto map =
            cli::read_sampled_map(job, names[k], source, {false, false, {}, !difference}, scene.preview,
                                  job.until(0.4 * static_cast<double>(k + 1) / static_cast<double>(names.size())));
        if (!map) return map.error();
        maps.push_back(std::move(*map));
    }
    const auto with = scene.read(job, source, job.until(0.5));
    if (!with) return with.error();

    std::vector<Texture> frames;
    const int count = std::max(1, turntable);
    for (int k = 0; k < count; ++k) {
        PreviewOptions options = scene.preview;
        options.spin = 360.0f * static_cast<float>(k) / static_cast<float>(count);
        auto picture = draw(names, maps, *with, options, job.until(0.5 + 0.45 * (k + 1) / count));
        if (!picture) return picture.error();
        frames.push_back(std::move(*picture));
    }
    const Extent extent = frames.front().extent();
    auto bytes =
        turntable > 0 ? encode_animation(frames) : encode_file(frames.front(), job.task.container, job.write_options);
    if (!bytes) return Error{bytes.error().code, job.task.output, bytes.error().reason};
    if (auto written = write_file(job.task.output, *bytes, job.write_options); !written) return written.error();
    job.wrote(job.task.output);
    job.report["maps"] = names;
    job.report["extent"] = {extent.width, extent.height};
    job.report["frames"] = frames.size();
    job.report["bytes"] = bytes->size();
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_main("preview-normals", [&] {
        PreviewNormals self;
        if (const auto ended = self.command.parse(argc, argv)) return *ended;
        cli::Steps steps;
        steps.defaults.batch = Container::png;
        steps.defaults.standard_output = Container::png;
        steps.check = [&](const std::vector<cli::Task>& tasks) -> Result<void> {
            self.check(tasks);
            return {};
        };
        steps.process = [&](cli::Job& job) { return self.process(job); };
        steps.finish = [&] { self.source.warn_of_guesses(); };
        return cli::run_batch(self.command, self.files, self.run, self.output, steps);
    });
}
