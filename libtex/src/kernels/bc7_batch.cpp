// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_batch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "blocks/bc7_modes.h"
#include "blocks/bptc.h"
#include "kernels/bc7_lines.h"
#include "kernels/bc7_planes.h"

namespace tex::inline v1 {
namespace {

constexpr unsigned kAllTexels = 0xffff;

std::size_t at(int n) { return static_cast<std::size_t>(n); }

// The most tries that a block has at a time.
int most_tries(const Bc7Effort& effort) { return effort.planes + effort.search.parts + 5; }

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(value); }

}  // namespace

Bc7Effort bc7_effort(Effort effort) {
    switch (effort) {
        case Effort::fast: return {1, 1.0f, 1.5f, {2, 32, false, 0}, 1, 0, false};
        case Effort::normal: return {2, 1.5f, 1.5f, {8, 64, true, 0}, 2, 2, false};
        default: return {6, 4.0f, 4.0f, {kBc7MostParts, 64, true, 3}, 12, 12, true};
    }
}

Bc7Batch::Bc7Batch(const Bc7Effort& effort) : effort_(effort), lanes_(bc7_lanes()) {
    const std::size_t tries = at(kMost) * at(most_tries(effort));
    texels_.resize(at(kMost + kBc7Lanes));
    tries_.reserve(tries);
    parts_.reserve(3 * tries);
    sorted_.reserve(3 * tries);
    indices_.resize(at(kMost));
}

std::size_t Bc7Batch::memory(const Bc7Effort& effort) {
    const std::size_t tries = at(kMost) * at(most_tries(effort));
    return LentMemory::taken_by(at(kMost + kBc7Lanes) * sizeof(Texels)) + LentMemory::taken_by(tries * sizeof(Try)) +
           2 * LentMemory::taken_by(3 * tries * sizeof(Part)) + LentMemory::taken_by(at(kMost) * sizeof(Indices));
}

// Makes vectors unit vectors, and alpha codes.
void Bc7Batch::prepare(int count) {
    for (int block = 0; block < count; ++block) {
        for (float(&texel)[4] : texels_[at(block)].value) {
            const float length = std::sqrt(texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2]);
            if (length > 1e-6f) {
                for (int c = 0; c < 3; ++c) texel[c] /= length;
            } else {
                texel[0] = texel[1] = 0.0f;
                texel[2] = 1.0f;
            }
            texel[3] = std::min(std::max(0.0f, texel[3]), 1.0f) * 255.0f;
        }
    }
    for (int block = count; block % lanes_ != 0; ++block) texels_[at(block)] = texels_[at(count - 1)];
}

void Bc7Batch::add_guesses(int block, int lane) {
    Try one = {};
    one.error = kBc7None;
    one.block = static_cast<std::int16_t>(block);
    const auto axis = static_cast<int>(guesses_.axis[lane]);
    const int others[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    bool used[6] = {};
    float best = 0;
    for (int n = 0; n < effort_.planes; ++n) {
        int next = -1;
        for (int k = 0; k < 6; ++k) {
            if (used[k]) continue;
            if (next < 0 || guesses_.error[k / 2][k % 2][lane] < guesses_.error[next / 2][next % 2][lane]) next = k;
        }
        const float error = guesses_.error[next / 2][next % 2][lane];
        if (n == 0) best = error;
        if (error > best * effort_.within) break;
        used[next] = true;
        one.kind = static_cast<std::uint8_t>(kBc7Planes + next / 2);
        one.component[0] = static_cast<std::uint8_t>(others[next % 2]);
        one.component[1] = static_cast<std::uint8_t>(others[1 - next % 2]);
        one.component[2] = static_cast<std::uint8_t>(axis);
        for (int c = 0; c < 2; ++c) {
            for (int e = 0; e < 2; ++e) one.ends[0][e][c] = to_byte(guesses_.ends[next / 2][next % 2][c][e][lane]);
        }
        tries_.push_back(one);
    }
}

// Adds lines, with the errors that they are guessed to have.
void Bc7Batch::add_lines(int block, int lane) {
    Try one = {};
    one.error = kBc7None;
    one.block = static_cast<std::int16_t>(block);
    for (int k = 0; k < 3; ++k) one.component[k] = static_cast<std::uint8_t>(k);
    for (int e = 0; e < 2; ++e) one.ends[0][e][3] = 255;
    one.kind = has_alpha_ ? kBc7OneAlpha : kBc7One;
    one.error = has_alpha_ ? 0.0f : guesses_.line[lane];
    tries_.push_back(one);
    for (int k = 0; k < effort_.search.parts; ++k) {
        const auto number = static_cast<int>(guesses_.part[k][lane]);
        if (number < 0) break;
        one.kind = static_cast<std::uint8_t>(number / 64);
        one.partition = static_cast<std::uint8_t>(number % 64);
        one.error = has_alpha_ ? 0.0f : guesses_.part_error[k][lane];
        tries_.push_back(one);
    }
    if (!has_alpha_) return;
    for (int k = 0; k < 3; ++k) {
        one.kind = static_cast<std::uint8_t>(kBc7Apart + k);
        one.partition = 0;
        one.error = 0.0f;
        for (int e = 0; e < 2; ++e) one.ends[0][e][3] = to_byte(guesses_.alpha_ends[k][e][lane]);
        apart_[block][k] = guesses_.alpha_error[k][lane];
        tries_.push_back(one);
    }
}

void Bc7Batch::gather(const Try& from, const Part& part, int lane) {
    const Texels& texels = texels_[at(from.block)];
    int k = 0;
    for (unsigned left = part.mask; left != 0; left &= left - 1, ++k) {
        const float* const value = texels.value[std::countr_zero(left)];
        for (int c = 0; c < 3; ++c) group_.value[k][c][lane] = value[from.component[c]];
        group_.value[k][3][lane] = value[3];
        group_.weight[k][lane] = 1.0f;
    }
    for (; k < group_.texels; ++k) {
        for (int c = 0; c < 4; ++c) group_.value[k][c][lane] = 0.0f;
        group_.weight[k][lane] = 0.0f;
    }
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < 4; ++c) group_.ends[e][c][lane] = from.ends[part.subset][e][c];
    }
}

