// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_band.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "blocks/block_half.h"
#include "blocks/extent.h"
#include "kernels/angle_search.h"
#include "kernels/chords.h"
#include "rows/codecs.h"
#include "rows/math.h"
#include "rows/rdo_parts.h"

namespace tex::inline v1 {
namespace {

constexpr std::ptrdiff_t kBandBlockBytes = 16;
constexpr double kDegreesOfRadian = 180.0 / math::kPi;

// The longest chord whose angle, as degrees_of_chord() computes it, is not above `degrees`.
float chord_of(float degrees) {
    constexpr double kJustBelow = 1.0 - 1e-6;
    if (degrees >= 180.0f) return 2.0f;
    return static_cast<float>(2.0 * math::sin(0.5 * static_cast<double>(degrees) / kDegreesOfRadian) * kJustBelow);
}

// The chords between the texels of a block and what 16 bytes decode to.
void chords_of(const RdoBand& band, std::size_t index, const std::byte* bytes, float chords[16]) {
    const RdoBlock& block = band.blocks[index];
    const float* const normals[3] = {block.x, block.y, block.z};
    float x[16], y[16];
    decode_half(band.kinds[0], bytes, x);
    decode_half(band.kinds[1], bytes + kHalfBytes, y);
    block_chords(normals, x, y, chords);
}

// Adds block `index` of a row.
void add_block(const BlockRow& row, int index, RdoBand& band) {
    RdoBlock block;
    for (int k = 0; k < kBlockTexels; ++k) {
        const int i = kBlockEdge * index + k % kBlockEdge;
        const int j = k / kBlockEdge;
        const int column = std::min(i, row.width - 1);
        const RdoNormal normal = rdo_normal(row.x[j][column], row.y[j][column]);
        block.x[k] = normal.x;
        block.y[k] = row.negate_y ? -normal.y : normal.y;
        block.z[k] = normal.z;
        block.inside[k] = i < row.width && j < row.height ? 1.0f : 0.0f;
    }
    band.blocks.push_back(block);
}

// Sets how long the chords of all texels may get: the longest of their part, or as long as they are without
// optimisation.
void set_limits(const RdoOptions& options, RdoBand& band) {
    std::vector<float> longest_of;
    for (const RdoPart& part : band.parts) longest_of.push_back(longest_chord(options, part));
    for (std::size_t index = 0; index < band.blocks.size(); ++index) {
        RdoBlock& block = band.blocks[index];
        const float longest = longest_of[static_cast<std::size_t>(band.part_of[index])];
        for (std::size_t k = 0; k < 16; ++k)
            block.most[k] = block.inside[k] == 0.0f ? 1e30f : std::max(longest, band.plain_chords[16 * index + k]);
    }
}

// Improved blocks that break a limit become plain ones again, so that every block of `improved` may be written.
void measure_improved(RdoBand& band) {
    band.improved_angles.resize(band.blocks.size());
    for (std::size_t index = 0; index < band.blocks.size(); ++index) {
        std::byte* const bytes = band.improved.data() + kBandBlockBytes * static_cast<std::ptrdiff_t>(index);
        float chords[16];
        chords_of(band, index, bytes, chords);
        for (std::size_t k = 0; k < 16; ++k) {
            if (chords[k] <= band.blocks[index].most[k]) continue;
            std::memcpy(bytes, band.plain.data() + kBandBlockBytes * static_cast<std::ptrdiff_t>(index),
                        kBandBlockBytes);
            break;
        }
        band.improved_angles[index] = rdo_angles(band, index, bytes).sum;
        band.part(index).improved_sum += band.improved_angles[index];
    }
}

}  // namespace

double degrees_of_chord(float chord) {
    const double half = std::min(1.0, 0.5 * static_cast<double>(chord));
    return half >= 1.0 ? 180.0 : 2.0 * kDegreesOfRadian * math::atan(half / std::sqrt(1.0 - half * half));
}

float longest_chord(const RdoOptions& options, const RdoPart& part) {
    const double mean = part.plain_sum / part.texels;
    const auto usual = static_cast<float>(std::min(180.0, kRdoMaxOfMean * (mean + static_cast<double>(options.mean))));
    return chord_of(options.max > 0.0f ? options.max : usual);
}

RdoNormal rdo_normal(float x, float y) {
    const auto within_one = [](float n) { return std::fmin(std::fmax(n, -1.0f), 1.0f); };
    x = within_one(x);
    y = within_one(y);
    const float flat = x * x + y * y;
    const float factor = 1.0f / std::sqrt(std::max(1.0f, flat));
    return {factor * x, factor * y, std::sqrt(1.0f - std::min(1.0f, flat))};
}

RdoAngles angles_of(const float* chords, const float* plain, const float* inside, int texels) {
    RdoAngles angles;
    for (int k = 0; k < texels; ++k) {
        if (inside[k] == 0.0f) continue;
        const double angle = degrees_of_chord(chords[k]);
        angles.sum += angle;
        if (chords[k] > plain[k]) angles.most_raised = std::max(angles.most_raised, angle);
    }
    return angles;
}

float chord_sum_of(const float* chords, const float* most, const float* inside, int texels) {
    float sum = 0.0f;
    for (int k = 0; k < texels; ++k) {
        if (chords[k] > most[k]) return kTooLong;
        sum += inside[k] * chords[k];
    }
    return sum;
}

RdoAngles rdo_angles(const RdoBand& band, std::size_t index, const std::byte* bytes) {
    float chords[16];
    chords_of(band, index, bytes, chords);
    return angles_of(chords, band.plain_chords.data() + 16 * index, band.blocks[index].inside, 16);
}

RdoBand read_band(const std::function<BlockRow(int row)>& rows, int count, Extent level, int first,
                  const PackOptions& options, const std::byte* blocks) {
    constexpr int kReach = 2;  // farther steps gain little
    RdoBand band;
    band.kinds = codec_of(options.encoding).halves;
    band.window = options.rdo.window;
    for (int r = 0; r < count; ++r) {
        const BlockRow row = rows(r);
        const int across = blocks_across(row.width);
        for (int b = 0; b < across; ++b) add_block(row, b, band);
        const std::ptrdiff_t pitch = kBandBlockBytes * across;
        band.plain.insert(band.plain.end(), blocks + r * pitch, blocks + (r + 1) * pitch);
        band.improved.insert(band.improved.end(), blocks + r * pitch, blocks + (r + 1) * pitch);
        if (!keeps_slope(band.kinds[0])) improve_angles(row, band.kinds, kReach, band.improved.data() + r * pitch);
    }
    band.set_parts(RdoParts(level, first).of_blocks({kBlockEdge, kBlockEdge}, blocks_across(level.width), count));
    band.plain_chords.resize(16 * band.blocks.size());
    for (std::size_t index = 0; index < band.blocks.size(); ++index) {
        const std::byte* const bytes = band.plain.data() + kBandBlockBytes * static_cast<std::ptrdiff_t>(index);
        chords_of(band, index, bytes, band.plain_chords.data() + 16 * index);
        RdoPart& part = band.part(index);
        for (const float inside : band.blocks[index].inside) part.texels += static_cast<double>(inside);
        part.plain_sum += rdo_angles(band, index, bytes).sum;
    }
    set_limits(options.rdo, band);
    measure_improved(band);
    return band;
}

}  // namespace tex::inline v1
