// SPDX-License-Identifier: Apache-2.0
// block_tries.h: ways to encode each of many blocks, in lists, so that those of one kind fill vectors while they are
// fitted. Batches of BC7 (four channels) and of UASTC (three) are built on it.

#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/bc7_fit.h"
#include "kernels/bc7_guess.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {

template <int kChannels>
class BlockTries {
public:
    static constexpr int kMost = 256;  // blocks

    // The texels of a block, row by row: x, y, z of a vector, and the fourth channel.
    float (*texels(int block))[kChannels] { return texels_[at(block)].value; }

protected:
    static constexpr unsigned kAllTexels = 0xffff;

    struct Texels {
        float value[16][kChannels];
    };
    // A way to encode a block.
    struct Try {
        float error;
        std::int16_t block;
        std::uint8_t kind, pattern;
        std::uint8_t component[3];  // of two planes: that of the second one, and those of the first
        std::uint8_t ends[3][2][kChannels];
    };
    // A subset of a try, of which subset 0 is all.
    struct Part {
        int index;  // of the try
        std::uint16_t mask;
        std::uint8_t subset, texels;
    };
    struct Indices {
        std::uint8_t line[16], second[16];
    };

    static std::size_t at(int n) { return static_cast<std::size_t>(n); }
    static std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(value); }

    // Takes memory for so many tries of each block.
    explicit BlockTries(int most_tries) : lanes_(bc7_lanes()) {
        const std::size_t tries = at(kMost) * at(most_tries);
        texels_.resize(at(kMost + kBc7Lanes));
        tries_.reserve(tries);
        parts_.reserve(3 * tries);
        sorted_.reserve(3 * tries);
        indices_.resize(at(kMost));
    }
    static std::size_t memory_of(int most_tries) {
        const std::size_t tries = at(kMost) * at(most_tries);
        return LentMemory::taken_by(at(kMost + kBc7Lanes) * sizeof(Texels)) +
               LentMemory::taken_by(tries * sizeof(Try)) + 2 * LentMemory::taken_by(3 * tries * sizeof(Part)) +
               LentMemory::taken_by(at(kMost) * sizeof(Indices));
    }

    // Makes vectors unit vectors, and fills the lanes of the last group.
    void make_unit(int count) {
        for (int block = 0; block < count; ++block) {
            for (float(&texel)[kChannels] : texels_[at(block)].value) {
                const float length = std::sqrt(texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2]);
                if (length > 1e-6f) {
                    for (int c = 0; c < 3; ++c) texel[c] /= length;
                } else {
                    texel[0] = texel[1] = 0.0f;
                    texel[2] = 1.0f;
                }
            }
        }
        for (int block = count; block % lanes_ != 0; ++block) texels_[at(block)] = texels_[at(count - 1)];
    }

    // Puts whole blocks into the group, from this one on.
    void load(int first) {
        group_.texels = 16;
        for (int lane = 0; lane < lanes_; ++lane) {
            const Texels& texels = texels_[at(first + lane)];
            for (int k = 0; k < 16; ++k) {
                for (int c = 0; c < kChannels; ++c) group_.value[k][c][lane] = texels.value[k][c];
            }
        }
    }

    // Drops lines, which are the kinds from this one on, whose guesses are above the error of the block in two planes.
    void drop_hopeless(int first_line, float worth) {
        std::size_t kept = 0;
        float least = 0;
        for (std::size_t k = 0; k < tries_.size(); ++k) {
            const Try one = tries_[k];
            if (k == 0 || one.block != tries_[k - 1].block) least = kBc7None;  // the planes of a block come first
            if (one.kind < first_line) least = std::min(least, one.error);
            if (one.kind < first_line || one.error <= least * worth) tries_[kept++] = one;
        }
        tries_.resize(kept);
    }

    // Keeps the best so many tries of each block, blocks in order.
    void keep(int count) {
        const auto better = [](const Try& a, const Try& b) { return a.error < b.error; };
        std::size_t kept = 0;
        for (std::size_t first = 0, end = 0; first < tries_.size(); first = end) {
            while (end < tries_.size() && tries_[end].block == tries_[first].block) ++end;
            for (std::size_t k = first; k < std::min(end, first + at(count)); ++k) {
                const auto from = tries_.begin() + static_cast<std::ptrdiff_t>(k);
                std::iter_swap(from, std::min_element(from, tries_.begin() + static_cast<std::ptrdiff_t>(end), better));
                tries_[kept++] = *from;
            }
        }
        tries_.resize(kept);
    }

    // Fits the tries of a kind, and those of several subsets subset by subset. `texels_of(pattern, subset)` are the
    // texels of a subset, a bit for each; `start(try)` is what is lost besides; `fit()` fits the group. So many
    // channels of the endpoints are taken from it, and the indices if they are wanted.
    template <class TexelsOf, class Start, class Fit>
    void fit_kind(int kind, int subsets, int channels, bool indices, const TexelsOf& texels_of, const Start& start,
                  const Fit& fit) {
        parts_.clear();
        for (std::size_t k = 0; k < tries_.size(); ++k) {
            if (tries_[k].kind != kind) continue;
            tries_[k].error = start(tries_[k]);
            for (int subset = 0; subset < subsets; ++subset) {
                const unsigned texels = subsets == 1 ? kAllTexels : texels_of(tries_[k].pattern, subset);
                parts_.push_back({static_cast<int>(k), static_cast<std::uint16_t>(texels),
                                  static_cast<std::uint8_t>(subset), static_cast<std::uint8_t>(std::popcount(texels))});
            }
        }
        if (subsets > 1) sort_parts();
        for (std::size_t k = 0; k < parts_.size(); k += at(lanes_)) {
            const int used = static_cast<int>(std::min(at(lanes_), parts_.size() - k));
            group_.texels = parts_[k + at(used - 1)].texels;
            for (int lane = 0; lane < lanes_; ++lane) gather(parts_[k + at(std::min(lane, used - 1))], lane);
            fit();
            for (int lane = 0; lane < used; ++lane) scatter(parts_[k + at(lane)], lane, channels, indices);
        }
    }

    const int lanes_;
    WorkingVector<Texels> texels_;
    WorkingVector<Try> tries_;
    WorkingVector<Part> parts_, sorted_;
    WorkingVector<Indices> indices_;
    Bc7Group group_;