void Bc7Batch::scatter(const Part& part, int lane, bool indices, Try& to) {
    to.error += group_.error[lane];
    const bool keeps_alpha = to.kind >= kBc7One && !(has_alpha_ && kBc7KindTable[to.kind].has_alpha);
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < (keeps_alpha ? 3 : 4); ++c) to.ends[part.subset][e][c] = to_byte(group_.ends[e][c][lane]);
    }
    if (!indices) return;
    Indices& found = indices_[at(to.block)];
    int k = 0;
    for (unsigned left = part.mask; left != 0; left &= left - 1, ++k) {
        const int texel = std::countr_zero(left);
        found.color[texel] = to_byte(group_.color[k][lane]);
        found.scalar[texel] = to_byte(group_.scalar[k][lane]);
    }
}

// Drops lines whose guesses are above the error of the block in two planes.
void Bc7Batch::drop_hopeless() {
    std::size_t kept = 0;
    float least = 0;
    for (std::size_t k = 0; k < tries_.size(); ++k) {
        const Try one = tries_[k];
        if (k == 0 || one.block != tries_[k - 1].block) least = kBc7None;  // the planes of a block come first
        if (one.kind < kBc7One) least = std::min(least, one.error);
        if (one.kind < kBc7One || one.error <= least * effort_.worth) tries_[kept++] = one;
    }
    tries_.resize(kept);
}

// Sorts parts by their numbers of texels.
void Bc7Batch::sort_parts() {
    std::size_t place[18] = {};
    for (const Part& part : parts_) ++place[part.texels + 1];
    for (int k = 1; k < 18; ++k) place[k] += place[k - 1];
    sorted_.resize(parts_.size());
    for (const Part& part : parts_) sorted_[place[part.texels]++] = part;
    parts_.swap(sorted_);
}

// Fits the tries of these kinds, kind by kind, and those of several subsets subset by subset.
void Bc7Batch::fit(int first, int end, const Bc7Steps& steps) {
    for (int kind = first; kind < std::min(end, has_alpha_ ? +kBc7Kinds : +kBc7PartsAlpha); ++kind) {
        const int subsets = kBc7KindTable[kind].subsets;
        parts_.clear();
        for (std::size_t k = 0; k < tries_.size(); ++k) {
            if (tries_[k].kind != kind) continue;
            tries_[k].error = kind >= kBc7Apart ? apart_[tries_[k].block][kind - kBc7Apart] : 0.0f;
            for (int subset = 0; subset < subsets; ++subset) {
                const unsigned texels = subsets == 1 ? kAllTexels : bptc_texels(subsets, tries_[k].partition, subset);
                parts_.push_back({static_cast<int>(k), static_cast<std::uint16_t>(texels),
                                  static_cast<std::uint8_t>(subset), static_cast<std::uint8_t>(std::popcount(texels))});
            }
        }
        if (subsets > 1) sort_parts();
        group_.has_alpha = has_alpha_;
        for (std::size_t k = 0; k < parts_.size(); k += at(lanes_)) {
            const int used = static_cast<int>(std::min(at(lanes_), parts_.size() - k));
            group_.texels = parts_[k + at(used - 1)].texels;
            for (int lane = 0; lane < lanes_; ++lane) {
                const Part& part = parts_[k + at(std::min(lane, used - 1))];
                gather(tries_[at(part.index)], part, lane);
            }
            if (kind < kBc7One)
                fit_bc7_planes(kBc7KindTable[kind], steps, group_);
            else
                fit_bc7_lines(kBc7KindTable[kind], steps, group_);
            for (int lane = 0; lane < used; ++lane) {
                const Part& part = parts_[k + at(lane)];
                scatter(part, lane, steps.indices, tries_[at(part.index)]);
            }
        }
    }
}

