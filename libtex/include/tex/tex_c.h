// SPDX-License-Identifier: Apache-2.0
//
// tex_c.h: libtex for C11, and for every language that calls C: the caller's memory, the caller's threads, a stable
// ABI.
//
// Read this first
// ---------------
//
// Memory. A function reads and writes the memory that it is given, and no other: nothing beyond the last texel of a
// row, no padding between rows. What it needs besides, it takes from `scratch`, of which tex_..._size() says how many
// bytes; scratch may start anywhere, and holds nothing between calls. Three functions allocate instead, from the heap
// of C++ (operator new):
//
//     tex_tangents()        because the size of its tables depends on which vertices are equal
//     tex_check()           because the evidence that some 60 rules keep depends on the map
//     tex_encode_prepare()  because the tables of ASTC stay for later calls
//
// A test counts the allocations of all others: there are none.
//
// Threads. No function starts a thread. None takes a lock, except tex_encode_prepare(). Any number of threads may call
// any function at the same time, as long as none writes what another reads or writes. Functions with `first` and `end`
// make rows [first, end): call them from several threads with different rows, each with its own scratch, and the bytes
// are those of one call.
//
// Bytes are those of the C++ functions of the same name, on every processor.
//
// Conventions, as in tex.h: x points right, y up, z out of the surface; components are in [-1, 1] and vectors have unit
// length; rows are stored from the top; strides are in floats, pitches in bytes. Extents are from 1 to 1048576 texels.
//
// Errors. Functions return an int32_t: TEX_OK or one of tex_error. Nothing is written if arguments or options are
// wrong. After TEX_BAD_DATA, the contents of the outputs are unspecified. tex_error_text() says what a code means.
//
// The ABI, which is kept until libtex 2:
//
//   - Functions never change their parameters; a new one gets a new name. Constants never change their numbers; new
//     ones are added at the end.
//   - tex_plane, tex_map, tex_channels and tex_texels never change.
//   - Every other structure begins with `size`, which the caller sets to the size that it was compiled with. Members
//     are only added at the end, and 0 in them means what was done before they existed. A library that is older than
//     the caller accepts a larger structure if what it does not know is 0, and returns TEX_BAD_OPTION otherwise. (The
//     rule of the newer system calls of Linux: openat2(2), "Extensibility".) No structure has more than 4096 bytes.
//   - The symbols have the version TEX_1.0, those of a later version another one.
//
// TEX_..._OPTIONS initialise structures of options:    tex_bake_options options = TEX_BAKE_OPTIONS;
//
// What is not here: files, and what needs a whole chain or a file (RDO, sampling maps of another extent, previews):
// these are in the C++ headers.

#ifndef TEX_C_H
#define TEX_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define TEX_C_API __attribute__((visibility("default")))
#else
#define TEX_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ---- errors and the version -------------------------------------------------------------------------------------

enum tex_error {
    TEX_OK = 0,
    TEX_BAD_ARGUMENT = 1,       // a pointer is null, an extent or a stride too small, rows are outside, a size is wrong
    TEX_BAD_OPTION = 2,         // an option is outside its range, or options contradict each other
    TEX_BAD_DATA = 3,           // the values cannot be used: a height is not finite, an index is out of range
    TEX_UNSUPPORTED = 4,        // there is no such thing in this version, or not for these data
    TEX_SCRATCH_TOO_SMALL = 5,  // less than tex_..._size() bytes
    TEX_OUT_OF_MEMORY = 6,      // only from the functions that allocate
    TEX_NOT_PREPARED = 7        // ASTC without tex_encode_prepare()
};

// What a code means, as a clause without a full stop; never null.
TEX_C_API const char* tex_error_text(int32_t error);

// The version of the library that is running: "1.0.0".
TEX_C_API const char* tex_version(void);

// ---- values ------------------------------------------------------------------------------------------------------

// One float for each texel: that of column i and row j is data[j * stride + i]. stride is at least width. Functions
// only read the planes and maps that they take as pointers to const and do not name as output.
typedef struct tex_plane {
    float* data;
    ptrdiff_t stride;
    int32_t width, height;
} tex_plane;

// Normals, one plane for each component.
typedef struct tex_map {
    float *x, *y, *z;
    ptrdiff_t stride;  // of all three
    int32_t width, height;
} tex_map;

