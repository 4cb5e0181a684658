// SPDX-License-Identifier: Apache-2.0
// engine.c: what an engine does with libtex, in C11: bakes heights in memory to BC5 with all levels, on its own threads
// and in its own memory; decodes a DDS file that is in memory; checks the map. engine.cpp and engine.rs do the same and
// print the same. Fails if the library allocates where tex_c.h says that it does not.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tex/tex_c.h>
#include <threads.h>

long allocations_here(void);  // allocations.c

enum { kWidth = 160, kHeight = 96, kLevels = 8, kThreads = 3, kHeader = 148, kDxgiBc5Unorm = 83 };

static void require(int32_t error, const char* what) {
    if (error == TEX_OK) return;
    fprintf(stderr, "%s: %s\n", what, tex_error_text(error));
    exit(1);
}

static uint64_t hash(const void* data, size_t size) {  // FNV-1a
    const unsigned char* bytes = data;
    uint64_t sum = 14695981039346656037u;
    for (size_t k = 0; k < size; ++k) sum = (sum ^ bytes[k]) * 1099511628211u;
    return sum;
}

static int32_t halved(int32_t side, int level) { return side >> level > 1 ? side >> level : 1; }

// One step of the bake, on rows [first, end) of its output.
typedef struct step {
    int32_t (*rows)(const struct step* step, int32_t first, int32_t end, void* scratch);
    size_t scratch_size;
    int32_t level;
    const tex_plane* heights;
    const tex_map *from, *to;
    unsigned char* blocks;
} step;

static const tex_bake_options bake_options = {
    sizeof(tex_bake_options), TEX_KERNEL_SOBEL, 1.0f, 6.0f, 6.0f, TEX_REPEAT, TEX_REPEAT};
static const tex_mip_options mip_options = TEX_MIP_OPTIONS;
static const tex_encode_options encode_options = TEX_ENCODE_OPTIONS;

static int32_t bake_rows(const step* s, int32_t first, int32_t end, void* scratch) {
    return tex_bake(s->heights, &bake_options, first, end, s->to, scratch, s->scratch_size);
}

static int32_t average_rows(const step* s, int32_t first, int32_t end, void* scratch) {
    return tex_mip_level(s->from, s->level, &mip_options, first, end, s->to, scratch, s->scratch_size);
}

static int32_t finish_rows(const step* s, int32_t first, int32_t end, void* scratch) {
    (void)scratch;
    return tex_mip_finish(s->to, s->level, &mip_options, first, end);
}

static int32_t encode_rows(const step* s, int32_t first, int32_t end, void* scratch) {
    const size_t pitch = tex_row_bytes(TEX_FORMAT_BC5_UNORM, s->from->width);
    return tex_encode(s->from, &encode_options, first, end, s->blocks, pitch, scratch, s->scratch_size);
}

typedef struct band {
    const step* step;
    int32_t first, end;
    void* scratch;
    int32_t error;
    long allocations;
} band;

static int run_band(void* argument) {
    band* const b = argument;
    const long before = allocations_here();
    b->error = b->step->rows(b->step, b->first, b->end, b->scratch);
    b->allocations = allocations_here() - before;
    return 0;
}

static void run(const step* s, int32_t rows, const char* what) {
    band bands[kThreads];
    thrd_t threads[kThreads];
    int count = 0;
    const int32_t share = (rows + 4 * kThreads - 1) / (4 * kThreads) * 4;
    for (int32_t first = 0; first < rows; first += share, ++count) {
        const int32_t end = first + share < rows ? first + share : rows;
        bands[count] = (band){s, first, end, malloc(s->scratch_size), TEX_OK, 0};
        if (bands[count].scratch == NULL && s->scratch_size > 0) exit(1);
        if (thrd_create(&threads[count], run_band, &bands[count]) != thrd_success) exit(1);
    }
    for (int k = 0; k < count; ++k) {
        thrd_join(threads[k], NULL);
        free(bands[k].scratch);
        require(bands[k].error, what);
        if (bands[k].allocations != 0) {
            fprintf(stderr, "%s: %ld allocations\n", what, bands[k].allocations);
            exit(1);
        }
    }
}

static void put32(unsigned char* at, uint32_t value) {
    for (int k = 0; k < 4; ++k) at[k] = (unsigned char)(value >> 8 * k);
}

