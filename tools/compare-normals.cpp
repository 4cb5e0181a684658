// SPDX-License-Identifier: Apache-2.0
// compare-normals: measures the difference between two normal maps.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/programs.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "options/curve.h"
#include "options/folder_pairs.h"
#include "options/map_pairs.h"
#include "options/pair.h"
#include "options/run.h"
#include "options/tangent_space.h"
#include "reports/comparison.h"
#include "reports/curve.h"
#include "tasks/folders.h"

namespace {

using namespace tex;

class CompareNormals : public cli::Program {
public:
    explicit CompareNormals(const cli::ProgramRow& row);
    [[nodiscard]] cli::ExitCode work(cli::Console& console) override;

private:
    [[nodiscard]] std::vector<std::string> sources() const;
    [[nodiscard]] cli::ExitCode report_failure(cli::Console& console, const Error& error);
    [[nodiscard]] Result<cli::ExitCode> compare_inputs(cli::Console& console);
    [[nodiscard]] Result<cli::ExitCode> compare_folders(cli::Console& console);
    [[nodiscard]] Result<cli::ExitCode> compare_files(cli::Console& console, const std::vector<std::string>& names,
                                                      const cli::MeshSpace* mesh);
    [[nodiscard]] Result<cli::ExitCode> compare_pair(cli::Console& console, const cli::MapPair& pair,
                                                     const cli::MeshSpace* mesh);
    [[nodiscard]] Result<cli::ExitCode> draw_curve(cli::Console& console);
    [[nodiscard]] Result<void> add_to_page(cli::Console& console, const cli::MapPair& pair,
                                           const std::vector<cli::ComparedLevel>& levels, const Plane<float>& degrees);