private:
    // Sorts parts by their numbers of texels.
    void sort_parts() {
        std::size_t place[18] = {};
        for (const Part& part : parts_) ++place[part.texels + 1];
        for (int k = 1; k < 18; ++k) place[k] += place[k - 1];
        sorted_.resize(parts_.size());
        for (const Part& part : parts_) sorted_[place[part.texels]++] = part;
        parts_.swap(sorted_);
    }

    void gather(const Part& part, int lane) {
        const Try& from = tries_[at(part.index)];
        const Texels& texels = texels_[at(from.block)];
        int k = 0;
        for (unsigned left = part.mask; left != 0; left &= left - 1, ++k) {
            const float* const value = texels.value[std::countr_zero(left)];
            for (int c = 0; c < 3; ++c) group_.value[k][c][lane] = value[from.component[c]];
            for (int c = 3; c < kChannels; ++c) group_.value[k][c][lane] = value[c];
            group_.weight[k][lane] = 1.0f;
        }
        for (; k < group_.texels; ++k) {
            for (int c = 0; c < kChannels; ++c) group_.value[k][c][lane] = 0.0f;
            group_.weight[k][lane] = 0.0f;
        }
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < kChannels; ++c) group_.ends[e][c][lane] = from.ends[part.subset][e][c];
        }
    }

    void scatter(const Part& part, int lane, int channels, bool indices) {
        Try& to = tries_[at(part.index)];
        to.error += group_.error[lane];
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < channels; ++c) to.ends[part.subset][e][c] = to_byte(group_.ends[e][c][lane]);
        }
        if (!indices) return;
        Indices& found = indices_[at(to.block)];
        int k = 0;
        for (unsigned left = part.mask; left != 0; left &= left - 1, ++k) {
            const int texel = std::countr_zero(left);
            found.line[texel] = to_byte(group_.color[k][lane]);
            found.second[texel] = to_byte(group_.scalar[k][lane]);
        }
    }
};

}  // namespace tex::inline v1