// Keeps the best so many tries of each block, blocks in order.
void Bc7Batch::keep(int count) {
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

// The indices of alpha in a plane of its own.
void Bc7Batch::finish_alpha(const Try& found, Bc7Content& content) const {
    const Bc7Kind& kind = kBc7KindTable[found.kind];
    const auto widened = [&](int code) {
        const int high = code << (8 - kind.scalar_bits);
        return high | high >> kind.scalar_bits;
    };
    const int e0 = widened(content.ends[0][0][3]), e1 = widened(content.ends[0][1][3]);
    for (int k = 0; k < 16; ++k) {
        float least = kBc7None;
        for (int j = 0; j < kind.scalar_levels; ++j) {
            const int weight = (2 * 64 * j + kind.scalar_levels - 1) / (2 * (kind.scalar_levels - 1));
            const float off = static_cast<float>(bptc_between(e0, e1, weight)) - texels_[at(found.block)].value[k][3];
            if (off * off >= least) continue;
            least = off * off;
            content.alpha[k] = static_cast<std::uint8_t>(j);
        }
    }
}

void Bc7Batch::write(const Try& found, std::byte* block) const {
    const Bc7Kind& kind = kBc7KindTable[found.kind];
    Bc7Content content = {};
    content.mode = kind.mode;
    content.partition = found.partition;
    content.is_exchanged = kind.is_exchanged;
    const Indices& indices = indices_[at(found.block)];
    std::copy_n(indices.color, 16, content.color);
    std::copy_n(indices.scalar, 16, content.alpha);
    for (int s = 0; s < kind.subsets; ++s) {
        for (int e = 0; e < 2; ++e) {
            const std::uint8_t* const ends = found.ends[s][e];
            if (found.kind >= kBc7One) {
                std::copy_n(ends, 4, content.ends[s][e]);
                continue;
            }
            content.ends[s][e][3] = ends[0];
            content.ends[s][e][found.component[0]] = ends[3];
            content.ends[s][e][found.component[1]] = ends[1];
            content.ends[s][e][found.component[2]] = ends[2];
        }
    }
    if (found.kind < kBc7One) content.rotation = found.component[0] + 1u;
    if (found.kind >= kBc7Apart) finish_alpha(found, content);
    write_bc7(content, block);
}

void Bc7Batch::encode(int count, bool has_alpha, std::byte* const* blocks) {
    has_alpha_ = has_alpha;
    prepare(count);
    tries_.clear();
    for (int first = 0; first < count; first += lanes_) {
        group_.texels = 16;
        group_.has_alpha = has_alpha_;
        for (int lane = 0; lane < lanes_; ++lane) {
            const Texels& texels = texels_[at(first + lane)];
            for (int k = 0; k < 16; ++k) {
                for (int c = 0; c < 4; ++c) group_.value[k][c][lane] = texels.value[k][c];
            }
        }
        guess_bc7(group_, effort_.search, guesses_);
        for (int lane = 0; lane < std::min(lanes_, count - first); ++lane) {
            add_guesses(first + lane, lane);
            add_lines(first + lane, lane);
        }
    }
    // Where a block has one try in two planes, which nothing improves, its indices are final, unless a line is better.
    const bool is_final = effort_.planes == 1 && effort_.rounds == 0;
    fit(kBc7Planes, kBc7One, {true, 0, false, is_final});
    drop_hopeless();
    fit(kBc7One, kBc7Kinds, {true, 0, false, false});
    keep(effort_.kept);
    if (effort_.rounds > 0) {
        fit(kBc7Planes, kBc7Kinds, {false, effort_.rounds, effort_.pairs, false});
        keep(1);
    }
    fit(is_final ? kBc7One : kBc7Planes, kBc7Kinds, {false, 0, false, true});
    for (int block = 0; block < count; ++block) write(tries_[at(block)], blocks[block]);
}

}  // namespace tex::inline v1
