// SPDX-License-Identifier: Apache-2.0

#include "options/guides.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/usage_error.h"
#include "options/high_meshes.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

// A picture of one channel, or the first one of several.
Result<Plane<float>> read_plane(const std::string& file, const ReadOptions& options, float most, const char* range) {
    ReadOptions how = options;
    how.values = FileValues::unit;
    auto image = read_image(file, how);
    if (!image) return image.error().of(file);
    Plane<float>& plane = image->planes.front();
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i) {
            const float value = plane.at(i, j);
            if (value >= 0.0f && value <= most && std::isfinite(value)) continue;
            return Error{ErrorCode::bad_option, file,
                         fmt::format("the value {} at column {} of row {} is not {}", value, i, j, range)};
        }
    }
    return std::move(plane);
}

// The corners whose UVs differ.
std::size_t other_uvs(const MeshPart& low, const MeshPart& cage) {
    std::size_t others = 0;
    for (std::size_t c = 0; c < low.indices.size(); ++c) {
        const Float2 a = low.uvs.front()[low.indices[c]], b = cage.uvs.front()[cage.indices[c]];
        const float v = cage.v_axis == low.v_axis ? b.y : 1.0f - b.y;
        if (std::abs(a.x - b.x) > 1e-4f || std::abs(a.y - v) > 1e-4f) ++others;
    }
    return others;
}

}  // namespace

void Guides::fill(TransferInputs& inputs) const {
    if (cage) inputs.cage = &cage->selected().part;
    if (!skew.empty()) inputs.skew = &skew;
    if (!offset.empty()) inputs.offset = &offset;
}

void GuideOptions::add(Command& command) {
    const auto file = [&](std::string& pattern, const std::string& name, std::string help) -> Option& {
        Option& row = command.option(name, "FILE", std::move(help), [&pattern](const std::string& text) {
            if (text.empty() || text == "-") throw UsageError("needs a file");
            if (NamePattern(text).uses("level") || NamePattern(text).uses("format"))
                throw UsageError("{level} and {format} have no meaning here");
            pattern = text;
        });
        row.completes = Completes::files;
        return row;
    };
    command.group("Guides");
    file(cage_, "--cage", "the low mesh pushed outwards, on which rays start; of many inputs a pattern as --high")
        .often(2, "the low mesh pushed outwards, on which rays start");
    file(skew_, "--skew",
         "a picture of where rays are straight, white, and where smooth, black; implies --rays straight");
    file(offset_, "--offset", "a picture of factors for --front");
    command.check([&command] {
        const auto idle = command.given_of({"--front", "--skew", "--offset"});
        if (command.given("--cage") && !idle.empty())
            throw UsageError("--cage decides where rays start, so " + idle.front() + " has no meaning");
        if (command.given("--skew") && command.given("--straight-width"))
            throw UsageError("--skew decides where rays are straight, so --straight-width has no meaning");
    });
}

const char* GuideOptions::remedy() const {
    if (!cage_.empty()) return "move the cage outwards there";
    return offset_.empty() ? "" : "raise the factors of --offset there, or --front";
}

std::string GuideOptions::name_of(const std::string& pattern, const Task& task) {
    return pattern.empty() ? std::string() : with_tile(NamePattern(pattern).expand(name_fields(task.input)), task.tile);
}

void GuideOptions::amend(Task& task) const {
    for (const std::string* pattern : {&cage_, &skew_, &offset_}) {
        if (!pattern->empty()) task.own.push_back(name_of(*pattern, task));
    }
    if (cage_.empty()) return;
    for (std::string& buffer : HighMeshes::buffers_of({name_of(cage_, task)})) task.own.push_back(std::move(buffer));
}

Result<MeshSpace> GuideOptions::read_cage(Job& job, const TangentSpaceOptions& low, const MeshSpace& space) const {
    const std::string file = name_of(cage_, job.task);
    auto cage = low.cage(file, job.task, job.read_options, {job.threads(), {}});
    if (!cage) return cage.error();
    const std::size_t triangles = space.selected().part.triangles();
    if (cage->selected().part.triangles() != triangles) {
        return Error{ErrorCode::bad_option, file,
                     fmt::format("has {} triangles, but the low mesh has {}: a cage is the low mesh, pushed outwards",
                                 cage->selected().part.triangles(), triangles)};
    }
    if (const std::size_t others = other_uvs(space.selected().part, cage->selected().part); others > 0) {
        job.warn(
            fmt::format("{} of {} corners have other UVs than in the low mesh; are the triangles in another order?",
                        others, 3 * triangles),
            file);
    }
    return cage;
}

Result<Guides> GuideOptions::read(Job& job, const TangentSpaceOptions& low, const MeshSpace& space) const {
    Guides guides;
    if (!cage_.empty()) {
        auto cage = read_cage(job, low, space);
        if (!cage) return cage.error();
        guides.cage = std::move(*cage);
    }
    if (!skew_.empty()) {
        auto skew = read_plane(name_of(skew_, job.task), job.read_options, 1.0f, "between 0 and 1");
        if (!skew) return skew.error();
        guides.skew = std::move(*skew);
    }
    if (!offset_.empty()) {
        auto offset = read_plane(name_of(offset_, job.task), job.read_options, 1e30f, "0 or more");
        if (!offset) return offset.error();
        guides.offset = std::move(*offset);
    }
    return guides;
}

}  // namespace tex::cli