// The channels R, G, B, A; a null pointer: not wanted.
typedef struct tex_channels {
    float* channel[4];
    ptrdiff_t stride;  // of all four
} tex_channels;

// Stored texels: rows of texels, or of blocks from the top, `pitch` bytes apart (at least tex_row_bytes()).
typedef struct tex_texels {
    const void* bytes;
    size_t pitch;
    int32_t format;  // tex_format
    int32_t width, height;
} tex_texels;

enum tex_wrap { TEX_REPEAT = 0, TEX_CLAMP = 1, TEX_MIRROR = 2 };
enum tex_y_axis { TEX_Y_UP = 0, TEX_Y_DOWN = 1 };

// What a stored channel holds. TEX_OTHER is not read.
enum tex_component { TEX_ZERO = 0, TEX_ONE = 1, TEX_X = 2, TEX_Y = 3, TEX_Z = 4, TEX_OTHER = 5 };

// How texels are stored: see Format in format.h.
enum tex_format {
    TEX_FORMAT_BC1_UNORM = 0,
    TEX_FORMAT_BC2_UNORM = 1,
    TEX_FORMAT_BC3_UNORM = 2,
    TEX_FORMAT_BC4_UNORM = 3,
    TEX_FORMAT_BC4_SNORM = 4,
    TEX_FORMAT_BC5_UNORM = 5,
    TEX_FORMAT_BC5_SNORM = 6,
    TEX_FORMAT_BC6H_UFLOAT = 7,
    TEX_FORMAT_BC6H_SFLOAT = 8,
    TEX_FORMAT_BC7_UNORM = 9,
    TEX_FORMAT_EAC_R11_UNORM = 10,
    TEX_FORMAT_EAC_R11_SNORM = 11,
    TEX_FORMAT_EAC_RG11_UNORM = 12,
    TEX_FORMAT_EAC_RG11_SNORM = 13,
    TEX_FORMAT_ASTC_4X4_UNORM = 14,
    TEX_FORMAT_ASTC_5X4_UNORM = 15,
    TEX_FORMAT_ASTC_5X5_UNORM = 16,
    TEX_FORMAT_ASTC_6X5_UNORM = 17,
    TEX_FORMAT_ASTC_6X6_UNORM = 18,
    TEX_FORMAT_ASTC_8X5_UNORM = 19,
    TEX_FORMAT_ASTC_8X6_UNORM = 20,
    TEX_FORMAT_ASTC_8X8_UNORM = 21,
    TEX_FORMAT_ASTC_10X5_UNORM = 22,
    TEX_FORMAT_ASTC_10X6_UNORM = 23,
    TEX_FORMAT_ASTC_10X8_UNORM = 24,
    TEX_FORMAT_ASTC_10X10_UNORM = 25,
    TEX_FORMAT_ASTC_12X10_UNORM = 26,
    TEX_FORMAT_ASTC_12X12_UNORM = 27,
    TEX_FORMAT_R8_UNORM = 28,
    TEX_FORMAT_RG8_UNORM = 29,
    TEX_FORMAT_RGB8_UNORM = 30,
    TEX_FORMAT_RGBA8_UNORM = 31,
    TEX_FORMAT_R8_SNORM = 32,
    TEX_FORMAT_RG8_SNORM = 33,
    TEX_FORMAT_RGBA8_SNORM = 34,
    TEX_FORMAT_R16_UNORM = 35,
    TEX_FORMAT_RG16_UNORM = 36,
    TEX_FORMAT_RGB16_UNORM = 37,
    TEX_FORMAT_RGBA16_UNORM = 38,
    TEX_FORMAT_R16_SNORM = 39,
    TEX_FORMAT_RG16_SNORM = 40,
    TEX_FORMAT_RGBA16_SNORM = 41,
    TEX_FORMAT_R16_FLOAT = 42,
    TEX_FORMAT_RG16_FLOAT = 43,
    TEX_FORMAT_RGB16_FLOAT = 44,
    TEX_FORMAT_RGBA16_FLOAT = 45,
    TEX_FORMAT_R32_FLOAT = 46,
    TEX_FORMAT_RG32_FLOAT = 47,
    TEX_FORMAT_RGB32_FLOAT = 48,
    TEX_FORMAT_RGBA32_FLOAT = 49,
    TEX_FORMAT_UASTC_4X4_UNORM = 50,
    TEX_FORMAT_ETC1S_RGB_UNORM = 51,
    TEX_FORMAT_ETC1S_RGBA_UNORM = 52
};

