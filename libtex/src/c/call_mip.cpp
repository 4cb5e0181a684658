// SPDX-License-Identifier: Apache-2.0

#include "c/call.h"
#include "rows/mip_rows.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

int32_t mip_options(const tex_mip_options* options, MipOptions& out) {
    tex_mip_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (!is_one_of(o.filter, kMipFilterNames) || !is_one_of(o.domain, kMipDomainNames) ||
        !is_one_of(o.wrap_x, kWrapNames) || !is_one_of(o.wrap_y, kWrapNames) || (o.any_z != 0 && o.any_z != 1))
        return TEX_BAD_OPTION;
    const bool fades = o.fade_first != 0 || o.fade_last != 0;
    if (fades && (o.fade_first < 0 || o.fade_first >= o.fade_last)) return TEX_BAD_OPTION;
    if (o.any_z == 1 && (fades || o.domain != TEX_DOMAIN_VECTOR)) return TEX_BAD_OPTION;
    out.filter = static_cast<MipFilter>(o.filter);
    out.domain = static_cast<MipDomain>(o.domain);
    out.wrap_x = static_cast<Wrap>(o.wrap_x);
    out.wrap_y = static_cast<Wrap>(o.wrap_y);
    if (fades) out.fade = Fade{o.fade_first, o.fade_last};
    out.any_z = o.any_z == 1;
    return TEX_OK;
}

// What LevelFilter, LevelSource and MipRows take.
std::size_t mip_scratch(Extent from, const MipOptions& options) {
    const Extent to{std::max(1, from.width / 2), std::max(1, from.height / 2)};
    const int taps_x = most_taps(options.filter, from.width), taps_y = most_taps(options.filter, from.height);
    const auto padded = [](int count) { return std::int64_t{count + kWhole - 1} / kWhole * kWhole; };
    ScratchSize size;
    size.vector<float>(padded(to.width) * taps_x);
    size.vector<float>(padded(to.height) * taps_y);
    if (options.domain == MipDomain::slope) {
        for (int k = 0; k < 2; ++k) size.plane(from.width, taps_y);
        size.vector<int>(taps_y);
    }
    size.vector<const float*>(taps_y);
    const int pairs = to.width + taps_x / 2;
    size.plane(padded(taps_x) + std::max(std::int64_t{from.width} + taps_x, 2 * padded(pairs)), 1);
    size.plane(padded(pairs) + padded(taps_x), 2);
    size.plane(to.width, 1);
    size.vector<float>(taps_x);
    size.vector<float>(taps_y);
    return size.bytes();
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

size_t tex_mip_size(int32_t width, int32_t height, const tex_mip_options* options) {
    MipOptions o;
    if (!is_extent(width, height) || mip_options(options, o) != TEX_OK) return 0;
    return mip_scratch({width, height}, o);
}

int32_t tex_mip_level(const tex_map* from, int32_t level, const tex_mip_options* options, int32_t first, int32_t end,
                      const tex_map* to, void* scratch, size_t scratch_size) {
    if (!is_map(from) || !is_map(to) || level < 0 || !are_rows(first, end, to->height)) return TEX_BAD_ARGUMENT;
    if (to->width != std::max(1, from->width / 2) || to->height != std::max(1, from->height / 2))
        return TEX_BAD_ARGUMENT;
    MipOptions o;
    if (const int32_t error = mip_options(options, o); error != TEX_OK) return error;
    const Extent extent{from->width, from->height};
    return with_scratch(scratch, scratch_size, mip_scratch(extent, o), [&] {
        const LevelFilter filter(extent, o);
        const NormalMap source_map = borrowed(*from);
        NormalMap made = borrowed(*to);
        LevelSource source(filter, source_map, o, level == 0);
        MipRows rows(filter);
        for (int j = first; j < end; ++j) {
            source.prepare(j);
            for (int plane = 0; plane < averaged_planes(o); ++plane)
                rows.make_exactly(source.window(plane, j), j, plane_of(made, plane).row(j));
        }
        return TEX_OK;
    });
}

int32_t tex_mip_finish(const tex_map* map, int32_t level, const tex_mip_options* options, int32_t first, int32_t end) {
    if (!is_map(map) || level < 1 || !are_rows(first, end, map->height)) return TEX_BAD_ARGUMENT;
    MipOptions o;
    if (const int32_t error = mip_options(options, o); error != TEX_OK) return error;
    for (int j = first; j < end; ++j) {
        const NormalRow row = row_of(*map, j);
        const float* const from[] = {row.x, row.y, row.z};
        float* const to[] = {row.x, row.y, row.z};
        in_whole_vectors(map->width, from, to, [&](const float* const* in, float* const* out, int count) {
            for (int k = 0; k < 3; ++k) {
                if (in[k] != out[k]) std::copy_n(in[k], count, out[k]);
            }
            finish_row({out[0], out[1], out[2]}, count, o, level);
        });
    }
    return TEX_OK;
}
