// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <limits>

#include <tex/height.h>
#include <tex/surface.h>

#include "c/call_bake.h"
#include "kernels/slopes.h"
#include "kernels/stored.h"
#include "rows/height_steps.h"
#include "surface/bending_grid.h"
#include "surface/debander.h"
#include "surface/integrator.h"

namespace tex::inline v1 {
namespace {

const Execution kThisThread{1, {}};

void copy_rows(const Plane<float>& from, const tex_plane& to) {
    for (int j = 0; j < to.height; ++j) std::copy_n(from.row(j), to.width, row_of(to, j));
}

// At first, the copy of the heights and the different ones of each strip. Then the grids: codes and a quarter of
// weights, and a third of both for the coarser ones; heights before and after a step, and what weighs a grid while it
// is made: less than four planes together, and rows of filters and strips.
std::size_t deband_scratch(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t kStrips = 64, kTable = 4 * kMostCodes;
    ScratchSize looks;
    looks.plane(width, height);
    for (std::int64_t k = 0; k < std::min(kStrips, height / kBendingStrip + 1) + 2; ++k) looks.vector<float>(kTable);
    looks.vector<double>(8 * kStrips);
    ScratchSize grids;
    for (int k = 0; k < 4; ++k) grids.plane(width, height);
    for (int k = 0; k < 32; ++k) grids.plane(width + 128, 1);
    for (int k = 0; k < 20; ++k) grids.plane(64, 16);
    grids.plane(width + 128, 4 * (height / kBendingStrip + 1));
    return std::max(looks.bytes(), grids.bytes());
}

int32_t integrate_options(const tex_integrate_options* options, IntegrateOptions& out) {
    tex_integrate_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (!is_bake(o.kernel, o.gaussian_sigma, o.wrap_x, o.wrap_y)) return TEX_BAD_OPTION;
    for (const float bumpiness : {o.bumpiness_x, o.bumpiness_y}) {
        if (!(std::abs(bumpiness) >= 1e-20f && std::abs(bumpiness) <= 1e20f)) return TEX_BAD_OPTION;
    }
    if (!(o.least_z > 0.0f && o.least_z <= 1.0f) || !(o.least_response >= 0.0f && o.least_response <= 1.0f) ||
        o.most_steps < 1)
        return TEX_BAD_OPTION;
    out.bake = bake_options(o.kernel, o.gaussian_sigma);
    out.bumpiness_x = o.bumpiness_x;
    out.bumpiness_y = o.bumpiness_y;
    out.wrap_x = static_cast<Wrap>(o.wrap_x);
    out.wrap_y = static_cast<Wrap>(o.wrap_y);
    out.least_z = o.least_z;
    out.least_response = o.least_response;
    out.most_steps = o.most_steps;
    return TEX_OK;
}

// The map with its padding, heights, and the slopes and the change of refine(); the transforms of both axes, which may
// be four times as long (Bluestein), with their factors; rows.
std::size_t integrate_scratch(std::int64_t width, std::int64_t height, int radius) {
    const std::int64_t longer = std::max(width, height);
    ScratchSize size;
    for (int k = 0; k < 7; ++k) size.plane(width, height);
    for (int k = 0; k < 2; ++k) size.plane(kGroup, 5 * longer + 64);
    for (const std::int64_t axis : {width, height}) size.vector<float>(28 * (axis + 64));
    add_gradient(size, radius);
    for (int k = 0; k < 2; ++k) add_bake_rows(size, static_cast<int>(width), radius);
    for (int k = 0; k < 2; ++k) size.plane(width + 2 * radius + 32, 2 * radius + 8);
    size.vector<double>(height + 64);
    return size.bytes();
}

// Copies the map, whose rows end with their last texels, to planes.
NormalMap copied(const tex_map& map) {
    NormalMap copy(Extent{map.width, map.height});
    for (int j = 0; j < map.height; ++j) {
        const NormalRow row = row_of(map, j);
        std::copy_n(row.x, map.width, copy.x.row(j));
        std::copy_n(row.y, map.width, copy.y.row(j));
        std::copy_n(row.z, map.width, copy.z.row(j));
    }
    return copy;
}

int32_t integrate_map(const NormalMap& map, const IntegrateOptions& options, const tex_plane& out,
                      tex_integrate_report& report) {
    const Integrator integrator(map, options);
    const auto count = integrator.count(kThisThread);
    if (!count) return TEX_OUT_OF_MEMORY;
    if (is_unusable(*count, map.extent())) return TEX_BAD_DATA;
    report.unused_texels = count->unused;
    int steps = 0;
    auto heights = integrator.heights(count->unused, kThisThread, {}, steps);
    if (!heights) return TEX_OUT_OF_MEMORY;
    report.steps = steps;
    const float larger = std::max(std::abs(options.bumpiness_x), std::abs(options.bumpiness_y));
    const auto highest = settle_heights(*heights, larger, kThisThread);
    if (!highest) return highest.error().code == ErrorCode::bad_data ? TEX_BAD_DATA : TEX_OUT_OF_MEMORY;
    report.highest = *highest;
    copy_rows(*heights, out);
    return TEX_OK;
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

size_t tex_deband_size(int32_t width, int32_t height) {
    return is_extent(width, height) ? deband_scratch(width, height) : 0;
}

int32_t tex_deband(const tex_plane* heights, int32_t wrap_x, int32_t wrap_y, int32_t when, tex_deband_report* report,
                   void* scratch, size_t scratch_size) {
    if (!is_plane(heights) || !is_report(report)) return TEX_BAD_ARGUMENT;
    if (!is_one_of(wrap_x, kWrapNames) || !is_one_of(wrap_y, kWrapNames) || (when != 1 && when != 2))
        return TEX_BAD_OPTION;
    const std::size_t wanted = deband_scratch(heights->width, heights->height);
    return with_scratch(scratch, scratch_size, wanted, [&]() -> int32_t {
        Plane<float> plane(Extent{heights->width, heights->height});
        for (int j = 0; j < heights->height; ++j) std::copy_n(row_of(*heights, j), heights->width, plane.row(j));
        const auto found = deband_heights(plane, static_cast<Wrap>(wrap_x), static_cast<Wrap>(wrap_y),
                                          when == 1 ? Deband::on : Deband::automatic, kThisThread, {});
        if (!found) return TEX_OUT_OF_MEMORY;
        if (found->applied) copy_rows(plane, *heights);
        write_report({0, found->applied ? 1 : 0, found->step, found->codes, found->terrace_texels}, report);
        return TEX_OK;
    });
}

size_t tex_integrate_size(int32_t width, int32_t height, const tex_integrate_options* options) {
    IntegrateOptions o;
    if (!is_extent(width, height) || integrate_options(options, o) != TEX_OK) return 0;
    return integrate_scratch(width, height, gradient_radius(o.bake));
}

int32_t tex_integrate(const tex_map* map, const tex_integrate_options* options, const tex_plane* heights,
                      tex_integrate_report* report, void* scratch, size_t scratch_size) {
    if (!is_map(map) || !is_plane(heights) || !same_extent(*map, *heights) || !is_report(report))
        return TEX_BAD_ARGUMENT;
    IntegrateOptions o;
    if (const int32_t error = integrate_options(options, o); error != TEX_OK) return error;
    const std::size_t wanted = integrate_scratch(map->width, map->height, gradient_radius(o.bake));
    return with_scratch(scratch, scratch_size, wanted, [&]() -> int32_t {
        tex_integrate_report made = {};
        const NormalMap copy = copied(*map);
        if (const int32_t error = integrate_map(copy, o, *heights, made); error != TEX_OK) return error;
        write_report(made, report);
        return TEX_OK;
    });
}