// How normals are stored: a format and what its channels hold. See Encoding in format.h.
enum tex_encoding {
    TEX_ENCODING_DXT5NM = 0,
    TEX_ENCODING_BC5 = 1,
    TEX_ENCODING_BC5_SNORM = 2,
    TEX_ENCODING_EAC_RG11 = 3,
    TEX_ENCODING_EAC_RG11_SNORM = 4,
    TEX_ENCODING_ASTC_4X4 = 5,
    TEX_ENCODING_ASTC_5X4 = 6,
    TEX_ENCODING_ASTC_5X5 = 7,
    TEX_ENCODING_ASTC_6X5 = 8,
    TEX_ENCODING_ASTC_6X6 = 9,
    TEX_ENCODING_ASTC_8X5 = 10,
    TEX_ENCODING_ASTC_8X6 = 11,
    TEX_ENCODING_ASTC_8X8 = 12,
    TEX_ENCODING_RGB8 = 13,
    TEX_ENCODING_RGBA8 = 14,
    TEX_ENCODING_RGB16 = 15,
    TEX_ENCODING_AG8 = 16,
    TEX_ENCODING_RG8 = 17,
    TEX_ENCODING_RG16 = 18,
    TEX_ENCODING_HALF = 19,
    TEX_ENCODING_FLOAT = 20,
    TEX_ENCODING_RGBA16 = 21,
    TEX_ENCODING_RGBA16F = 22,
    TEX_ENCODING_RGBA32F = 23,
    TEX_ENCODING_BC7 = 24,
    TEX_ENCODING_UASTC = 25,
    TEX_ENCODING_UASTC_RRRG = 26,
    TEX_ENCODING_BC7_RXGB = 27
};

enum tex_sample { TEX_UNORM = 0, TEX_SNORM = 1, TEX_FLOAT = 2 };

typedef struct tex_format_info {
    uint32_t size;
    int32_t sample;                     // tex_sample
    int32_t channels;                   // 1 to 4: the first of R, G, B, A
    int32_t bits;                       // of a decoded sample: 8, 11, 16 or 32
    int32_t block_width, block_height;  // texels; 1 and 1 without blocks
    int32_t block_bytes;                // bytes of a block, or of a texel
} tex_format_info;

// Fills info, of which the caller sets `size`. Fails with TEX_BAD_OPTION: there is no such format.
TEX_C_API int32_t tex_get_format(int32_t format, tex_format_info* info);

// The format of an encoding; -1 if there is no such encoding.
TEX_C_API int32_t tex_encoding_format(int32_t encoding);

// The bytes of a row of texels or blocks, and of a level without gaps between rows. 0 if there is no such format, or if
// an extent is not from 1 to 1048576.
TEX_C_API size_t tex_row_bytes(int32_t format, int32_t width);
TEX_C_API size_t tex_level_bytes(int32_t format, int32_t width, int32_t height);

// ---- bake: heights to normals (bake.h) ----------------------------------------------------------------------------

enum tex_kernel {
    TEX_KERNEL_FORWARD = 0,
    TEX_KERNEL_CENTRAL = 1,
    TEX_KERNEL_SOBEL = 2,
    TEX_KERNEL_SCHARR = 3,
    TEX_KERNEL_PREWITT = 4,
    TEX_KERNEL_SOBEL5 = 5,
    TEX_KERNEL_GAUSSIAN = 6
};

typedef struct tex_bake_options {
    uint32_t size;
    int32_t kernel;                  // tex_kernel
    float gaussian_sigma;            // texels, above 0 and at most 64; only TEX_KERNEL_GAUSSIAN reads it
    float bumpiness_x, bumpiness_y;  // the height of value 1 in texel widths; finite
    int32_t wrap_x, wrap_y;          // tex_wrap: what lies beyond the border
} tex_bake_options;
#define TEX_BAKE_OPTIONS \
    { sizeof(tex_bake_options), TEX_KERNEL_CENTRAL, 1.0f, 1.0f, 1.0f, TEX_REPEAT, TEX_REPEAT }

