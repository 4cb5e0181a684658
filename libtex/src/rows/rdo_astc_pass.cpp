// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_astc_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "blocks/astc_weights.h"
#include "kernels/chords.h"
#include "rows/rdo_astc_sources.h"

namespace tex::inline v1 {
namespace {

constexpr float kDegreesOfAstcChord = 57.29577951308232f;  // for short chords

struct AstcChoice {
    std::byte bytes[kAstcBlockBytes];
    int distance;  // of what is copied, in bytes; 0: nothing is
    int copied;    // bytes
    RdoAstcTexels decoded;
};

class AstcPass final : public RdoRuns {
public:
    AstcPass(const RdoAstcBand& band, const ByteCounts& literals)
        : RdoRuns(band), band_(band), literal_bits_(literal_bits(literals)),
          sources_(band.block, band.window, band.count()) {}

private:
    void set_lambda(float lambda) override {
        lambda_ = lambda;
        sources_.set_lambda(lambda);
    }
    void choose_block(int block) override;
    void keep_block(int block) override { write(block, plain_choice(block)); }
    [[nodiscard]] AstcChoice plain_choice(int block) const;
    [[nodiscard]] float bits_of(const AstcChoice& choice) const;
    void try_choice(int block, const AstcChoice& choice);
    void try_all(int block, int at);
    void try_front(int block, int at);
    void write(int block, const AstcChoice& choice);

    [[nodiscard]] std::byte* written(int block) {
        return result_.blocks.data() + std::ptrdiff_t{kAstcBlockBytes} * block;
    }

    const RdoAstcBand& band_;
    float lambda_ = 0.0f;
    const std::array<float, 256> literal_bits_;
    RdoAstcSources sources_;
    RdoMatches matches_;
    float codes_[2][kAstcMostPlanned] = {};  // of the block: x and y from 0 to 255
    AstcChoice best_;
    float least_ = 0.0f;
};

// The root of the sum of squared errors times this is about the sum of angles, in degrees.
float astc_angle_scale(const RdoAstcBlock& block, int texels) {
    float steepness = 0.0f;
    for (int k = 0; k < texels; ++k) {
        const float zz = block.z[k] * block.z[k];
        steepness += std::sqrt(1.0f + 0.5f * (1.0f - zz) / std::max(0.05f, zz));
    }
    // The mean of some lengths is about 0.9 of the root of their mean square.
    return 0.9f * kDegreesOfAstcChord * steepness / std::sqrt(static_cast<float>(texels));
}

AstcChoice AstcPass::plain_choice(int block) const {
    AstcChoice plain{{}, 0, 0, {}};
    std::memcpy(plain.bytes, band_.plain.data() + std::ptrdiff_t{kAstcBlockBytes} * block, kAstcBlockBytes);
    decode_astc_normals(band_.block, plain.bytes, plain.decoded);
    return plain;
}

float AstcPass::bits_of(const AstcChoice& choice) const {
    float bits = choice.distance == 0 ? 0.0f : matches_.bits(choice.distance, true);
    for (int k = choice.copied; k < kAstcBlockBytes; ++k)
        bits += literal_bits_[std::to_integer<std::size_t>(choice.bytes[k])];
    return bits;
}

void AstcPass::try_choice(int block, const AstcChoice& choice) {
    const float bits = lambda_ * bits_of(choice);
    if (bits >= least_) return;
    const RdoAstcBlock& texels = band_.blocks[static_cast<std::size_t>(block)];
    const float sum = astc_chord_sum(texels, band_.block_texels, choice.decoded);
    if (sum >= kTooLong) return;
    const float cost = kDegreesOfAstcChord * sum + bits;
    if (cost >= least_) return;
    least_ = cost;
    best_ = choice;
}

void AstcPass::try_all(int block, int at) {
    AstcChoice choice{{}, kAstcBlockBytes * (block - at), kAstcBlockBytes, sources_.decoded(at)};
    std::memcpy(choice.bytes, written(at), kAstcBlockBytes);
    try_choice(block, choice);
}

void AstcPass::try_front(int block, int at) {
    const std::optional<AstcLines>& lines = sources_.lines(at);
    if (!lines) return;
    AstcChoice choice{{}, kAstcBlockBytes * (block - at), (128 - lines->mode.weight_bits()) / 8, {}};
    write_astc_weights(sources_.grid(*lines), *lines, codes_[0], codes_[1], written(at), choice.bytes);
    decode_astc_normals(band_.block, choice.bytes, choice.decoded);
    try_choice(block, choice);
}

void AstcPass::choose_block(int block) {
    const RdoAstcBlock& texels = band_.blocks[static_cast<std::size_t>(block)];
    for (int k = 0; k < band_.block_texels; ++k) {
        codes_[0][k] = 127.5f * (texels.x[k] + 1.0f);
        codes_[1][k] = 127.5f * (texels.y[k] + 1.0f);
    }
    // The plain block keeps all limits.
    least_ = kTooLong;
    try_choice(block, plain_choice(block));
    sources_.find({block, &texels, astc_angle_scale(texels, band_.block_texels), least_});
    for (const int at : sources_.wholes()) try_all(block, at);
    for (const int at : sources_.fronts()) try_front(block, at);
    const auto try_near = [&](int distance) {
        const int at = block - distance / kAstcBlockBytes;
        if (distance % kAstcBlockBytes != 0 || at < 0) return;
        const auto is_new = [at](const std::vector<int>& found) {
            return std::find(found.begin(), found.end(), at) == found.end();
        };
        if (is_new(sources_.wholes())) try_all(block, at);
        if (is_new(sources_.fronts())) try_front(block, at);
    };
    bool tries_before = true;
    for (const int distance : matches_.last()) {
        try_near(distance);
        tries_before = tries_before && distance != kAstcBlockBytes;
    }
    if (tries_before) try_near(kAstcBlockBytes);

    const RdoAngles angles = astc_angles(texels, band_.block_texels, best_.decoded);
    const double growth = angles.sum - texels.plain_sum;
    const auto index = static_cast<std::size_t>(block);
    const bool is_spent =
        band_.is_divided(index) ? spend(astc_growths(band_, index, best_.decoded)) : spend(block, growth);
    if (!is_spent) return keep_block(block);
    result_.most_raised = std::max(result_.most_raised, angles.most_raised);
    write(block, best_);
}

void AstcPass::write(int block, const AstcChoice& choice) {
    std::memcpy(written(block), choice.bytes, kAstcBlockBytes);
    for (int k = choice.copied; k < kAstcBlockBytes; ++k)
        ++result_.literals[std::to_integer<std::size_t>(choice.bytes[k])];
    matches_.use(choice.distance);
    if (choice.copied < kAstcBlockBytes) matches_.use(0);
    sources_.add(choice.bytes, choice.decoded);
}

}  // namespace

std::unique_ptr<RdoRuns> rdo_astc_pass(const RdoAstcBand& band, const ByteCounts& literals) {
    return std::make_unique<AstcPass>(band, literals);
}

}  // namespace tex::inline v1