    cli::PairOptions pair_;
    cli::TangentSpaceOptions mesh_;
    cli::CompareDocuments documents_;
    cli::CurveOptions curve_;
    cli::RunOptions running_;
    std::vector<std::string> sources_;  // everything that is read
    bool has_folders_ = false;
    std::size_t maps_ = 0;  // that are compared
    cli::FolderTally tally_;
    cli::ComparisonRun run_{{}, pair_.warnings()};
};

CompareNormals::CompareNormals(const cli::ProgramRow& row) : Program(row) {
    command.usage("A B");
    command.usage("A --rdo-means LIST");
    command.input("A B",
                  "two textures, pictures, glTF models with their maps, or folders of them; - is standard input");
    command.finds_things();
    pair_.add(command);
    mesh_.add_charts(command);
    documents_.add(command);
    curve_.add(command);
    running_.add(command);
    command.check([this] {
        const std::vector<std::string>& inputs = command.inputs();
        curve_.check(command);
        if (curve_.is_asked()) return;
        if (inputs.size() != 2) throw cli::UsageError("two files are compared: A and B");
        if (inputs[0] == "-" && inputs[1] == "-") throw cli::UsageError("standard input can only be read once");
        if (cli::is_folder(inputs[0]) && (documents_.has_heat_map() || mesh_.has_mesh()))
            throw cli::UsageError(cli::printable(inputs[0]),
                                  "is a folder, and --heatmap and --mesh are for two files; --report takes folders");
        std::vector<std::string> read = sources_ = sources();
        read.insert(read.end(), command.argument_files().begin(), command.argument_files().end());
        documents_.check(read);
        if (pair_.magnifies() && (documents_.has_page() || command.given("--level")))
            throw cli::UsageError("--magnify compares the largest levels, without --report");
    });
    command.example("compare-normals bricks.exr bricks.dds", "What the compression of bricks.dds cost.");
    command.example("compare-normals old.dds new.dds --level all --max-p999 2 --heatmap diff.png",
                    "Fails if 1 texel in 1000 moved by over 2 degrees, and shows where.");
    command.example("compare-normals bricks.exr bricks.dds --report loss.html",
                    "A page with both maps under a light that can be moved.");
    command.example("compare-normals mine.png theirs.png --mesh rock.glb",
                    "Two bakes, without what is between the charts.");
    command.example("compare-normals rock.glb small.glb", "The maps of two models, by their materials.");
    command.example("compare-normals old new --max-mean 0.1", "All normal maps of two folders, by their names.");
    command.example("compare-normals gl.png dx.png --y-b down", "Two conventions of one map.");
    command.example("compare-normals bricks.png bricks.ktx2 --as etc1", "What old phones show of UASTC.");
    command.example("compare-normals bricks.exr --rdo-means 0,0.1,0.3,1 --plot curve.svg",
                    "What --rdo-mean saves in bytes, and costs in degrees.");
}

cli::ExitCode CompareNormals::work(cli::Console& console) {
    if (running_.quiet) console.be_quiet();
    run_.inputs = command.inputs();
    cli::Host& host = console.host();
    host.begin();
    auto code = curve_.is_asked() ? draw_curve(console) : compare_inputs(console);
    if (code) {
        auto written = documents_.write_page(maps_ > 2 ? tally_.text() : "");
        if (written) written = documents_.write_depfile(sources_);
        if (!written) code = written.error();
    }
    console.clear_progress();
    if (!host.interruption().empty()) host.end_interrupted();
    return code ? *code : report_failure(console, code.error());
}

cli::ExitCode CompareNormals::report_failure(cli::Console& console, const Error& error) {
    console.error(error.message());
    const cli::ExitCode failed = cli::exit_code(error.code);
    return running_.json ? std::max(failed, cli::print_failure(console, run_, error)) : failed;
}

std::vector<std::string> CompareNormals::sources() const {
    std::vector<std::string> names;
    for (const std::string& input : command.inputs()) {
        names.push_back(input);
        for (std::string& beside : cli::files_beside_model(input, {running_.read})) {
            if (!beside.empty()) names.push_back(std::move(beside));
        }
    }
    if (!mesh_.has_mesh()) return names;
    for (std::string& name : mesh_.files()) names.push_back(std::move(name));
    return names;
}

Result<cli::ExitCode> CompareNormals::compare_inputs(cli::Console& console) {
    const std::vector<std::string>& names = command.inputs();
    const bool is_folder[] = {cli::is_folder(names[0]), cli::is_folder(names[1])};
    if (is_folder[0] != is_folder[1])
        return Error{ErrorCode::bad_option, names[is_folder[0] ? 1 : 0],
                     fmt::format("{} is a folder, and is compared with another folder", names[is_folder[0] ? 0 : 1])};
    if (is_folder[0]) return compare_folders(console);
    if (!mesh_.has_mesh()) return compare_files(console, names, nullptr);
    for (const std::string& name : names) {
        if (is_model(name))
            return Error{ErrorCode::bad_option, name, "a model, and --mesh is for maps without their mesh"};
    }
    const auto mesh = mesh_.charts(running_.read, {running_.threads, {}});
    if (!mesh) return mesh.error();
    for (const std::string& remark : mesh->selected().remarks) pair_.warn(console, mesh->file(), remark);
    return compare_files(console, names, &*mesh);
}

// What fails for one pair does not keep the others from being compared.
Result<cli::ExitCode> CompareNormals::compare_folders(cli::Console& console) {
    const std::vector<std::string>& names = command.inputs();
    const auto pairs = cli::folder_pairs(names[0], names[1], running_.read);
    if (!pairs) return pairs.error();
    for (std::size_t k = 0; k < 2; ++k) {
        if (pairs->alone[k].empty()) continue;
        tally_.add_alone(pairs->alone[k].size());
        pair_.warn(console, names[k],
                   fmt::format("not compared, because {} has no file of that name: {}", names[1 - k],
                               cli::join(pairs->alone[k])));
    }
    if (pairs->others > 0)
        pair_.warn(console, names[0],
                   fmt::format("files left out, because they are no normal maps: {}", pairs->others));
    if (pairs->files.empty())
        return Error{ErrorCode::bad_option, names[1], fmt::format("shares no normal map with {}", names[0])};
    for (const auto& [a, b] : pairs->files) sources_.insert(sources_.end(), {a, b});
    std::vector<std::string> kept = sources_;
    for (const auto& alone : pairs->alone) kept.insert(kept.end(), alone.begin(), alone.end());
    documents_.check(kept);
    has_folders_ = true;
    maps_ = 2 * pairs->files.size();
    auto code = cli::ExitCode::done;
    for (const auto& [a, b] : pairs->files) {
        if (!console.host().interruption().empty()) break;
        run_.inputs = {a, b};
        run_.material.clear();
        if (!running_.json)
            code = std::max(code, console.print(fmt::format("{}, {}:\n", cli::printable(a), cli::printable(b))));
        const auto compared = compare_files(console, run_.inputs, nullptr);
        if (!compared) {
            tally_.add_failure();
            documents_.add_failure(a, compared.error());
        }
        code = std::max(code, compared ? *compared : report_failure(console, compared.error()));
        pair_.forget_warnings();
    }
    return running_.json ? code : std::max(code, console.print(tally_.text() + "\n"));
}

Result<cli::ExitCode> CompareNormals::compare_files(cli::Console& console, const std::vector<std::string>& names,
                                                    const cli::MeshSpace* mesh) {
    const auto pairs = cli::map_pairs(
        names, mesh != nullptr ? "" : mesh_.material(), running_.read,
        [&](const std::string& file, const std::string& sentence) { pair_.warn(console, file, sentence); });
    if (!pairs) return pairs.error();
    if (pairs->size() > 1 && documents_.has_heat_map()) {
        return Error{ErrorCode::bad_option, names[0],
                     fmt::format("{} maps are compared, and --heatmap shows two: give --material", 2 * pairs->size())};
    }
    maps_ = std::max(maps_, 2 * pairs->size());
    auto code = cli::ExitCode::done;
    for (const cli::MapPair& pair : *pairs) {
        run_.material = pair.material;
        const auto compared = compare_pair(console, pair, mesh);
        if (!compared) return compared.error();
        code = std::max(code, *compared);
    }
    return code;
}

Result<cli::ExitCode> CompareNormals::compare_pair(cli::Console& console, const cli::MapPair& pair,
                                                   const cli::MeshSpace* mesh) {
    const std::vector<std::string> names = pair.names();
    const auto& [map_a, map_b] = pair.maps;
    auto a = pair_.read_levels(map_a, 0, running_.read, console, running_.step(console, 0.0, 0.3, names[0]));
    if (!a) return a.error();
    auto b = pair_.read_levels(map_b, 1, running_.read, console, running_.step(console, 0.3, 0.6, names[1]));
    if (!b) return b.error();
    pair_.warn_of_doubts(names, console);
    pair_.magnify(*a, *b);
    const auto [first, end] = pair_.levels(*a, *b, names, console);
    cli::ExitCode code = cli::ExitCode::done, printed = code;
    std::vector<cli::ComparedLevel> levels;
    Plane<float> degrees;                                    // for the first level
    const double until = documents_.has_page() ? 0.8 : 1.0;  // of the progress; smaller levels take hardly any time
    for (std::size_t k = first; k < end; ++k) {
        if (auto fits = cli::PairOptions::check_level(k, *a, *b, pair); !fits) return fits.error();
        const Execution shown = running_.step(console, k == first ? 0.6 : until, until, fmt::format("level {}", k));
        auto comparison = mesh != nullptr ? compare(a->levels[k], b->levels[k], mesh->selected().part, 0, shown)
                                          : compare(a->levels[k], b->levels[k], shown);
        if (!comparison) return comparison.error().of(mesh != nullptr ? mesh->file() : names[0]);
        cli::ComparedLevel level{static_cast<int>(k), a->levels[k].extent(), comparison->error};
        if (printed == cli::ExitCode::done) printed = cli::print_level(console, run_, level, running_.json, k == first);
        const std::vector<std::string> violations = pair_.violations(level.number, level.error);
        for (const std::string& sentence : violations)
            console.error(pair.material.empty() && !has_folders_ ? sentence
                                                                 : fmt::format("{}: {}", names[0], sentence));
        level.within = violations.empty();
        code = std::max({code, level.within ? cli::ExitCode::done : cli::ExitCode::findings, printed});
        levels.push_back(level);
        if (k > first) continue;
        tally_.add(pair.maps[0].name(), level.error);
        if (auto written = documents_.write_heat_map(*comparison); !written) return written.error();
        degrees = std::move(comparison->degrees);
    }
    // Among many pairs, those that do not differ have no pictures.
    if (!documents_.has_page() || (maps_ > 2 && levels.front().error.max == 0.0)) return code;
    if (auto added = add_to_page(console, pair, levels, degrees); !added) return added.error();
    return code;
}

Result<cli::ExitCode> CompareNormals::draw_curve(cli::Console& console) {
    const std::string& name = command.inputs().front();
    auto map = pair_.read_levels({name}, 0, running_.read, console, running_.step(console, 0.0, 0.1, name));
    if (!map) return map.error();
    map->levels.resize(1);
    const std::vector<PackOptions> settings = curve_.settings();
    const double part = 0.9 / static_cast<double>(settings.size());
    std::vector<cli::CurvePoint> points;
    auto code = cli::ExitCode::done;
    for (const PackOptions& options : settings) {
        const double from = 0.1 + part * static_cast<double>(points.size());
        const std::string words = fmt::format("--rdo-mean {}", options.rdo.mean);
        auto point = cli::measure_point(*map, options, running_.step(console, from, from + part, words));
        if (!point) return point.error().of(name);
        points.push_back(*point);
        code = std::max(code, cli::print_point(console, run_, points, options, running_.json));
    }
    if (curve_.plot().empty()) return code;
    const std::string title = fmt::format("{}, {}, zstd -19", name, name_of(kEncodingNames, settings.front().encoding));
    if (auto written = cli::write_document(curve_.plot(), cli::plot_curve(title, points)); !written)
        return written.error();
    return code;
}

Result<void> CompareNormals::add_to_page(cli::Console& console, const cli::MapPair& pair,
                                         const std::vector<cli::ComparedLevel>& levels, const Plane<float>& degrees) {
    std::vector<cli::HtmlMap> maps;
    for (int k = 0; k < 2; ++k) {
        const cli::ComparedMap& compared = pair.maps[k];
        const std::string name = compared.name();
        const Execution shown = running_.step(console, 0.8 + 0.1 * k, 0.9 + 0.1 * k, name);
        const auto texture = pair_.read(compared, k, running_.read, console, shown);
        if (!texture) return texture.error();
        auto map = cli::draw_html_map(name, *texture, texture->swizzle, texture->y_axis, nullptr,
                                      cli::html_sizes(std::max<std::size_t>(1, maps_ / 2)), shown);
        if (!map) return map.error();
        maps.push_back(std::move(*map));
    }
    return documents_.add_pair(levels, std::move(maps[0]), std::move(maps[1]), degrees);
}

const cli::Registered<CompareNormals> kRegistered(
    "compare-normals", "Compares two normal maps, in any two encodings: the angle between their normals in degrees.");

}  // namespace