// The bytes of scratch that tex_bake() needs: a few rows. 0 if arguments or options are wrong.
TEX_C_API size_t tex_bake_size(int32_t width, int32_t height, const tex_bake_options* options);

// The normals of rows [first, end) of a field of heights, into these rows of `out`, which has its extent:
//
//     normalize(-bumpiness_x dh/dx, -bumpiness_y dh/dy, 1)        x to the right, y upwards
//
// Fails with TEX_BAD_DATA: a height in these rows, or in those that the kernel reads around them, is not finite.
TEX_C_API int32_t tex_bake(const tex_plane* heights, const tex_bake_options* options, int32_t first, int32_t end,
                           const tex_map* out, void* scratch, size_t scratch_size);

// ---- mip: the next smaller level (mip.h) --------------------------------------------------------------------------

enum tex_filter {
    TEX_FILTER_BOX = 0,
    TEX_FILTER_TRIANGLE = 1,
    TEX_FILTER_KAISER = 2,
    TEX_FILTER_MITCHELL = 3,
    TEX_FILTER_CATMULL_ROM = 4,
    TEX_FILTER_LANCZOS3 = 5
};
enum tex_domain { TEX_DOMAIN_VECTOR = 0, TEX_DOMAIN_SLOPE = 1 };

typedef struct tex_mip_options {
    uint32_t size;
    int32_t filter;                 // tex_filter
    int32_t domain;                 // tex_domain: what is averaged, vectors or slopes
    int32_t wrap_x, wrap_y;         // tex_wrap
    int32_t fade_first, fade_last;  // levels: flat from fade_last on, 0 <= fade_first < fade_last; 0 and 0: no fade
    int32_t any_z;                  // 1: z may be negative, as in object space; needs TEX_DOMAIN_VECTOR and no fade
} tex_mip_options;
#define TEX_MIP_OPTIONS \
    { sizeof(tex_mip_options), TEX_FILTER_BOX, TEX_DOMAIN_VECTOR, TEX_REPEAT, TEX_REPEAT, 0, 0, 0 }

// The bytes of scratch that tex_mip_level() needs for a larger level of this extent; 0 if arguments or options are
// wrong.
TEX_C_API size_t tex_mip_size(int32_t width, int32_t height, const tex_mip_options* options);

// Averages of rows [first, end) of the level below `from`, into these rows of `to`, whose extent is max(1, width / 2)
// by max(1, height / 2). `level` is the number of the level in `from`. Level 0 holds normals; higher levels hold the
// averages written by this function. Make level k + 1 from those averages before tex_mip_finish() turns level k into
// normals. A chain is
//
//     for (level = 0; level + 1 < count; ++level) {
//         tex_mip_level(&maps[level], level, &options, 0, maps[level + 1].height, &maps[level + 1], scratch, size);
//         if (level > 0) tex_mip_finish(&maps[level], level, &options, 0, maps[level].height);
//     }
//     if (level > 0) tex_mip_finish(&maps[level], level, &options, 0, maps[level].height);
//
// Each call computes the weights of its filter: calls for at least 32 rows do not notice.
TEX_C_API int32_t tex_mip_level(const tex_map* from, int32_t level, const tex_mip_options* options, int32_t first,
                                int32_t end, const tex_map* to, void* scratch, size_t scratch_size);

// Makes averages of level `level` >= 1 normals, in place: see build_mip_chain(). Allocates nothing, needs no scratch.
TEX_C_API int32_t tex_mip_finish(const tex_map* map, int32_t level, const tex_mip_options* options, int32_t first,
                                 int32_t end);

// ---- encode and decode (pack.h) ---------------------------------------------------------------------------------

enum tex_effort { TEX_EFFORT_FAST = 0, TEX_EFFORT_NORMAL = 1, TEX_EFFORT_BEST = 2 };
enum tex_metric { TEX_METRIC_COMPONENT = 0, TEX_METRIC_ANGLE = 1 };

