// SPDX-License-Identifier: Apache-2.0
// bake_to_bc5.c: heights in memory to a mip chain of BC5 in memory, through tex_c.h alone: this program's memory, this
// program's threads. The samples in Rust, Python and C# do the same and print the same sum.
//
//     cc -std=c11 bake_to_bc5.c $(pkg-config --cflags --libs libtex) -o bake_to_bc5

#include <stdio.h>
#include <stdlib.h>
#include <tex/tex_c.h>

enum { kSide = 64, kLevels = 7, kHalf = kSide / 2 };

static void check(int32_t error) {
    if (error == TEX_OK) return;
    fprintf(stderr, "bake_to_bc5: %s\n", tex_error_text(error));
    exit(1);
}

// FNV-1a.
static uint64_t sum_of(uint64_t sum, const unsigned char* bytes, size_t count) {
    for (size_t k = 0; k < count; ++k) sum = (sum ^ bytes[k]) * 1099511628211u;
    return sum;
}

int main(void) {
    static float height[kSide * kSide], normals[kLevels][3][kSide * kSide];
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) height[j * kSide + i] = (float)((i * 7 + j * j * 3) % 64) / 64.0f;
    }
    tex_map maps[kLevels];
    for (int level = 0; level < kLevels; ++level) {
        const int side = kSide >> level;
        maps[level] = (tex_map){normals[level][0], normals[level][1], normals[level][2], side, side, side};
    }

    // Two halves of the rows: what two threads of a job system would do, each with its own scratch.
    const tex_plane heights = {height, kSide, kSide, kSide};
    tex_bake_options bake = TEX_BAKE_OPTIONS;
    bake.bumpiness_x = bake.bumpiness_y = 4.0f;
    tex_mip_options mip = TEX_MIP_OPTIONS;
    size_t size = tex_bake_size(kSide, kSide, &bake);
    if (size < tex_mip_size(kSide, kSide, &mip)) size = tex_mip_size(kSide, kSide, &mip);
    void* scratch = malloc(size);
    check(tex_bake(&heights, &bake, 0, kHalf, &maps[0], scratch, size));
    check(tex_bake(&heights, &bake, kHalf, kSide, &maps[0], scratch, size));

    for (int level = 0; level + 1 < kLevels; ++level) {
        check(tex_mip_level(&maps[level], level, &mip, 0, maps[level + 1].height, &maps[level + 1], scratch, size));
        if (level > 0) check(tex_mip_finish(&maps[level], level, &mip, 0, maps[level].height));
    }
    check(tex_mip_finish(&maps[kLevels - 1], kLevels - 1, &mip, 0, 1));
    free(scratch);

    const tex_encode_options encode = TEX_ENCODE_OPTIONS;  // BC5, y up
    uint64_t sum = 14695981039346656037u;
    size_t bytes = 0;
    for (int level = 0; level < kLevels; ++level) {
        static unsigned char blocks[kSide * kSide];
        const int side = maps[level].width;
        check(tex_encode(&maps[level], &encode, 0, side, blocks, tex_row_bytes(TEX_FORMAT_BC5_UNORM, side), NULL, 0));
        sum = sum_of(sum, blocks, tex_level_bytes(TEX_FORMAT_BC5_UNORM, side, side));
        bytes += tex_level_bytes(TEX_FORMAT_BC5_UNORM, side, side);
    }
    printf("%zu bytes of BC5, sum %016llx\n", bytes, (unsigned long long)sum);
    return 0;
}
