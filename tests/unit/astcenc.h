// SPDX-License-Identifier: Apache-2.0
// astcenc.h: libastcenc, the judge of our decoder and encoder of ASTC.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <astcenc.h>
#include <gtest/gtest.h>
#include <tex/types.h>

namespace tex {

class Astcenc {
public:
    // With its mode for normals, unless the quality is 0: then it only decodes.
    explicit Astcenc(Extent block, float quality = 0) {
        const unsigned flags = quality == 0 ? ASTCENC_FLG_DECOMPRESS_ONLY : ASTCENC_FLG_MAP_NORMAL;
        astcenc_config config{};
        EXPECT_EQ(astcenc_config_init(ASTCENC_PRF_LDR, static_cast<unsigned>(block.width),
                                      static_cast<unsigned>(block.height), 1, quality, flags, &config),
                  ASTCENC_SUCCESS);
        astcenc_context* made = nullptr;
        EXPECT_EQ(astcenc_context_alloc(&config, 1, &made), ASTCENC_SUCCESS);
        context_.reset(made);
    }

    // Texels R, G, B, A of whole blocks.
    std::vector<float> decode(const std::byte* blocks, std::size_t bytes, Extent extent) {
        std::vector<float> rgba(4 * static_cast<std::size_t>(extent.texels()));
        void* slice = rgba.data();
        astcenc_image image = image_of(extent, &slice);
        EXPECT_EQ(astcenc_decompress_image(context_.get(), reinterpret_cast<const std::uint8_t*>(blocks), bytes, &image,
                                           &kAsGiven, 0),
                  ASTCENC_SUCCESS);
        return rgba;
    }

    void encode(std::vector<float>& rgba, Extent extent, std::vector<std::byte>& blocks) {
        void* slice = rgba.data();
        astcenc_image image = image_of(extent, &slice);
        EXPECT_EQ(astcenc_compress_image(context_.get(), &image, &kAsGiven,
                                         reinterpret_cast<std::uint8_t*>(blocks.data()), blocks.size(), 0),
                  ASTCENC_SUCCESS);
        EXPECT_EQ(astcenc_compress_reset(context_.get()), ASTCENC_SUCCESS);
    }

private:
    static constexpr astcenc_swizzle kAsGiven = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};

    static astcenc_image image_of(Extent extent, void** slice) {
        return {static_cast<unsigned>(extent.width), static_cast<unsigned>(extent.height), 1, ASTCENC_TYPE_F32, slice};
    }

    struct Free {
        void operator()(astcenc_context* context) const { astcenc_context_free(context); }
    };
    std::unique_ptr<astcenc_context, Free> context_;
};

}  // namespace tex