typedef struct tex_encode_options {
    uint32_t size;
    int32_t encoding;  // tex_encoding
    int32_t effort;    // tex_effort: how hard block encoders search
    int32_t metric;    // tex_metric: the error that TEX_EFFORT_BEST minimises, except in EAC, ASTC, BC7, UASTC
    int32_t y_axis;    // tex_y_axis of what is stored
} tex_encode_options;
#define TEX_ENCODE_OPTIONS \
    { sizeof(tex_encode_options), TEX_ENCODING_BC5, TEX_EFFORT_NORMAL, TEX_METRIC_COMPONENT, TEX_Y_UP }

// Makes the tables that ASTC needs for this encoding and effort, once; does nothing for other encodings. Allocates.
// Fails with TEX_OUT_OF_MEMORY.
TEX_C_API int32_t tex_encode_prepare(const tex_encode_options* options);

// The bytes of scratch that tex_encode() needs: 0 for all encodings but ASTC's, BC7 and UASTC; 0 too if arguments or
// options are wrong.
TEX_C_API size_t tex_encode_size(int32_t width, const tex_encode_options* options);

// Rows [first, end) of normals, as rows of texels or blocks. `first` is a multiple of the height of a block, and `end`
// too, unless it is the height. `bytes` is where the level begins, whatever rows are asked for: row 0 of texels or of
// blocks goes there, the others follow at `pitch` bytes.
// Encodings without z do not read it: map->z may be null. Components are finite; they are clamped to [-1, 1].
//
// Fails with TEX_NOT_PREPARED: see tex_encode_prepare().
TEX_C_API int32_t tex_encode(const tex_map* map, const tex_encode_options* options, int32_t first, int32_t end,
                             void* bytes, size_t pitch, void* scratch, size_t scratch_size);

// Texels of rows [first, end), of any format, to floats: [0, 1] for unorm, [-1, 1] for snorm, unchanged for floats. Row
// j goes to row j of each channel. `first` is a multiple of the height of a block, and `end` too, unless it is the
// height. Any bytes decode. Fails with TEX_BAD_ARGUMENT: also if a channel is wanted that the format lacks.
TEX_C_API int32_t tex_decode(const tex_texels* texels, int32_t first, int32_t end, const tex_channels* out);

enum tex_range { TEX_RANGE_SIGNED = 0, TEX_RANGE_UNSIGNED = 1 };

typedef struct tex_unpack_options {
    uint32_t size;
    // tex_component of R, G, B, A. All 0: x, y and z in R, G and B, or x and y in formats of two channels.
    uint8_t swizzle[4];
    int32_t y_axis;        // tex_y_axis of the texels
    int32_t range;         // tex_range of floats: the components themselves, or (n + 1) / 2. Integers do not read it.
    int32_t snap_flat;     // 1: 8-bit unorm values from 127/255 to 128/255 are 0
    int32_t keep_length;   // 1: vectors are not normalised
    int32_t keep_invalid;  // 1: vectors that are not finite become NaN, not (0, 0, 1)
} tex_unpack_options;
#define TEX_UNPACK_OPTIONS \
    { sizeof(tex_unpack_options), {0, 0, 0, 0}, TEX_Y_UP, TEX_RANGE_SIGNED, 0, 0, 0 }

// The normals of rows [first, end) of texels, as unpack(); rows as in tex_decode(). z is reconstructed if the swizzle
// has none. Fails with TEX_BAD_OPTION: the swizzle has no x or no y, or one that the format lacks.
TEX_C_API int32_t tex_unpack(const tex_texels* texels, const tex_unpack_options* options, int32_t first, int32_t end,
                             const tex_map* out);

// ---- normals to normals: scale, blend, angles (blend.h, check.h) --------------------------------------------------

enum tex_scale_mode { TEX_SCALE_SLOPE = 0, TEX_SCALE_XY = 1 };

// Rows [first, end) with their slopes, or x and y, multiplied by `scale` (finite, at most 1e6 in magnitude). `out` has
// the same extent, and may be `map`.
TEX_C_API int32_t tex_scale(const tex_map* map, float scale, int32_t mode, int32_t first, int32_t end,
                            const tex_map* out);

enum tex_blend_mode {
    TEX_BLEND_WHITEOUT = 0,
    TEX_BLEND_LINEAR = 1,
    TEX_BLEND_PARTIAL_DERIVATIVE = 2,
    TEX_BLEND_UDN = 3,
    TEX_BLEND_RNM = 4,
    TEX_BLEND_OVERLAY = 5
};

