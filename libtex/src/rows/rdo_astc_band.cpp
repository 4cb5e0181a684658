// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_astc_band.h"

#include <algorithm>
#include <vector>

#include "blocks/astc_decode.h"
#include "blocks/extent.h"
#include "kernels/chords.h"
#include "rows/rdo_parts.h"

namespace tex::inline v1 {
namespace {

void astc_chords(const RdoAstcBlock& block, int texels, const RdoAstcTexels& decoded, float chords[kAstcMostPlanned]) {
    for (int k = 0; k < texels; k += 16) {
        const float* const normals[3] = {block.x + k, block.y + k, block.z + k};
        block_chords(normals, decoded.x + k, decoded.y + k, chords + k);
    }
}

// The block at a column and a row of blocks.
RdoAstcBlock read_astc_block(const float* xy, Extent extent, Extent size, int column, int row) {
    RdoAstcBlock block{};
    std::fill_n(block.most, kAstcMostPlanned, kTooLong);
    for (int k = 0; k < size.width * size.height; ++k) {
        const int i = size.width * column + k % size.width, j = size.height * row + k / size.width;
        const int from = std::min(j, extent.height - 1) * extent.width + std::min(i, extent.width - 1);
        const float* const texel = xy + 2 * static_cast<std::size_t>(from);
        const RdoNormal normal = rdo_normal(texel[0], texel[1]);
        block.x[k] = normal.x;
        block.y[k] = normal.y;
        block.z[k] = normal.z;
        block.inside[k] = i < extent.width && j < extent.height ? 1.0f : 0.0f;
    }
    return block;
}

// Adds the texels of a block, without optimisation, to the sums of their parts.
void add_to_parts(RdoAstcBand& band, std::size_t index) {
    const RdoAstcBlock& block = band.blocks[index];
    const bool is_divided = band.is_divided(index);
    if (!is_divided) band.part(index).plain_sum += block.plain_sum;
    for (int k = 0; k < band.block_texels; ++k) {
        if (block.inside[k] == 0.0f) continue;
        RdoPart& part = is_divided ? band.parts[static_cast<std::size_t>(band.part_at(index, k))] : band.part(index);
        part.texels += 1.0;
        if (is_divided) part.plain_sum += degrees_of_chord(block.plain[k]);
    }
}

}  // namespace

void decode_astc_normals(Extent block, const std::byte* bytes, RdoAstcTexels& texels) {
    AstcTexels to;
    to.channel[0] = texels.x;
    to.channel[3] = texels.y;
    decode_astc(block, bytes, to);
    for (int k = 0; k < block.width * block.height; ++k) {
        texels.x[k] = 2.0f * texels.x[k] - 1.0f;
        texels.y[k] = 2.0f * texels.y[k] - 1.0f;
    }
}

float astc_chord_sum(const RdoAstcBlock& block, int texels, const RdoAstcTexels& decoded) {
    float chords[kAstcMostPlanned];
    astc_chords(block, texels, decoded, chords);
    return chord_sum_of(chords, block.most, block.inside, texels);
}

RdoAngles astc_angles(const RdoAstcBlock& block, int texels, const RdoAstcTexels& decoded) {
    float chords[kAstcMostPlanned];
    astc_chords(block, texels, decoded, chords);
    return angles_of(chords, block.plain, block.inside, texels);
}

std::vector<double> astc_growths(const RdoAstcBand& band, std::size_t index, const RdoAstcTexels& decoded) {
    const RdoAstcBlock& block = band.blocks[index];
    float chords[kAstcMostPlanned];
    astc_chords(block, band.block_texels, decoded, chords);
    std::vector<double> growths(band.parts.size());
    for (int k = 0; k < band.block_texels; ++k) {
        if (block.inside[k] == 0.0f) continue;
        growths[static_cast<std::size_t>(band.part_at(index, k))] +=
            degrees_of_chord(chords[k]) - degrees_of_chord(block.plain[k]);
    }
    return growths;
}

RdoAstcBand read_astc_band(const float* xy, int height, Extent level, int first, const PackOptions& options,
                           const std::byte* blocks) {
    const Extent extent{level.width, height};
    RdoAstcBand band;
    band.block = format_info(encoding_info(options.encoding).format).block;
    band.block_texels = band.block.width * band.block.height;
    band.window = options.rdo.window;
    const int across = band.across = blocks_across(extent.width, band.block.width);
    const int down = blocks_across(extent.height, band.block.height), count = across * down;
    band.plain.assign(blocks, blocks + kAstcBlockBytes * static_cast<std::ptrdiff_t>(count));
    band.places = RdoParts(level, first);
    band.set_parts(band.places.of_blocks(band.block, across, down));
    band.blocks.reserve(static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) {
        RdoAstcBlock& block = band.blocks.emplace_back(read_astc_block(xy, extent, band.block, n % across, n / across));
        RdoAstcTexels decoded;
        decode_astc_normals(band.block, blocks + kAstcBlockBytes * static_cast<std::ptrdiff_t>(n), decoded);
        astc_chords(block, band.block_texels, decoded, block.plain);
        block.plain_sum = astc_angles(block, band.block_texels, decoded).sum;
        add_to_parts(band, static_cast<std::size_t>(n));
    }
    std::vector<float> longest;
    for (RdoPart& part : band.parts) {
        part.improved_sum = part.plain_sum;
        longest.push_back(longest_chord(options.rdo, part));
    }
    for (std::size_t n = 0; n < band.blocks.size(); ++n) {
        RdoAstcBlock& block = band.blocks[n];
        for (int k = 0; k < band.block_texels; ++k) {
            const auto part = static_cast<std::size_t>(band.part_at(n, k));
            if (block.inside[k] != 0.0f) block.most[k] = std::max(longest[part], block.plain[k]);
        }
    }
    return band;
}

}  // namespace tex::inline v1
