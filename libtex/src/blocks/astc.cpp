// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <new>
#include <vector>

#include <astcenc.h>

#include "blocks/extent.h"
#include "threads/pool.h"

namespace tex {
namespace {

constexpr astcenc_swizzle kAsGiven = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};

float quality_of(Effort effort) {
    switch (effort) {
        case Effort::normal: return ASTCENC_PRE_MEDIUM;
        case Effort::best: return ASTCENC_PRE_THOROUGH;
        default: return ASTCENC_PRE_FAST;
    }
}

// libastcenc 4.2 keeps these two settings of the first image that a process encodes, for all later ones
// (compress_block() has them in static constants). The bytes would depend on the files before, so all images have the
// same: the greatest that it uses for fast and normal. A greater one ends the search of a block later.
constexpr float kOvershoot = 3.5f;

// The memory that libastcenc works with, and a row of texels for it.
struct Context {
    struct Free {
        void operator()(astcenc_context* context) const { astcenc_context_free(context); }
    };
    std::unique_ptr<astcenc_context, Free> library;
    std::vector<float> rgba;

    // The extents are valid, so all that can fail is memory.
    Context(Extent block, Effort effort) {
        astcenc_config config = {};
        astcenc_context* made = nullptr;
        bool done = astcenc_config_init(ASTCENC_PRF_LDR, static_cast<unsigned>(block.width),
                                        static_cast<unsigned>(block.height), 1, quality_of(effort),
                                        ASTCENC_FLG_MAP_NORMAL, &config) == ASTCENC_SUCCESS;
        config.tune_mode0_mse_overshoot = kOvershoot;
        config.tune_refinement_mse_overshoot = kOvershoot;
        done = done && astcenc_context_alloc(&config, 1, &made) == ASTCENC_SUCCESS;
        library.reset(made);
        if (!done) throw std::bad_alloc();
    }
};

std::shared_ptr<Context> take_context(Format format, Effort effort) {
    constexpr std::size_t kFormats =
        static_cast<std::size_t>(Format::astc_12x12_unorm) - static_cast<std::size_t>(Format::astc_4x4_unorm) + 1;
    static Pool<Context> pools[kFormats][3];
    const std::size_t index = static_cast<std::size_t>(format) - static_cast<std::size_t>(Format::astc_4x4_unorm);
    return pools[index][static_cast<std::size_t>(effort)].take(
        [&] { return std::make_unique<Context>(format_info(format).block, effort); });
}

astcenc_image image_of(Extent extent, void** slice) {
    return {static_cast<unsigned>(extent.width), static_cast<unsigned>(extent.height), 1, ASTCENC_TYPE_F32, slice};
}

std::size_t bytes_of(Format format, Extent extent) { return level_bytes(format, {extent.width, 1}); }

}  // namespace

void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks) {
    const std::shared_ptr<Context> context = take_context(format, effort);
    const auto texels = static_cast<std::size_t>(extent.texels());
    context->rgba.resize(4 * texels);
    float* rgba = context->rgba.data();
    for (std::size_t k = 0; k < texels; ++k, xy += 2, rgba += 4) {
        const float x = (std::clamp(xy[0], -1.0f, 1.0f) + 1.0f) * 0.5f;
        const float y = (std::clamp(xy[1], -1.0f, 1.0f) + 1.0f) * 0.5f;
        rgba[0] = rgba[1] = rgba[2] = x;
        rgba[3] = y;
    }
    void* slice = context->rgba.data();
    astcenc_image image = image_of(extent, &slice);
    const astcenc_error failed =
        astcenc_compress_image(context->library.get(), &image, &kAsGiven, reinterpret_cast<std::uint8_t*>(blocks),
                               bytes_of(format, extent), 0);
    if (failed != ASTCENC_SUCCESS) throw std::bad_alloc();
}

}  // namespace tex