// Rows [first, end) of a detail map over a base of the same extent; both have unit length (tex_scale() with 1 sees to
// it). weight: null, or from 0 to 1 for each texel, how much of the detail shows; of the same extent. `out` may be
// `base` or `detail`. Further layers are further calls.
TEX_C_API int32_t tex_blend(const tex_map* base, const tex_map* detail, const tex_plane* weight, int32_t mode,
                            int32_t first, int32_t end, const tex_map* out);

// The angles in degrees, 0 to 180, between rows [first, end) of two maps of the same extent.
TEX_C_API int32_t tex_angles(const tex_map* a, const tex_map* b, int32_t first, int32_t end, const tex_plane* degrees);

// ---- heights: deband, integrate, occlusion (height.h, surface.h) ------------------------------------------------

// Each texel depends on all others, so these three take whole planes, run on one thread, and need scratch that is
// larger than the plane: about 16 bytes for each texel to deband, 30 to integrate, 20 to 50 for occlusion.

typedef struct tex_deband_report {
    uint32_t size;
    int32_t applied;         // 1: heights were changed
    float step;              // the height of a step; 0: heights lie on no steps
    int32_t codes;           // the number of steps from the lowest height to the highest, both counted; or 0
    int64_t terrace_texels;  // texels on terraces
} tex_deband_report;

TEX_C_API size_t tex_deband_size(int32_t width, int32_t height);

// Replaces heights that were rounded to steps by smooth ones, in place. when: 1 always if heights lie on steps, 2 only
// if a tenth of the texels are on terraces. NaN stays NaN. report may be null; the caller sets its `size`.
TEX_C_API int32_t tex_deband(const tex_plane* heights, int32_t wrap_x, int32_t wrap_y, int32_t when,
                             tex_deband_report* report, void* scratch, size_t scratch_size);

typedef struct tex_integrate_options {
    uint32_t size;
    int32_t kernel;                  // tex_kernel: how the map's slopes were measured
    float gaussian_sigma;            // as in tex_bake_options
    float bumpiness_x, bumpiness_y;  // the height of value 1 in texel widths; 1e-20 to 1e20 in magnitude
    int32_t wrap_x, wrap_y;          // tex_wrap
    float least_z;                   // slopes of texels with a smaller z are unknown; above 0, at most 1
    float least_response;            // 1e-6 to 1; 0: that of the kernel
    int32_t most_steps;              // solutions, at least 1
} tex_integrate_options;
#define TEX_INTEGRATE_OPTIONS \
    { sizeof(tex_integrate_options), TEX_KERNEL_CENTRAL, 1.0f, 1.0f, 1.0f, TEX_REPEAT, TEX_REPEAT, 1e-6f, 0.0f, 40 }

typedef struct tex_integrate_report {
    uint32_t size;
    float highest;          // the highest height; the lowest is 0
    int32_t steps;          // the number of times that the equation was solved
    int64_t unused_texels;  // without a usable slope
} tex_integrate_report;

TEX_C_API size_t tex_integrate_size(int32_t width, int32_t height, const tex_integrate_options* options);

// The heights whose normals are nearest to those of the map: the inverse of tex_bake(). `heights` has the extent of the
// map. report may be null; the caller sets its `size`.
//
// Fails with TEX_BAD_DATA: z is below 0 in more than one of sixteen texels, no texel has a usable slope, or slopes are
// so steep that heights do not fit floats.
TEX_C_API int32_t tex_integrate(const tex_map* map, const tex_integrate_options* options, const tex_plane* heights,
                                tex_integrate_report* report, void* scratch, size_t scratch_size);

// What tex_occlusion() makes; the numbers are added up.
enum tex_occlusion_map { TEX_OCCLUSION = 1, TEX_SKY_VIEW = 2, TEX_BENT = 4 };