static uint32_t get32(const unsigned char* at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void write_header(unsigned char* file) {
    memset(file, 0, kHeader);
    memcpy(file, "DDS ", 4);
    put32(file + 4, 124);
    put32(file + 12, kHeight);
    put32(file + 16, kWidth);
    put32(file + 28, kLevels);
    put32(file + 76, 32);
    put32(file + 80, 4);  // DDPF_FOURCC
    memcpy(file + 84, "DX10", 4);
    put32(file + 128, kDxgiBc5Unorm);
    put32(file + 132, 3);  // a texture of two dimensions
    put32(file + 140, 1);
}

// The levels of the file.
static void bake(const float* heights, unsigned char* file, size_t file_size) {
    static float memory[3][2 * kWidth * kHeight];
    tex_map maps[kLevels];
    size_t used = 0;
    for (int k = 0; k < kLevels; ++k) {
        const int32_t width = halved(kWidth, k), height = halved(kHeight, k);
        maps[k] = (tex_map){memory[0] + used, memory[1] + used, memory[2] + used, width, width, height};
        used += (size_t)width * (size_t)height;
    }
    float* const in = (float*)heights;  // tex_plane serves outputs, too
    const tex_plane plane = {in, kWidth, kWidth, kHeight};
    run(&(step){bake_rows, tex_bake_size(kWidth, kHeight, &bake_options), 0, &plane, NULL, &maps[0], NULL}, kHeight,
        "tex_bake");
    for (int32_t k = 0; k < kLevels; ++k) {
        const tex_map* const map = &maps[k];
        if (k + 1 < kLevels) {
            const size_t size = tex_mip_size(map->width, map->height, &mip_options);
            run(&(step){average_rows, size, k, NULL, map, map + 1, NULL}, map[1].height, "tex_mip_level");
        }
        if (k > 0) run(&(step){finish_rows, 0, k, NULL, NULL, map, NULL}, map->height, "tex_mip_finish");
    }
    write_header(file);
    unsigned char* blocks = file + kHeader;
    for (int32_t k = 0; k < kLevels; ++k) {
        const size_t size = tex_encode_size(maps[k].width, &encode_options);
        run(&(step){encode_rows, size, k, NULL, &maps[k], NULL, blocks}, maps[k].height, "tex_encode");
        blocks += tex_level_bytes(TEX_FORMAT_BC5_UNORM, maps[k].width, maps[k].height);
    }
    if (blocks != file + file_size) exit(1);
}

// The levels of a file of BC5, as red and green of all texels.
static size_t decode(const unsigned char* file, tex_texels levels[kLevels], float* red, float* green) {
    if (memcmp(file + 84, "DX10", 4) != 0 || get32(file + 128) != kDxgiBc5Unorm || get32(file + 28) != kLevels) exit(1);
    const int32_t width = (int32_t)get32(file + 16), height = (int32_t)get32(file + 12);
    const long before = allocations_here();
    const unsigned char* bytes = file + kHeader;
    size_t texels = 0;
    for (int k = 0; k < kLevels; ++k) {
        const int32_t w = halved(width, k), h = halved(height, k);
        levels[k] = (tex_texels){bytes, tex_row_bytes(TEX_FORMAT_BC5_UNORM, w), TEX_FORMAT_BC5_UNORM, w, h};
        const tex_channels out = {{red + texels, green + texels, NULL, NULL}, w};
        require(tex_decode(&levels[k], 0, h, &out), "tex_decode");
        texels += (size_t)w * (size_t)h;
        bytes += tex_level_bytes(TEX_FORMAT_BC5_UNORM, w, h);
    }
    if (allocations_here() != before) exit(1);
    return texels;
}

static void check(const tex_texels* levels, int32_t y_axis) {
    static const char* const severities[] = {"note", "warning", "error"};
    tex_check_options options = TEX_CHECK_OPTIONS;
    options.swizzle[0] = TEX_X;
    options.swizzle[1] = TEX_Y;
    options.swizzle[3] = TEX_ONE;
    options.y_axis = y_axis;
    options.tiles = 1;
    tex_finding findings[16];
    findings[0].size = sizeof(tex_finding);
    size_t count = 0;
    const long before = allocations_here();
    require(tex_check(levels, kLevels, &options, findings, 16, &count), "tex_check");
    if (allocations_here() == before) exit(1);  // it says that it allocates: nothing is counted
    printf("%zu findings\n", count);
    for (size_t k = 0; k < count && k < 16; ++k) {
        printf("%s %s, level %d: %s\n", findings[k].id, severities[findings[k].severity], (int)findings[k].level,
               findings[k].message);
    }
}

int main(void) {
    static float heights[kWidth * kHeight];
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
            const float u = (float)(i % 32) / 32.0f, v = (float)(j % 32) / 32.0f;
            heights[j * kWidth + i] = 16.0f * u * (1.0f - u) * v * (1.0f - v);
        }
    }
    size_t file_size = kHeader;
    for (int k = 0; k < kLevels; ++k)
        file_size += tex_level_bytes(TEX_FORMAT_BC5_UNORM, halved(kWidth, k), halved(kHeight, k));
    unsigned char* const file = malloc(file_size);
    if (file == NULL) return 1;
    bake(heights, file, file_size);
    printf("baked %016llx\n", (unsigned long long)hash(file + kHeader, file_size - kHeader));

    static float red[2 * kWidth * kHeight], green[2 * kWidth * kHeight];
    tex_texels levels[kLevels];
    const size_t texels = decode(file, levels, red, green);
    printf("decoded %016llx %016llx\n", (unsigned long long)hash(red, texels * sizeof(float)),
           (unsigned long long)hash(green, texels * sizeof(float)));
    check(levels, -1);
    check(levels, TEX_Y_DOWN);
    free(file);
    return 0;
}
