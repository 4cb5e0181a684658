// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rgb_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "kernels/chords.h"
#include "kernels/entry_search.h"
#include "rows/rdo_rgb_sources.h"

namespace tex::inline v1 {
namespace {

constexpr float kDegreesOfRgbChord = 57.29577951308232f;  // for short chords
constexpr int kRgbPassBytes = 16;                         // of a block

struct RgbChoice {
    std::byte bytes[kRgbPassBytes];
    int distance;  // of what is copied, in bytes; 0: nothing is
    int copied;    // bytes
    RdoRgbTexels decoded;
    int entries;  // the block that has its entries; its own are the next ones
};

class RgbPass final : public RdoRuns {
public:
    RgbPass(const RdoRgbBand& band, const ByteCounts& literals)
        : RdoRuns(band), band_(band), literal_bits_(literal_bits(literals)), sources_(band.window, band.count()) {}

private:
    void set_lambda(float lambda) override {
        lambda_ = lambda;
        sources_.set_lambda(lambda);
    }
    void choose_block(int block) override;
    void keep_block(int block) override { write(block, plain_choice(block)); }
    [[nodiscard]] RgbChoice plain_choice(int block) const;
    [[nodiscard]] float bits_of(const RgbChoice& choice) const;
    void try_choice(const RdoRgbBlock& block, const RgbChoice& choice, const float squares[16]);
    void try_all(int block, int at);
    void try_front(int block, int at);
    void write(int block, const RgbChoice& choice);

    [[nodiscard]] const RdoRgbBlock& texels(int block) const { return band_.blocks[static_cast<std::size_t>(block)]; }
    [[nodiscard]] std::byte* written(int block) {
        return result_.blocks.data() + std::ptrdiff_t{kRgbPassBytes} * block;
    }

    const RdoRgbBand& band_;
    float lambda_ = 0.0f;
    const std::array<float, 256> literal_bits_;
    RdoRgbSources sources_;
    RdoMatches matches_;
    RgbChoice best_;
    float least_ = 0.0f;
};

// The root of the sum of squared errors of x and y times this is about the sum of angles, in degrees.
float rgb_angle_scale(const RdoRgbBlock& block) {
    float steepness = 0.0f;
    for (const float z : block.texels.value[2])
        steepness += std::sqrt(1.0f + 0.5f * (1.0f - z * z) / std::max(0.05f, z * z));
    // The mean of some lengths is about 0.9 of the root of their mean square.
    return 0.9f * kDegreesOfRgbChord * steepness / 4.0f;
}

RgbChoice RgbPass::plain_choice(int block) const {
    RgbChoice plain{{}, 0, 0, {}, block};
    std::memcpy(plain.bytes, band_.plain.data() + std::ptrdiff_t{kRgbPassBytes} * block, kRgbPassBytes);
    decode_rgb_entries(RdoRgbEntries(band_.read_entries(plain.bytes)), plain.bytes, plain.decoded);
    return plain;
}

float RgbPass::bits_of(const RgbChoice& choice) const {
    float bits = choice.distance == 0 ? 0.0f : matches_.bits(choice.distance, true);
    for (int k = choice.copied; k < kRgbPassBytes; ++k)
        bits += literal_bits_[std::to_integer<std::size_t>(choice.bytes[k])];
    return bits;
}

void RgbPass::try_choice(const RdoRgbBlock& block, const RgbChoice& choice, const float squares[16]) {
    const float bits = lambda_ * bits_of(choice);
    if (bits >= least_) return;
    const float sum = rgb_chord_sum(block, squares);
    if (sum >= kTooLong) return;
    const float cost = kDegreesOfRgbChord * sum + bits;
    if (cost >= least_) return;
    least_ = cost;
    best_ = choice;
}

void RgbPass::try_all(int block, int at) {
    RgbChoice choice{{}, kRgbPassBytes * (block - at), kRgbPassBytes, sources_.decoded(at), at};
    std::memcpy(choice.bytes, written(at), kRgbPassBytes);
    float squares[16];
    squared_distances(texels(block).texels.value, choice.decoded.value, squares);
    try_choice(texels(block), choice, squares);
}

void RgbPass::try_front(int block, int at) {
    const RdoRgbEntries& entries = sources_.entries(at);
    if (entries.block.count == 1) return;
    float squares[16], found[16];
    closest_entries({texels(block).texels.value, entries.value, entries.block.total(), entries.row, entries.distances},
                    squares, found);
    RgbChoice choice{{}, kRgbPassBytes * (block - at), entries.block.front_bytes(), {}, at};
    std::uint8_t numbers[16];
    for (int k = 0; k < 16; ++k) {
        const auto n = static_cast<int>(found[k]);
        numbers[k] = static_cast<std::uint8_t>(n % entries.block.count);
        for (int c = 0; c < 4; ++c) choice.decoded.value[c][k] = entries.value[c][n];
    }
    write_entry_numbers(entries.block, written(at), numbers, choice.bytes);
    try_choice(texels(block), choice, squares);
}

void RgbPass::choose_block(int block) {
    const RdoRgbBlock& its = texels(block);
    // The plain block keeps all limits.
    least_ = kTooLong;
    const RgbChoice plain = plain_choice(block);
    float squares[16];
    squared_distances(its.texels.value, plain.decoded.value, squares);
    try_choice(its, plain, squares);
    sources_.find({block, &its, rgb_angle_scale(its), least_});
    for (const int at : sources_.wholes()) try_all(block, at);
    for (const int at : sources_.fronts()) try_front(block, at);
    const auto try_near = [&](int distance) {
        const int at = block - distance / kRgbPassBytes;
        if (distance % kRgbPassBytes != 0 || at < 0) return;
        const auto is_new = [at](const std::vector<int>& found) {
            return std::find(found.begin(), found.end(), at) == found.end();
        };
        if (is_new(sources_.wholes())) try_all(block, at);
        if (is_new(sources_.fronts())) try_front(block, at);
    };
    bool tries_before = true;
    for (const int distance : matches_.last()) {
        try_near(distance);
        tries_before = tries_before && distance != kRgbPassBytes;
    }
    if (tries_before) try_near(kRgbPassBytes);

    const RdoAngles angles = rgb_angles(its, best_.decoded);
    if (!spend(block, angles.sum - its.plain_sum)) return keep_block(block);
    result_.most_raised = std::max(result_.most_raised, angles.most_raised);
    write(block, best_);
}

void RgbPass::write(int block, const RgbChoice& choice) {
    std::memcpy(written(block), choice.bytes, kRgbPassBytes);
    for (int k = choice.copied; k < kRgbPassBytes; ++k)
        ++result_.literals[std::to_integer<std::size_t>(choice.bytes[k])];
    matches_.use(choice.distance);
    if (choice.copied < kRgbPassBytes) matches_.use(0);
    if (choice.entries < block)
        sources_.add(RdoRgbEntries(sources_.entries(choice.entries)), choice.decoded);
    else
        sources_.add(RdoRgbEntries(band_.read_entries(choice.bytes)), choice.decoded);
}

}  // namespace

std::unique_ptr<RdoRuns> rdo_rgb_pass(const RdoRgbBand& band, const ByteCounts& literals) {
    return std::make_unique<RgbPass>(band, literals);
}

}  // namespace tex::inline v1
