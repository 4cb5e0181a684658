// SPDX-License-Identifier: Apache-2.0

#include <tex/transfer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "fields/field_check.h"
#include "fields/mesh_fields.h"
#include "fields/range.h"
#include "mesh/coverage.h"
#include "mesh/frames.h"
#include "rays/found_reach.h"
#include "rays/transfer_strips.h"
#include "rows/usable.h"
#include "surface/nearest.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

double diagonal_of(const MeshPart& part) {
    Vector3 low = vector_of(part.positions[part.indices.front()]), high = low;
    for (const std::uint32_t v : part.indices) {
        const Vector3 p = vector_of(part.positions[v]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::sqrt(dot(high - low, high - low));
}

double length_of(const Reach& reach, double diagonal, double automatic) {
    switch (reach.unit) {
        case Reach::Unit::absolute: return reach.value;
        case Reach::Unit::percent: return reach.value / 100.0 * diagonal;
        case Reach::Unit::automatic: break;
    }
    return automatic;
}

// The whole low mesh, with the triangles that get texels first.
MeshPart with_rest(const MeshPart& part, const MeshPart& rest) {
    MeshPart whole;
    whole.positions = part.positions;
    whole.normals = part.normals;
    whole.indices = part.indices;
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    whole.positions.insert(whole.positions.end(), rest.positions.begin(), rest.positions.end());
    whole.normals.insert(whole.normals.end(), rest.normals.begin(), rest.normals.end());
    whole.normals.resize(whole.positions.size(), Float3{0.0f, 0.0f, 1.0f});
    for (const std::uint32_t v : rest.indices) whole.indices.push_back(first + v);
    return whole;
}

// Fills missed texels and the padding from the nearest texel with a hit. The others become background.
Result<void> fill_rest(TransferredMaps& result, std::int64_t width, const Execution& execution, ProgressSpan span) {
    struct Filled {
        Plane<float>* plane;
        float background;
    };
    std::vector<Filled> filled;
    const auto add = [&](Plane<float>& plane, float background) {
        if (!plane.empty()) filled.push_back(Filled{&plane, background});
    };
    for (NormalMap* map : {&result.map, &result.object, &result.bent}) {
        add(map->x, 0.0f);
        add(map->y, 0.0f);
        add(map->z, 1.0f);
    }
    for (Plane<float>* plane : {&result.heights, &result.position[0], &result.position[1], &result.position[2]})
        add(*plane, 0.0f);
    add(result.occlusion, 1.0f);
    add(result.thickness, 0.0f);
    for (Image* colors : {&result.color, &result.vertex_color}) {
        for (Plane<float>& plane : colors->planes) add(plane, 0.0f);
    }
    const auto fill = [&](const NearestTexel& hole) {
        TexelOrigin& origin = result.origin.at(hole.i, hole.j);
        const bool is_background = origin == TexelOrigin::none && hole.squared > width * width;
        if (origin == TexelOrigin::none && !is_background) origin = TexelOrigin::padding;
        for (const Filled& of : filled)
            of.plane->at(hole.i, hole.j) = is_background ? of.background : of.plane->at(hole.column, hole.row);
        if (!result.ids.empty())
            result.ids.at(hole.i, hole.j) = is_background ? kNoId : result.ids.at(hole.column, hole.row);
    };
    return visit_holes(result.map.x.view(), Wrap::repeat, Wrap::repeat, execution, span, fill);
}

// Whether any triangle has.
bool has_area(const RayGroups& groups) {
    for (const RayGroup& group : groups.all()) {
        const MeshPart* last = nullptr;
        for (const MeshPart* part : group.triangles().parts()) {
            if (part == std::exchange(last, part)) continue;  // in several places
            for (std::size_t t = 0; t < part->triangles(); ++t) {
                const auto corners = Triangles::Triangle{*part, t}.corners();
                const Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
                if (dot(normal, normal) > 0.0) return true;
            }
        }
    }
    return false;
}

Error no_hit(const TangentSpace& low, const RayGroups& groups, bool has_cage, const TransferredMaps& result) {
    const std::string reach =
        "rays reach " + rounded_text(result.front, 4) + " in front and " + rounded_text(result.back, 4) + " behind";
    const double distance = distance_between(low.part, groups);
    if (!has_area(groups)) return {ErrorCode::bad_option, low.file, "no triangle of the high mesh has an area"};
    if (result.diagonal == 0.0)
        return {ErrorCode::bad_option, low.file, "all corners of its triangles are in one place"};
    if (distance > std::max(result.front, result.back)) {
        return {ErrorCode::bad_option, low.file,
                "no ray hits the high mesh, which is " + rounded_text(distance, 4) + " away, while " + reach +
                    ": both must be in the same place and unit"};
    }
    if (result.behind > 0) {
        const std::string cage =
            has_cage ? "The cage may lie inside the high mesh: push it outwards. If the high mesh is inside out, turn "
                       "its triangles, or let back faces count"
                     : "Turn them, or let back faces count";
        return {ErrorCode::bad_option, low.file,
                "no ray hits the high mesh from outside: the triangles that rays meet face the other way. " + cage};
    }
    return {ErrorCode::bad_option, low.file, "no ray hits the high mesh, while " + reach + ": rays must reach farther"};
}

// Sets result.front and result.back.
Result<void> set_reach(const MeshPart& low, const RayDirections& directions, const RayGroups& groups,
                       const TransferOptions& options, const Execution& execution, TransferredMaps& result) {
    FoundReach found;
    if (options.front.unit == Reach::Unit::automatic || options.back.unit == Reach::Unit::automatic) {
        const auto reach = found_reach(low, directions, groups, result.diagonal, execution);
        if (!reach) return reach.error();
        found = *reach;
    }
    result.front = length_of(options.front, result.diagonal, found.front);
    result.back = length_of(options.back, result.diagonal, found.back);
    return {};
}

Image colors_of(Extent extent) {
    Image colors;
    for (const char* const name : {"R", "G", "B"}) {
        colors.planes.emplace_back(extent);
        colors.names.emplace_back(name);
    }
    return colors;
}

void make_room(Extent extent, const TransferOptions& options, TransferredMaps& result) {
    result.map = NormalMap(extent);
    result.origin = Plane<TexelOrigin>(extent);
    if (options.object) result.object = NormalMap(extent);
    if (options.heights) result.heights = Plane<float>(extent);
    for (Plane<float>& plane : result.position) {
        if (options.positions) plane = Plane<float>(extent);
    }
    if (options.occlusion) result.occlusion = Plane<float>(extent);
    if (options.bent) result.bent = NormalMap(extent);
    if (options.thickness) result.thickness = Plane<float>(extent);
}

Result<void> check_places(const TransferInputs& inputs, const std::vector<MeshPart>& high) {
    for (const PartPlace& place : inputs.high_places) {
        if (place.part >= high.size()) return bad_option("high_places: the high mesh has no such part");
    }
    return {};
}

Result<TransferredMaps> cast_all(Extent extent, const TangentSpace& low, const std::vector<MeshPart>& high,
                                 const TransferInputs& inputs, const TransferOptions& options,
                                 const Execution& execution) {
    const int n = options.subsamples;
    const auto coverage = CoverageMap::make(low.part, low.uv_set, {extent.width * n, extent.height * n}, 0, n);
    if (!coverage) return coverage.error().of(low.file);
    const auto groups = RayGroups::make(low.part, high, inputs, options.has_second_rays(), execution, {0.0, 0.1});
    if (!groups) return groups.error();
    TransferredMaps result;
    std::optional<MeshPart> joined;
    if (inputs.around != nullptr) joined = with_rest(low.part, *inputs.around);
    const MeshPart& whole = joined ? *joined : low.part;
    result.diagonal = diagonal_of(whole);
    const double width = length_of(options.straight_width, result.diagonal, 0.05 * result.diagonal);
    const auto directions = RayDirections::make(whole, options.rays, width, options.straight_angle, execution);
    if (!directions) return directions.error();
    const MeshPart& reaching = groups->has_all() ? whole : low.part;
    if (auto set = set_reach(reaching, *directions, *groups, options, execution, result); !set)
        return set.error().of(low.file);
    const RayStarts starts(*directions, inputs, result.front, result.diagonal);
    const HighSurface surface(high, inputs);
    result.front = starts.farthest(low.part);

    make_room(extent, options, result);
    if (surface.has_ids()) result.ids = Plane<std::int32_t>(extent);
    if (surface.has_colors()) result.color = colors_of(extent);
    if (options.vertex_colors) result.vertex_color = colors_of(extent);
    std::vector<RayCaster> casters;
    for (const RayGroup& group : groups->all())
        casters.emplace_back(group.triangles(), group.tree(), surface, options.hit, options.backfaces, result.back);
    std::optional<SecondRays> second;
    if (options.has_second_rays()) {
        constexpr double kNoLimit = std::numeric_limits<double>::infinity();
        second.emplace(groups->whole(), surface, options,
                       length_of(options.occlusion_distance, result.diagonal, kNoLimit));
    }
    const TransferScene scene{
        low, *groups,           casters,    surface, starts, *coverage, second ? &*second : nullptr,
        n,   options.backfaces, inputs.rays};
    TransferStrips strips(scene, result);
    const auto run = [&](int begin, int end) {
        for (int strip = begin; strip < end; ++strip) strips.run(strip);
    };
    if (auto done = parallel_for(execution, coverage->strips(), 1, run, {0.1, 0.9}); !done) return done.error();
    if (auto fair = strips.check(); !fair) return fair.error().of(low.file);
    if (result.covered == 0) return Error{ErrorCode::bad_option, low.file, "its triangles cover no texel of the map"};
    if (result.covered == result.missed) return no_hit(low, *groups, inputs.cage != nullptr, result);
    strips.finish();
    return result;
}

}  // namespace

Result<void> validate(const TransferOptions& options) {
    const auto is_length = [](const Reach& reach) {
        return reach.unit == Reach::Unit::automatic || contains(kNotNegative, reach.value);
    };
    if (!is_length(options.front)) return bad_option("front: must be 0 or more");
    if (!is_length(options.back)) return bad_option("back: must be 0 or more");
    if (!is_length(options.straight_width)) return bad_option("straight_width: must be 0 or more");
    if (!is_length(options.occlusion_distance)) return bad_option("occlusion_distance: must be 0 or more");
    return check_fields(options);
}

Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low, const std::vector<MeshPart>& high,
                                 const TransferOptions& options, const Execution& execution) {
    return transfer(extent, low, high, TransferInputs{}, options, execution);
}

Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low, const std::vector<MeshPart>& high,
                                 const TransferInputs& inputs, const TransferOptions& options,
                                 const Execution& execution) {
    return no_throw(execution, [&]() -> Result<TransferredMaps> {
        if (auto usable = check_usable(extent, "the map"); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        if (auto sound = check_part(low.part); !sound) return sound.error().of(low.file);
        for (const MeshPart& part : high) {
            if (auto sound = check_part(part); !sound) return sound.error();
        }
        if (const auto checked = check_space(low); !checked) return checked.error().of(low.file);
        if (auto fit = check_places(inputs, high); !fit) return fit.error();
        const std::size_t standing = inputs.high_places.empty() ? high.size() : inputs.high_places.size();
        if (auto fit = check_inputs(inputs, low.part, standing, options.rays); !fit) return fit.error();
        if (auto fit = check_details(inputs, high); !fit) return fit.error();
        auto result = cast_all(extent, low, high, inputs, options, execution);
        if (!result) return result;
        const std::int64_t width = std::min(options.padding, 2 * kMaxExtent);
        if (auto filled = fill_rest(*result, width, execution, {0.9, 1.0}); !filled) return filled.error();
        return result;
    });
}

}  // namespace tex::inline v1