typedef struct tex_occlusion_options {
    uint32_t size;
    int32_t kernel;  // tex_kernel: this and the next five as in tex_bake_options
    float gaussian_sigma;
    float bumpiness_x, bumpiness_y;  // both above 0, both below, or both 0
    int32_t wrap_x, wrap_y;
    int32_t maps;        // of tex_occlusion_map
    int32_t directions;  // in which the horizon is measured, from 4 to 1024
    float distance;      // texels; 0: everything counts, however far away
    int32_t horizons;    // the number of planes of horizons, from 4 to 64; or 0
} tex_occlusion_options;
#define TEX_OCCLUSION_OPTIONS                                                                                       \
    {                                                                                                               \
        sizeof(tex_occlusion_options), TEX_KERNEL_CENTRAL, 1.0f, 1.0f, 1.0f, TEX_REPEAT, TEX_REPEAT, TEX_OCCLUSION, \
            32, 0.0f, 0                                                                                             \
    }

typedef struct tex_occlusion_maps {
    uint32_t size;
    const tex_plane* occlusion;  // pointers to what is not made are not read
    const tex_plane* sky_view;
    const tex_map* bent;
    const tex_plane* horizons;  // an array of options->horizons
} tex_occlusion_maps;

TEX_C_API size_t tex_occlusion_size(int32_t width, int32_t height, const tex_occlusion_options* options);

// What the surface of heights hides from its texels: see occlusion() in surface.h. Planes and maps have the extent of
// the heights.
//
// Fails with TEX_BAD_DATA: a height is not finite.
TEX_C_API int32_t tex_occlusion(const tex_plane* heights, const tex_occlusion_options* options,
                                const tex_occlusion_maps* out, void* scratch, size_t scratch_size);

// ---- tangents (mesh.h) --------------------------------------------------------------------------------------------

enum tex_tangent_method { TEX_MIKKTSPACE = 0, TEX_MESHOPT = 1 };

typedef struct tex_mesh {
    uint32_t size;
    int32_t v_axis;                                    // tex_y_axis: which way v points; down in glTF
    const float* positions;                            // three floats for each vertex
    const float* normals;                              // three
    const float* uvs;                                  // two
    size_t position_stride, normal_stride, uv_stride;  // bytes from one vertex to the next; 0: without gaps
    size_t vertices;
    const uint32_t* indices;  // three for each triangle, counter-clockwise from outside
    size_t index_count;       // a multiple of 3
} tex_mesh;

// The tangents of all corners, four floats for each index: x, y, z of unit length, and w, 1 or -1, as in mesh.h.
// Allocates with the heap: see above.
//
// Fails with TEX_BAD_DATA: an index is out of range, a number is not finite, there are no triangles or too many.
// TEX_UNSUPPORTED: more than 4096 triangles meet at one vertex. TEX_OUT_OF_MEMORY.
TEX_C_API int32_t tex_tangents(const tex_mesh* mesh, int32_t method, float* tangents);

// ---- check one map (check.h) --------------------------------------------------------------------------------------

enum tex_severity { TEX_NOTE = 0, TEX_WARNING = 1, TEX_ERROR = 2 };

typedef struct tex_finding {
    uint32_t size;
    char id[8];           // "N201": the id of the rule, which never changes; ends with 0
    int32_t severity;     // tex_severity
    int32_t level;        // of the first place; 0 if it concerns the whole map
    int32_t column, row;  // the first texel on that level; -1 and -1 if there is none
    double figure;        // what was measured
    double confidence;    // 0.5 to 1; 1 if texels were counted
    char message[232];    // one sentence, cut if it is longer; ends with 0
} tex_finding;

typedef struct tex_check_options {
    uint32_t size;
    uint8_t swizzle[4];  // as in tex_unpack_options; all 0: found by the texels
    int32_t y_axis;      // -1: not known; else tex_y_axis that the map must have
    int32_t tiles;       // 1: the map must repeat without a seam
} tex_check_options;
#define TEX_CHECK_OPTIONS \
    { sizeof(tex_check_options), {0, 0, 0, 0}, -1, 0 }

// Checks a map of `levels` levels, each with tex_level_bytes() bytes without gaps. The rules are those of check-normals
// that need no file, height map or mesh. Writes the first `capacity` findings, each of the size that the caller set in
// findings[0].size, and their number altogether to *count; findings may be null if capacity is 0. Allocates with the
// heap: see above. Fails with TEX_OUT_OF_MEMORY.
TEX_C_API int32_t tex_check(const tex_texels* levels, int32_t level_count, const tex_check_options* options,
                            tex_finding* findings, size_t capacity, size_t* count);

#ifdef __cplusplus
}
#endif

#endif  // TEX_C_H
