// SPDX-License-Identifier: Apache-2.0
// no_allocation.c: calls every function of tex_c.h that promises to allocate nothing, while it counts what is
// allocated.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tex/tex_c.h>

long allocations_here(void);  // allocations.c

static int failures;

enum { kWidth = 203, kHeight = 150, kTexels = kWidth * kHeight, kScratch = 64 << 20 };

static float planes[12][kTexels];
static unsigned char bytes[kTexels * 16], scratch[kScratch];

static tex_map map_at(int first, int width, int height) {
    return (tex_map){planes[first], planes[first + 1], planes[first + 2], width, width, height};
}

// Each call is made twice: not even the first one may allocate.
#define EXPECT_NOTHING(call)                                                                                         \
    for (int round = 0; round < 2; ++round) {                                                                        \
        const long before = allocations_here();                                                                      \
        const int32_t error = (call);                                                                                \
        if (error != TEX_OK || allocations_here() != before) {                                                       \
            fprintf(stderr, "%s: %s, %ld allocations\n", #call, tex_error_text(error), allocations_here() - before); \
            ++failures;                                                                                              \
        }                                                                                                            \
    }

static void bakes_and_levels(void) {
    const tex_plane heights = {planes[9], kWidth, kWidth, kHeight};
    const tex_map map = map_at(0, kWidth, kHeight), half = map_at(3, kWidth / 2, kHeight / 2);
    for (int kernel = TEX_KERNEL_FORWARD; kernel <= TEX_KERNEL_GAUSSIAN; ++kernel) {
        tex_bake_options options = TEX_BAKE_OPTIONS;
        options.kernel = kernel;
        options.gaussian_sigma = 5.0f;
        options.wrap_x = TEX_CLAMP;
        EXPECT_NOTHING(tex_bake(&heights, &options, 0, kHeight, &map, scratch, kScratch))
        tex_integrate_options back = TEX_INTEGRATE_OPTIONS;
        back.kernel = kernel;
        back.wrap_x = TEX_CLAMP;
        const tex_plane surface = {planes[10], kWidth, kWidth, kHeight};
        EXPECT_NOTHING(tex_integrate(&map, &back, &surface, NULL, scratch, kScratch))
    }
    tex_occlusion_options hidden = TEX_OCCLUSION_OPTIONS;
    hidden.maps = TEX_OCCLUSION | TEX_SKY_VIEW | TEX_BENT;
    hidden.directions = 8;
    hidden.horizons = 4;
    const tex_plane occlusion = {planes[3], kWidth, kWidth, kHeight}, sky = {planes[4], kWidth, kWidth, kHeight};
    tex_plane horizons[4];
    for (int k = 0; k < 4; ++k) horizons[k] = (tex_plane){planes[5 + k], kWidth, kWidth, kHeight};
    const tex_occlusion_maps maps = {sizeof maps, &occlusion, &sky, &map, horizons};
    EXPECT_NOTHING(tex_occlusion(&heights, &hidden, &maps, scratch, kScratch))
    for (int filter = TEX_FILTER_BOX; filter <= TEX_FILTER_LANCZOS3; ++filter) {
        tex_mip_options options = TEX_MIP_OPTIONS;
        options.filter = filter;
        options.domain = filter % 2;
        EXPECT_NOTHING(tex_mip_level(&map, 0, &options, 0, kHeight / 2, &half, scratch, kScratch))
        EXPECT_NOTHING(tex_mip_finish(&half, 1, &options, 0, kHeight / 2))
    }
    for (int k = 0; k < kTexels; ++k) planes[10][k] = floorf(planes[9][k] * 255.0f) / 255.0f;
    const tex_plane rounded = {planes[10], kWidth, kWidth, kHeight};
    EXPECT_NOTHING(tex_deband(&rounded, TEX_CLAMP, TEX_MIRROR, 1, NULL, scratch, kScratch))
}

static void encodes_and_decodes(void) {
    const tex_map map = map_at(0, kWidth, kHeight), other = map_at(3, kWidth, kHeight);
    for (int encoding = TEX_ENCODING_DXT5NM; encoding <= TEX_ENCODING_BC7_RXGB; ++encoding) {
        for (int effort = TEX_EFFORT_FAST; effort <= TEX_EFFORT_BEST; ++effort) {
            tex_encode_options options = TEX_ENCODE_OPTIONS;
            options.encoding = encoding;
            options.effort = effort;
            if (encoding <= TEX_ENCODING_BC5_SNORM) options.metric = TEX_METRIC_ANGLE;
            // The larger sizes of ASTC run the same code.
            if (encoding > TEX_ENCODING_ASTC_5X4 && encoding <= TEX_ENCODING_ASTC_8X8 && effort != TEX_EFFORT_FAST)
                continue;
            const int32_t rows = effort == TEX_EFFORT_BEST ? 40 : kHeight, format = tex_encoding_format(encoding);
            if (tex_encode_prepare(&options) != TEX_OK) abort();
            EXPECT_NOTHING(tex_encode(&(tex_map){map.x, map.y, map.z, kWidth, kWidth, rows}, &options, 0, rows, bytes,
                                      tex_row_bytes(format, kWidth), scratch, kScratch))
        }
    }
    memset(bytes, 0x5a, sizeof bytes);
    for (int format = TEX_FORMAT_BC1_UNORM; format <= TEX_FORMAT_ETC1S_RGBA_UNORM; ++format) {
        tex_format_info info = {.size = sizeof info};
        EXPECT_NOTHING(tex_get_format(format, &info))
        const tex_texels texels = {bytes, tex_row_bytes(format, kWidth), format, kWidth, kHeight};
        tex_channels out = {{planes[6], NULL, NULL, NULL}, kWidth};
        for (int c = 1; c < info.channels; ++c) out.channel[c] = planes[6 + c];
        EXPECT_NOTHING(tex_decode(&texels, 0, kHeight, &out))
        const tex_unpack_options options = TEX_UNPACK_OPTIONS;
        if (info.channels > 1) EXPECT_NOTHING(tex_unpack(&texels, &options, 0, kHeight, &other))
    }
}

static void normals_to_normals(void) {
    const tex_map map = map_at(0, kWidth, kHeight), other = map_at(3, kWidth, kHeight);
    const tex_plane plane = {planes[11], kWidth, kWidth, kHeight};
    EXPECT_NOTHING(tex_scale(&map, 2.0f, TEX_SCALE_SLOPE, 0, kHeight, &other))
    EXPECT_NOTHING(tex_angles(&map, &other, 0, kHeight, &plane))
    for (int mode = TEX_BLEND_WHITEOUT; mode <= TEX_BLEND_OVERLAY; ++mode)
        EXPECT_NOTHING(tex_blend(&map, &other, &plane, mode, 0, kHeight, &other))
}

int main(void) {
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) planes[9][j * kWidth + i] = 0.5f + 0.4f * sinf(0.05f * (float)(i + j));
    }
    bakes_and_levels();
    encodes_and_decodes();
    normals_to_normals();
    // The counter counts what the library allocates: this function says that it does.
    static const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const uint32_t indices[3] = {0, 1, 2};
    const tex_mesh mesh = {sizeof(tex_mesh), TEX_Y_UP, corners[0], up[0], corners[0], 0, 0, 12, 3, indices, 3};
    const long before = allocations_here();
    if (tex_tangents(&mesh, TEX_MIKKTSPACE, planes[0]) != TEX_OK || allocations_here() == before) {
        fprintf(stderr, "tex_tangents() fails, or the counter does not count\n");
        ++failures;
    }
    return failures == 0 ? 0 : 1;
}
