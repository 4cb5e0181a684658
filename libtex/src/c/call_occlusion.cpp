// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <tex/surface.h>

#include "c/call_bake.h"
#include "kernels/bake.h"
#include "kernels/horizon.h"
#include "rows/whole_vectors.h"
#include "surface/horizons.h"

namespace tex::inline v1 {
namespace {

constexpr int kAllMaps = TEX_OCCLUSION | TEX_SKY_VIEW | TEX_BENT;
const Execution kCallingThread{1, {}};

// How a surface is made, and what of it.
struct Wanted {
    HeightFieldHead head;
    BakeOptions bake;
    OcclusionOptions options;
};

int32_t wanted_of(const tex_occlusion_options* options, Wanted& out) {
    tex_occlusion_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (!is_bake(o.kernel, o.gaussian_sigma, o.wrap_x, o.wrap_y)) return TEX_BAD_OPTION;
    const auto sign = [](float x) { return (x > 0.0f) - (x < 0.0f); };
    if (!std::isfinite(o.bumpiness_x) || !std::isfinite(o.bumpiness_y) || sign(o.bumpiness_x) != sign(o.bumpiness_y))
        return TEX_BAD_OPTION;
    if ((o.maps & ~kAllMaps) != 0 || (o.maps == 0 && o.horizons == 0)) return TEX_BAD_OPTION;
    out.head = {o.bumpiness_x, o.bumpiness_y, static_cast<Wrap>(o.wrap_x), static_cast<Wrap>(o.wrap_y)};
    out.bake = bake_options(o.kernel, o.gaussian_sigma);
    out.options = {
        o.directions, o.distance, (o.maps & TEX_OCCLUSION) != 0, (o.maps & TEX_SKY_VIEW) != 0, (o.maps & TEX_BENT) != 0,
        o.horizons};
    const bool is_in_range = o.directions >= 4 && o.directions <= 1024 && o.distance >= 0.0f &&
                             std::isfinite(o.distance) && (o.horizons == 0 || (o.horizons >= 4 && o.horizons <= 64));
    return is_in_range ? TEX_OK : TEX_BAD_OPTION;
}

// The copy of the heights; the field in one orientation and the sums, of which one is turned over at a time, with room
// for pieces that do not fit where others were; horizons; hulls; the horizons of one direction of a band; what holds
// planes in the memory of others; the rows that become turned columns.
std::size_t occlusion_scratch(std::int64_t width, std::int64_t height, const Wanted& wanted) {
    const auto whole = [](std::int64_t count) { return (count + kWhole - 1) / kWhole * kWhole; };
    const std::int64_t longer = std::max(width, height), run_in = std::max<std::int64_t>(longer, 256);
    const OcclusionOptions& o = wanted.options;
    const int radius = gradient_radius(wanted.bake);
    const int sums = (o.occlusion ? 1 : 0) + (o.sky_view ? 1 : 0) + (o.bent ? 3 : 0);
    ScratchSize size;
    for (int k = 0; k < 1 + 3 + sums + 3; ++k) size.plane(whole(width), whole(height));
    if (o.horizons > 0) size.plane(width, height * o.horizons);
    size.plane(2 * kBandLines, (longer + run_in) / 2 + 40);
    size.plane(kBandLines, longer);
    size.vector<int>(longer + 2 * run_in + 16);
    size.vector<Plane<float>>(2 * (3 + sums));
    for (int k = 0; k < 3; ++k) size.plane(width, std::max(64, 4 * radius));
    for (int k = 0; k < 3; ++k) size.plane(width, 1);
    for (int k = 0; k < 2; ++k) size.vector<double>(10 * (o.directions + o.horizons));
    add_gradient(size, radius);
    add_bake_rows(size, static_cast<int>(width), radius);
    return size.bytes();
}

// Whether all maps that are made have a place.
bool are_places(const tex_occlusion_maps& maps, const OcclusionOptions& made, const tex_plane& heights) {
    const auto is_place = [&](const tex_plane* plane) { return is_plane(plane) && same_extent(*plane, heights); };
    if (made.occlusion && !is_place(maps.occlusion)) return false;
    if (made.sky_view && !is_place(maps.sky_view)) return false;
    if (made.bent && !(is_map(maps.bent) && same_extent(*maps.bent, heights))) return false;
    for (int k = 0; k < made.horizons; ++k) {
        if (maps.horizons == nullptr || !is_place(maps.horizons + k)) return false;
    }
    return true;
}

void copy_rows(const Plane<float>& from, int first, const tex_plane& to) {
    for (int j = 0; j < to.height; ++j) std::copy_n(from.row(first + j), to.width, row_of(to, j));
}

int32_t make_occlusion(const tex_plane& heights, const Wanted& wanted, const tex_occlusion_maps& out) {
    const Extent extent{heights.width, heights.height};
    Plane<float> copy(extent);
    for (int j = 0; j < extent.height; ++j) {
        std::copy_n(row_of(heights, j), extent.width, copy.row(j));
        if (!are_finite(copy.row(j), (extent.width + kWhole - 1) / kWhole * kWhole)) return TEX_BAD_DATA;
    }
    const Gradient gradient = gradient_of(wanted.bake);
    const HorizonSource source{copy, copy, wanted.head, gradient, middle_strength(wanted.head, extent)};
    const Result<SkyMaps> made = sky_of(source, wanted.options, kCallingThread, {});
    if (!made) return TEX_OUT_OF_MEMORY;
    if (wanted.options.occlusion) copy_rows(made->occlusion, 0, *out.occlusion);
    if (wanted.options.sky_view) copy_rows(made->sky_view, 0, *out.sky_view);
    for (int k = 0; k < wanted.options.horizons; ++k) copy_rows(made->horizons, k * extent.height, out.horizons[k]);
    if (!wanted.options.bent) return TEX_OK;
    const tex_map& bent = *out.bent;
    copy_rows(made->bent.x, 0, {bent.x, bent.stride, bent.width, bent.height});
    copy_rows(made->bent.y, 0, {bent.y, bent.stride, bent.width, bent.height});
    copy_rows(made->bent.z, 0, {bent.z, bent.stride, bent.width, bent.height});
    return TEX_OK;
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

size_t tex_occlusion_size(int32_t width, int32_t height, const tex_occlusion_options* options) {
    Wanted wanted;
    if (!is_extent(width, height) || wanted_of(options, wanted) != TEX_OK) return 0;
    return occlusion_scratch(width, height, wanted);
}

int32_t tex_occlusion(const tex_plane* heights, const tex_occlusion_options* options, const tex_occlusion_maps* out,
                      void* scratch, size_t scratch_size) {
    if (!is_plane(heights)) return TEX_BAD_ARGUMENT;
    Wanted wanted;
    if (const int32_t error = wanted_of(options, wanted); error != TEX_OK) return error;
    tex_occlusion_maps maps;
    if (const int32_t error = copy_options(out, maps); error != TEX_OK) return error;
    if (!are_places(maps, wanted.options, *heights)) return TEX_BAD_ARGUMENT;
    return with_scratch(scratch, scratch_size, occlusion_scratch(heights->width, heights->height, wanted),
                        [&] { return make_occlusion(*heights, wanted, maps); });
}
