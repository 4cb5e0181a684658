// SPDX-License-Identifier: Apache-2.0
// valley_occlusion.c: the ambient occlusion of heights in memory, through tex_c.h: the caller's memory, one thread.
//
//     cc -std=c11 valley_occlusion.c $(pkg-config --cflags --libs libtex) -o valley_occlusion

#include <stdio.h>
#include <stdlib.h>
#include <tex/tex_c.h>

enum { kSide = 129, kMiddle = kSide / 2 };

int main(void) {
    // A valley with slopes of 45 degrees: about 0.7 of the light reaches its bottom.
    static float height[kSide * kSide], occlusion[kSide * kSide];
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) height[j * kSide + i] = (float)abs(i - kMiddle);
    }
    tex_occlusion_options options = TEX_OCCLUSION_OPTIONS;
    options.wrap_x = options.wrap_y = TEX_CLAMP;
    const size_t size = tex_occlusion_size(kSide, kSide, &options);
    void* const scratch = malloc(size);
    if (scratch == NULL) return 1;
    const tex_plane heights = {height, kSide, kSide, kSide}, out = {occlusion, kSide, kSide, kSide};
    const tex_occlusion_maps maps = {sizeof maps, &out, NULL, NULL, NULL};
    const int32_t error = tex_occlusion(&heights, &options, &maps, scratch, size);
    free(scratch);
    if (error != TEX_OK) {
        fprintf(stderr, "valley_occlusion: %s\n", tex_error_text(error));
        return 1;
    }
    printf("occlusion at the bottom: %.2f\n", (double)occlusion[kMiddle * kSide + kMiddle]);
    return 0;
}
