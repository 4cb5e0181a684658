// SPDX-License-Identifier: Apache-2.0

#include "options/rays.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <tex/pack.h>
#include <tex/surface.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "fields/mesh_fields.h"
#include "options/missed_texels.h"

namespace tex::cli {
namespace {

constexpr Range kNotNegative{0.0, 1e30, true};

// "auto", "0.25" or "5%".
Reach parse_reach(const std::string& text) {
    if (text == "auto") return {};
    if (text.ends_with('%')) return {Reach::Unit::percent, parse_double(text.substr(0, text.size() - 1), kNotNegative)};
    return {Reach::Unit::absolute, parse_double(text, kNotNegative)};
}

Option& add_reach(Command& command, Reach& reach, const std::string& name, std::string help, std::string automatic,
                  std::string preset) {
    Option& row = command.option(name, "DISTANCE", std::move(help),
                                 [&reach](const std::string& text) { reach = parse_reach(text); });
    row.words = {{"auto", std::move(automatic)}};
    row.completes = Completes::words;
    row.preset = std::move(preset);
    return row;
}

double percent_of(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

constexpr double kLeastReach = 1e-6;  // of the diagonal: less is rounding

// Not less than the reach: what is printed as a remedy must suffice.
double enough(double reach, double diagonal) { return std::max(1.001 * reach, kLeastReach * diagonal); }

// What to do about missed texels if guides decide where rays start. `remedy` is about their starts.
std::string advice_of(const TransferredMaps& maps, const std::string& remedy) {
    if (maps.needed_back <= maps.back) return remedy;
    const std::string back = fmt::format("raise --back to {:.4g}", enough(maps.needed_back, maps.diagonal));
    return maps.needed_front <= kLeastReach * maps.diagonal ? back : remedy + ", and " + back;
}

}  // namespace

void RayOptions::add(Command& command) {
    command.group("Rays");
    command
        .option("--extent", "N|WxH", "the width and height of the map in texels",
                [this](const std::string& text) {
                    const auto [width, height] = parse_pair_of_sides(text, kMaxExtent / kMaxSubsamples);
                    extent_ = Extent{width, height};
                })
        .often(1, "the width and height of the map in texels")
        .preset = fmt::format("{}; of a model, that of the old map", kExtent.width);
    command
        .option("--subsamples", "N", "rays of a texel: N by N",
                [this](const std::string& text) {
                    transfer_.subsamples = parse_int(text, range_of(&TransferOptions::subsamples));
                })
        .preset = "1";
    command.choice(transfer_.rays, "--rays", "R", kRayModeNames, "the directions of rays");
    add_reach(command, transfer_.front, "--front",
              "how far rays reach outside of the low mesh: a length in its unit, percent of its diagonal, or the word",
              "found from both meshes", "auto")
        .often(2, "how far rays reach out of the low mesh: 2% or auto");
    add_reach(command, transfer_.back, "--back", "the same inside of the low mesh", "found from both meshes", "auto")
        .often(2, "the same inside of the low mesh");
    command.choice(hit_, "--hit", "H", kHitChoiceNames, "which point counts if a ray meets several").preset =
        "outermost; of a model, nearest";
    command.flag(transfer_.backfaces, "--backfaces", "let triangles of the high mesh count that are seen from behind");
    command
        .option("--straight-angle", "DEG", "with --rays straight, edges between faces with a larger angle are hard",
                [this](const std::string& text) {
                    transfer_.straight_angle = parse_double(text, range_of(&TransferOptions::straight_angle));
                })
        .preset = "30";
    add_reach(command, transfer_.straight_width, "--straight-width",
              "with --rays straight, rays bend within this distance from hard edges", "5%", "auto");
    add_second(command);
    add_coverage(command);
    command.check([this, &command] {
        const auto idle = command.given_of({"--straight-angle", "--straight-width"});
        const bool implied = command.given("--skew") && !command.given("--rays");
        if (transfer_.rays != RayMode::straight && !implied && !idle.empty())
            throw UsageError(idle.front() + " needs --rays straight");
        if (transfer_.rays != RayMode::straight && command.given("--skew") && !implied)
            throw UsageError("--skew needs --rays straight");
    });
}

void RayOptions::add_second(Command& command) {
    command.group("Second rays");
    command
        .option("--rays-per-hit", "N", "rays from each hit, for occlusion, bent normals and thickness",
                [this](const std::string& text) {
                    transfer_.rays_per_hit = parse_int(text, range_of(&TransferOptions::rays_per_hit));
                })
        .preset = fmt::format("{}", transfer_.rays_per_hit);
    add_reach(command, transfer_.occlusion_distance, "--occlusion-distance",
              "how far they reach: a length as --front, or the word", "without limit", "auto");
    command.check([&command] {
        const auto idle = command.given_of({"--rays-per-hit", "--occlusion-distance"});
        const auto users = command.given_of({"--occlusion-out", "--occlusion-into", "--bent-out", "--thickness-out"});
        if (!idle.empty() && users.empty())
            throw UsageError(idle.front() + " needs --occlusion-out, --occlusion-into, --bent-out or --thickness-out");
    });
}

void RayOptions::add_coverage(Command& command) {
    command.group("Coverage");
    Option& padding = command.option("--padding", "N", "texels to fill around each chart: a number, or the word",
                                     [this](const std::string& text) {
                                         transfer_.padding = text == "all" ? kPadAll : parse_int(text, 0, kMaxExtent);
                                     });
    padding.words = {{"all", "the whole map"}};
    padding.completes = Completes::words;
    padding.preset = "all";
    command.choice(overlap_, "--overlap", "O", kOverlapNames, "what happens if triangles share texels");
    command
        .option("--max-missed", "PERCENT", "exit with status 1 if more of the covered texels are missed",
                [this](const std::string& text) {
                    max_missed_ = parse_double(text, {0.0, 100.0, true});
                })
        .preset = "no limit";
    command.finds_things();
}

void RayOptions::judge_missed(Job& job, const TransferredMaps& maps, const std::string& remedy) const {
    if (maps.missed == 0) return;
    std::string sentence = fmt::format("{} of {} texels ({:.3g} %) are missed: no ray hits the high mesh", maps.missed,
                                       maps.covered, percent_of(maps.missed, maps.covered));
    const bool farther = maps.needed_front > maps.front || maps.needed_back > maps.back;
    if (maps.missed > maps.hopeless && !remedy.empty()) {
        sentence += fmt::format(
            "; of those that longer rays can hit, rays of {:.4g} in front and {:.4g} behind would hit 95 %: {}",
            enough(maps.needed_front, maps.diagonal), enough(maps.needed_back, maps.diagonal), advice_of(maps, remedy));
    } else if (maps.missed > maps.hopeless && farther) {
        sentence += fmt::format("; of those that longer rays can hit, --front {:.4g} --back {:.4g} would hit 95 %",
                                enough(std::max(maps.needed_front, maps.front), maps.diagonal),
                                enough(std::max(maps.needed_back, maps.back), maps.diagonal));
    }
    if (maps.hopeless > 0) {
        sentence += fmt::format(
            "; {} meet nothing at any distance, so the high mesh has holes there, ends, or faces the "
            "other way",
            maps.hopeless);
    }
    job.warn(std::move(sentence));
}

Result<void> RayOptions::judge(Job& job, const TransferredMaps& maps, const std::string& remedy) const {
    const double missed = percent_of(maps.missed, maps.covered);
    job.report["covered"] = maps.covered;
    job.report["overlaps"] = maps.overlaps;
    job.report["moved"] = maps.moved;
    job.report["backward"] = maps.backward;
    job.report["missed"] = {{"texels", maps.missed},
                            {"percent", missed},
                            {"hopeless", maps.hopeless},
                            {"needed", {maps.needed_front, maps.needed_back}}};
    job.report["behind"] = maps.behind;
    job.report["rays"] = maps.rays;
    job.report["reach"] = {{"front", maps.front}, {"back", maps.back}, {"diagonal", maps.diagonal}};
    job.report["heights"] = {{"lowest", maps.lowest}, {"highest", maps.highest}};
    const std::string overlaps = fmt::format("UVs overlap in {} places", maps.overlaps);
    if (maps.overlaps > 0 && overlap_ == Overlap::error) return Error{ErrorCode::bad_option, job.task.input, overlaps};
    if (maps.overlaps > 0) job.warn(overlaps + "; the triangle that comes first in the mesh decides there");
    judge_missed(job, maps, remedy);
    if (maps.behind > 0) {
        std::string sentence =
            fmt::format("{} rays meet only triangles that face the other way; {}", maps.behind,
                        transfer_.backfaces ? "they count, because of --backfaces, for a high mesh that is inside out"
                                            : "--backfaces lets them count, if the high mesh is inside out");
        if (!remedy.empty()) sentence += "; if it is not, " + remedy;
        job.warn(std::move(sentence));
    }
    if (maps.singular > 0) {
        job.warn(
            fmt::format("{} texels have no tangent space, because tangents are missing or parallel to normals; "
                        "they become flat",
                        maps.singular));
    }
    if (maps.backward > 0) {
        job.warn(fmt::format("{} texels point into the surface: z is negative, which shaders that rebuild z lose",
                             maps.backward));
    }
    if (max_missed_ && missed > *max_missed_) {
        job.warn(fmt::format("more texels are missed than --max-missed {} allows", *max_missed_));
        job.raise(ExitCode::findings);
    }
    return {};
}

double RaySpeed::millions_a_second() const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
    return static_cast<double>(rays_.load()) / 1e6 / std::max(passed.count(), 1e-9);
}

std::string RaySpeed::words() const {
    return fmt::format("{:.3g} million rays, {:.2g} million a second", static_cast<double>(rays_.load()) / 1e6,
                       millions_a_second());
}

std::string RaySpeed::short_words() const { return fmt::format("{:.2g} M rays/s", millions_a_second()); }

std::string reach_of(const TransferredMaps& maps) {
    const auto height = [&](float value) {  // without the rounding of surfaces that touch each other
        const auto exact = static_cast<double>(value);
        return std::abs(exact) < 1e-9 * maps.diagonal ? 0.0 : exact;
    };
    return fmt::format("rays reach {:.4g} in front and {:.4g} behind; heights are from {:.4g} to {:.4g}", maps.front,
                       maps.back, height(maps.lowest), height(maps.highest));
}

void TransferMaps::add(Command& command, const FileOptions& files) {
    command.group("Maps beside the output");
    object_.add(command, files, "--object-out",
                "write the normals in object space; of many inputs a pattern as --name");
    heights_.add(command, files, "--height-out",
                 "write the heights: lengths as floats, or from 0 to 1, with the range reported");
    positions_.add(command, files, "--position-out", "write x, y and z of what rays hit, as floats");
    occlusion_.add(command, files, "--occlusion-out", "write ambient occlusion: 1 is open, 0 closed")
        .often(2, "write ambient occlusion");
    Option& into = command.option("--occlusion-into", "WHERE", "put ambient occlusion into the output",
                                  [this](const std::string& text) {
                                      if (text != "model") throw UsageError("must be model");
                                      occlusion_into_model_ = true;
                                  });
    into.words = {{"model", "into the red of each material's texture of roughness, or a texture of its own"}};
    into.completes = Completes::words;
    bent_.add(command, files, "--bent-out", "write bent normals, the mean directions that are open, in tangent space");
    thickness_.add(command, files, "--thickness-out", "write the mean thickness of the high mesh, stored as heights");
    color_.add(command, files, "--color-out", "write the colours that --high-color names");
    vertex_color_.add(command, files, "--vertex-color-out", "write the colours of the high mesh's vertices");
    missed_out_.add(command, files, "--missed-out", "write a picture whose missed texels are red, and those hit grey");
}

void TransferMaps::amend(Task& task) const {
    for (const MapOutput* map :
         {&object_, &heights_, &positions_, &occlusion_, &bent_, &thickness_, &color_, &vertex_color_, &missed_out_})
        map->amend(task);
    if (positions_.is_given() && !can_hold(positions_.container_for(task), Encoding::float_))
        throw UsageError("--position-out", "only exr, dds and ktx2 files hold floats");
}

void TransferMaps::request(TransferOptions& options) const {
    options.object = object_.is_given();
    options.heights = heights_.is_given();
    options.positions = positions_.is_given();
    options.occlusion = occlusion_.is_given();
    options.bent = bent_.is_given();
    options.thickness = thickness_.is_given();
    options.vertex_colors = vertex_color_.is_given();
}

Result<void> TransferMaps::write(Job& job, TransferredMaps& maps, YAxis y) const {
    if (object_.is_given()) {
        if (auto done = write_normals(job, object_, std::move(maps.object), YAxis::up, "object"); !done) return done;
    }
    if (heights_.is_given()) {
        if (auto done = write_heights(job, maps); !done) return done;
    }
    if (positions_.is_given()) {
        Json report;
        std::vector<Plane<float>> planes;
        for (Plane<float>& plane : maps.position) planes.push_back(std::move(plane));
        if (auto done = write_floats(job, positions_, std::move(planes), report); !done) return done;
        job.report["positions"] = std::move(report);
    }
    if (occlusion_.is_given()) {
        if (auto done = write_occlusion(job, maps); !done) return done;
    }
    if (bent_.is_given()) {
        if (auto done = write_normals(job, bent_, std::move(maps.bent), y, "bent"); !done) return done;
    }
    if (thickness_.is_given()) {
        Json& report = job.report["thickness"];
        report = {{"lowest", maps.thinnest}, {"highest", maps.thickest}};
        auto done = write_lengths(job, thickness_, std::move(maps.thickness), maps.thinnest, maps.thickest, report);
        if (!done) return done;
    }
    if (color_.is_given()) {
        if (auto done = write_colors(job, color_, std::move(maps.color), "colors"); !done) return done;
    }
    if (vertex_color_.is_given()) {
        auto done = write_colors(job, vertex_color_, std::move(maps.vertex_color), "vertex_colors");
        if (!done) return done;
    }
    if (!missed_out_.is_given()) return {};
    return write_colors(job, missed_out_, missed_picture(maps.origin, kMaxExtent), "missed_picture");
}

// Into report[key].
Result<void> TransferMaps::write_normals(Job& job, const MapOutput& output, NormalMap normals, YAxis y,
                                         const char* key) const {
    Json report;
    if (auto done = output.write(job, std::move(normals), y, report); !done) return done;
    job.report[key] = std::move(report);
    return {};
}

// Tiles of a mesh must fit each other. So 0 and 1 are what rays reach, which is the same for all of them, whatever each
// has hit.
Result<void> TransferMaps::write_heights(Job& job, TransferredMaps& maps) const {
    float lowest = maps.lowest, highest = maps.highest;
    if (job.task.is_tile_of_mesh() && !heights_.holds_floats(job)) {
        lowest = std::min(lowest, static_cast<float>(-maps.back));
        highest = std::max(highest, static_cast<float>(maps.front));
        job.say(fmt::format("{}: heights from {:.4g} to {:.4g} are stored from 0 to 1\n",
                            printable(heights_.path_for(job.task)), lowest, highest));
    }
    return write_lengths(job, heights_, std::move(maps.heights), lowest, highest, job.report["heights"]);
}

// Values stay as they are in files of floats, otherwise go from 0 to 1.
Result<void> TransferMaps::write_lengths(Job& job, const MapOutput& output, Plane<float> lengths, float lowest,
                                         float highest, Json& report) const {
    if (!output.holds_floats(job)) {
        // A flat map has no range.
        const float high = highest > lowest ? highest : lowest + 1.0f;
        stretch_heights(lengths, lowest, high, {job.threads(), {}});
        report["stored"] = {lowest, high};
    }
    return output.write(job, std::move(lengths), report);
}

Result<void> TransferMaps::write_occlusion(Job& job, TransferredMaps& maps) const {
    Json report;
    if (auto done = occlusion_.write(job, std::move(maps.occlusion), report); !done) return done;
    job.report["occlusion"] = std::move(report);
    return {};
}

// Three planes as they are, which are no normals.
Result<void> TransferMaps::write_floats(Job& job, const MapOutput& output, std::vector<Plane<float>> planes,
                                        Json& report) {
    MipChain chain;
    chain.levels.emplace_back();
    chain.levels.front().x = std::move(planes[0]);
    chain.levels.front().y = std::move(planes[1]);
    chain.levels.front().z = std::move(planes[2]);
    PackOptions with;
    with.encoding = Encoding::float_;
    auto texture = pack(chain, with, {job.threads(), {}});
    if (!texture) return texture.error();
    texture->swizzle.fill(Component::other);
    texture->swizzle_known = texture->y_known = false;
    return output.write(job, *texture, report);
}

// Into report[key].
Result<void> TransferMaps::write_colors(Job& job, const MapOutput& output, Image colors, const char* key) {
    Json report;
    auto done = output.holds_floats(job) ? write_floats(job, output, std::move(colors.planes), report)
                                         : output.write(job, colors, report);
    if (!done) return done;
    job.report[key] = std::move(report);
    return {};
}

bool repeats(const TransferredMaps& maps, int subsamples) {
    return maps.overlaps + maps.moved > 2 * maps.covered * subsamples * subsamples;
}

}  // namespace tex::cli
