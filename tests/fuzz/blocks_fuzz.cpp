// SPDX-License-Identifier: Apache-2.0
// Texels and blocks of any bytes, in every format, decode to finite-or-stored values without reading or writing beside
// them; the kernels' blocks are those of blocks/, bit for bit; what is unpacked can be packed in every encoding.
//
// Input: format, width, height, encoding, effort, then the bytes of the level, repeated as far as they are needed.

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include <tex/pack.h>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "blocks/eac.h"
#include "rows/codecs.h"

namespace {

// The channels of one block, as blocks/ decodes it.
struct Block {
    float channel[4][16] = {};
};

Block decode_block(tex::Format format, const std::byte* bytes) {
    Block block;
    auto& [r, g, b, a] = block.channel;
    float ignored[16];
    switch (format) {
        case tex::Format::bc1_unorm: tex::decode_bc1(bytes, tex::Bc1Mode::standard, r, g, b, a); break;
        case tex::Format::bc2_unorm:
            tex::decode_bc1(bytes + 8, tex::Bc1Mode::four_colors, r, g, b, ignored);
            tex::decode_bc2_alpha(bytes, a);
            break;
        case tex::Format::bc3_unorm:
            tex::decode_bc1(bytes + 8, tex::Bc1Mode::four_colors, r, g, b, ignored);
            tex::decode_bc4_unorm(bytes, a);
            break;
        case tex::Format::bc4_unorm: tex::decode_bc4_unorm(bytes, r); break;
        case tex::Format::bc4_snorm: tex::decode_bc4_snorm(bytes, r); break;
        case tex::Format::bc5_unorm:
            tex::decode_bc4_unorm(bytes, r);
            tex::decode_bc4_unorm(bytes + 8, g);
            break;
        case tex::Format::bc5_snorm:
            tex::decode_bc4_snorm(bytes, r);
            tex::decode_bc4_snorm(bytes + 8, g);
            break;
        case tex::Format::eac_r11_unorm: tex::decode_eac_unorm(bytes, r); break;
        case tex::Format::eac_r11_snorm: tex::decode_eac_snorm(bytes, r); break;
        case tex::Format::eac_rg11_unorm:
            tex::decode_eac_unorm(bytes, r);
            tex::decode_eac_unorm(bytes + 8, g);
            break;
        case tex::Format::eac_rg11_snorm:
            tex::decode_eac_snorm(bytes, r);
            tex::decode_eac_snorm(bytes + 8, g);
            break;
        default: break;
    }
    return block;
}

// Whether there is a decoder beside that of blocks/.
bool has_kernel(tex::Format format) {
    const tex::Codec& codec = *tex::format_row(format).codec;
    return codec.has_grid && codec.is_written && codec.whole == nullptr;
}

void compare_blocks(const tex::Texture& texture, const tex::Image& image) {
    const tex::FormatInfo info = tex::format_info(texture.format);
    const tex::Extent extent = texture.extent();
    const int across = (extent.width + 3) / 4;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const auto place = static_cast<std::size_t>(j / 4 * across + i / 4);
            const Block block = decode_block(texture.format, texture.levels[0].bytes.data() + place * info.block_bytes);
            for (std::size_t c = 0; c < image.planes.size(); ++c) {
                const float value = image.planes[c].at(i, j);
                if (std::memcmp(&value, &block.channel[c][j % 4 * 4 + i % 4], sizeof value) != 0) std::abort();
            }
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kChoices = 5;
    if (size <= kChoices) return 0;
    tex::Texture texture;
    texture.format = tex::kFormatNames[data[0] % std::size(tex::kFormatNames)].value;
    tex::PackOptions options;
    options.encoding = tex::kEncodingNames[data[3] % std::size(tex::kEncodingNames)].value;
    options.effort = tex::kEffortNames[data[4] % std::size(tex::kEffortNames)].value;
    // The best fit is slow under sanitizers; others fit groups of up to 16 blocks that stand side by side. A second row
    // of blocks stands for all others.
    const tex::Extent most = options.effort == tex::Effort::best ? tex::Extent{6, 6} : tex::Extent{72, 5};
    const tex::Extent extent{data[1] % most.width + 1, data[2] % most.height + 1};
    texture.levels.push_back({extent, std::vector<std::byte>(tex::level_bytes(texture.format, extent))});
    for (std::size_t k = 0; k < texture.levels[0].bytes.size(); ++k) {
        texture.levels[0].bytes[k] = static_cast<std::byte>(data[kChoices + k % (size - kChoices)]);
    }
    tex::Execution one;
    one.threads = 1;
    const auto image = tex::decode(texture, 0, one);
    if (!image || static_cast<int>(image->planes.size()) != tex::format_info(texture.format).channels) std::abort();
    if (tex::format_info(texture.format).has_blocks() && has_kernel(texture.format)) compare_blocks(texture, *image);

    const auto chain = tex::unpack(texture, {}, one);
    if (!chain) return 0;  // one channel has no y
    const auto packed = tex::pack(*chain, options, one);
    if (!packed || !tex::decode(*packed, 0, one)) std::abort();
    return 0;
}
