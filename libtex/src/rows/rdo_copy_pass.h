// SPDX-License-Identifier: Apache-2.0
// rdo_copy_pass.h: one pass of rate-distortion optimisation over the blocks of a band whose components share what a
// block has: ASTC, BC7, UASTC.
//
// For each block it compares
//
//     literals    the block as it is without optimisation
//     wholes      all 16 bytes of a block in the window
//     fronts      all that is in front of what picks entries (weights, indices) of one: modes, partitions, endpoints,
//                 hints. Each texel picks its entry again. That is at the end of a block, so that the bytes in front of
//                 it are the same
//
// also of the block before and of those at the last three distances, which a coder writes in a few bits, and takes the
// one with the least D + lambda R. rdo_copies.h picks the blocks that are worth a copy.

#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "kernels/chords.h"
#include "rows/rdo_band.h"
#include "rows/rdo_copies.h"
#include "rows/rdo_rate.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

inline constexpr float kDegreesOfShortChord = 57.29577951308232f;

// What is left to `Kind`, the codec, which is made of its band:
//     Texels, Shape                     what a block decodes to; what is in its front
//     kReach
//     shape_of(bytes)                   reads a front
//     line_of(shape)                    where its entries lie
//     decode(shape, bytes)
//     x(texels), y(texels)              decoded components
//     start(block)                      the next block that chooses; the functions below are about it
//     searched()                        its x and y, and its scale; see RdoSearched
//     chord_sum(texels)                 of decoded ones, or kTooLong
//     degrees(texels)                   about the sum of the angles
//     write_front(shape, from, to, texels)  copies the front of `from`, and picks entries; returns the bytes of the
//     front front_sum(texels)                 the chord_sum() of what write_front() has made angles(texels),
//     plain_sum() is_divided(), growths(texels)     whether its texels are in several parts, and how much the angles
//     grow in each
template <class Kind>
class RdoCopyPass final : public RdoRuns {
public:
    template <class Band>
    RdoCopyPass(const Band& band, const ByteCounts& literals)
        : RdoRuns(band), plain_(band.plain), kind_(band), literal_bits_(literal_bits(literals)),
          copies_(band.block, band.window, band.count()) {
        shapes_.reserve(band.count());
        decoded_.reserve(band.count());
    }

private:
    using Texels = typename Kind::Texels;
    static constexpr int kOwn = -1;

    struct Choice {
        std::byte bytes[kRdoBlockBytes];
        int distance;  // of what is copied, in bytes; 0: nothing is
        int copied;    // bytes
        int shape;     // the block that has the same front; or kOwn
        Texels decoded;
    };

    void set_lambda(float lambda) override {
        lambda_ = lambda;
        copies_.set_lambda(lambda);
    }

    void keep_block(int block) override { write(block, plain_choice(block)); }

    void choose_block(int block) override {
        kind_.start(block);
        // The plain block keeps all limits.
        least_ = kTooLong;
        const Choice plain = plain_choice(block);
        try_choice(plain, [&] { return kind_.chord_sum(plain.decoded); });
        RdoSearched searched = kind_.searched();
        searched.number = block;
        searched.cost = least_;
        copies_.find(searched, Kind::kReach, [&](int at) { return kind_.degrees(decoded_[index(at)]); });
        for (const int at : copies_.wholes()) try_all(block, at);
        for (const int at : copies_.fronts()) try_front(block, at);
        bool tries_before = true;
        for (const int distance : matches_.last()) {
            try_near(block, distance);
            tries_before = tries_before && distance != kRdoBlockBytes;
        }
        if (tries_before) try_near(block, kRdoBlockBytes);

        const RdoAngles angles = kind_.angles(best_.decoded);
        const bool is_spent =
            kind_.is_divided() ? spend(kind_.growths(best_.decoded)) : spend(block, angles.sum - kind_.plain_sum());
        if (!is_spent) return write(block, plain);
        result_.most_raised = std::max(result_.most_raised, angles.most_raised);
        write(block, best_);
    }

    [[nodiscard]] Choice plain_choice(int block) {
        Choice plain{{}, 0, 0, kOwn, {}};
        std::memcpy(plain.bytes, plain_.data() + std::ptrdiff_t{kRdoBlockBytes} * block, kRdoBlockBytes);
        own_ = kind_.shape_of(plain.bytes);
        kind_.decode(own_, plain.bytes, plain.decoded);
        return plain;
    }

    template <class Sum>
    void try_choice(const Choice& choice, const Sum& sum_of) {
        float bits = choice.distance == 0 ? 0.0f : matches_.bits(choice.distance, true);
        for (int k = choice.copied; k < kRdoBlockBytes; ++k)
            bits += literal_bits_[std::to_integer<std::size_t>(choice.bytes[k])];
        const float price = lambda_ * bits;
        if (price >= least_) return;
        const float sum = sum_of();
        if (sum >= kTooLong) return;
        const float cost = kDegreesOfShortChord * sum + price;
        if (cost >= least_) return;
        least_ = cost;
        best_ = choice;
    }

    void try_all(int block, int at) {
        Choice choice{{}, kRdoBlockBytes * (block - at), kRdoBlockBytes, at, decoded_[index(at)]};
        std::memcpy(choice.bytes, written(at), kRdoBlockBytes);
        try_choice(choice, [&] { return kind_.chord_sum(choice.decoded); });
    }

    void try_front(int block, int at) {
        const auto& shape = shapes_[index(at)];
        if (!Kind::has_front(shape)) return;
        Choice choice{{}, kRdoBlockBytes * (block - at), 0, at, {}};
        choice.copied = kind_.write_front(shape, written(at), choice.bytes, choice.decoded);
        try_choice(choice, [&] { return kind_.front_sum(choice.decoded); });
    }

    // At a distance that a coder writes in a few bits.
    void try_near(int block, int distance) {
        const int at = block - distance / kRdoBlockBytes;
        if (distance % kRdoBlockBytes != 0 || at < 0) return;
        const auto is_new = [at](const std::vector<int>& found) {
            return std::find(found.begin(), found.end(), at) == found.end();
        };
        if (is_new(copies_.wholes())) try_all(block, at);
        if (is_new(copies_.fronts())) try_front(block, at);
    }

    void write(int block, const Choice& choice) {
        std::memcpy(written(block), choice.bytes, kRdoBlockBytes);
        for (int k = choice.copied; k < kRdoBlockBytes; ++k)
            ++result_.literals[std::to_integer<std::size_t>(choice.bytes[k])];
        matches_.use(choice.distance);
        if (choice.copied < kRdoBlockBytes) matches_.use(0);
        decoded_.push_back(choice.decoded);
        shapes_.push_back(choice.shape == kOwn ? own_ : shapes_[index(choice.shape)]);
        copies_.add(Kind::x(choice.decoded), Kind::y(choice.decoded), kind_.line_of(shapes_.back()));
    }

    [[nodiscard]] static std::size_t index(int block) { return static_cast<std::size_t>(block); }
    [[nodiscard]] std::byte* written(int block) {
        return result_.blocks.data() + std::ptrdiff_t{kRdoBlockBytes} * block;
    }

    const std::vector<std::byte>& plain_;
    Kind kind_;
    const std::array<float, 256> literal_bits_;
    float lambda_ = 0.0f;
    RdoCopies copies_;
    RdoMatches matches_;
    std::vector<typename Kind::Shape> shapes_;
    std::vector<Texels> decoded_;
    typename Kind::Shape own_;  // of the block as it is without optimisation
    Choice best_;
    float least_ = 0.0f;
};

}  // namespace tex::inline v1
