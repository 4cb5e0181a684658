// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_batch.h"

#include <algorithm>
#include <utility>

#include "blocks/bc7_modes.h"
#include "blocks/bptc.h"
#include "kernels/bc7_lines.h"
#include "kernels/bc7_planes.h"

namespace tex::inline v1 {
namespace {

// The most tries that a block has at a time.
int most_tries(const Bc7Effort& effort) { return effort.planes + effort.search.parts + 5; }

// Exchanges red and alpha of a block whose mode has both. Without a rotation, the scalar becomes red; where it stands
// for green or blue, red changes places with what is in alpha.
void exchange_red_and_alpha(Bc7Content& content) {
    const bool has_planes = kBc7Modes[content.mode].second_index != 0;
    if (has_planes && content.rotation < 2) {
        content.rotation = 1 - content.rotation;
        return;
    }
    const unsigned other = has_planes ? content.rotation - 1 : 3;
    for (auto& subset : content.ends) {
        for (auto& end : subset) std::swap(end[0], end[other]);
    }
}

}  // namespace

Bc7Effort bc7_effort(Effort effort) {
    switch (effort) {
        case Effort::fast: return {1, 1.0f, 1.5f, {2, 32, false, 0}, 1, 0, false};
        case Effort::normal: return {2, 1.5f, 1.5f, {8, 64, true, 0}, 2, 2, false};
        default: return {6, 4.0f, 4.0f, {kBc7MostParts, 64, true, 3}, 12, 12, true};
    }
}

Bc7Batch::Bc7Batch(const Bc7Effort& effort, bool exchanges)
    : BlockTries(most_tries(effort)), effort_(effort), exchanges_(exchanges) {}

std::size_t Bc7Batch::memory(const Bc7Effort& effort) { return memory_of(most_tries(effort)); }

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
        one.pattern = static_cast<std::uint8_t>(number % 64);
        one.error = has_alpha_ ? 0.0f : guesses_.part_error[k][lane];
        const Bc7Kind& kind = kBc7KindTable[one.kind];
        for (auto& subset : one.ends) {
            for (auto& end : subset) end[3] = exchanges_ ? static_cast<std::uint8_t>((1 << kind.bits) - 1) : end[3];
        }
        tries_.push_back(one);
    }
    if (!has_alpha_) return;
    for (int k = 0; k < 3; ++k) {
        one.kind = static_cast<std::uint8_t>(kBc7Apart + k);
        one.pattern = 0;
        one.error = 0.0f;
        for (int e = 0; e < 2; ++e) one.ends[0][e][3] = to_byte(guesses_.alpha_ends[k][e][lane]);
        apart_[block][k] = guesses_.alpha_error[k][lane];
        tries_.push_back(one);
    }
}

void Bc7Batch::fit(int first, int end, const Bc7Steps& steps) {
    group_.has_alpha = has_alpha_;
    for (int kind = first; kind < std::min(end, has_alpha_ ? +kBc7Kinds : +kBc7PartsAlpha); ++kind) {
        Bc7Kind which = kBc7KindTable[kind];
        if (exchanges_ && which.lowest == Bc7Lowest::own) {  // alpha, which becomes red, stays 255
            which.lowest = Bc7Lowest::ones;
            which.has_alpha = false;
        }
        const bool keeps_alpha = kind >= kBc7One && !(has_alpha_ && which.has_alpha);
        fit_kind(
            kind, which.subsets, keeps_alpha ? 3 : 4, steps.indices,
            [&](unsigned pattern, int subset) { return bptc_texels(which.subsets, pattern, subset); },
            [&](const Try& one) { return kind >= kBc7Apart ? apart_[one.block][kind - kBc7Apart] : 0.0f; },
            [&] { kind < kBc7One ? fit_bc7_planes(which, steps, group_) : fit_bc7_lines(which, steps, group_); });
    }
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
    content.partition = found.pattern;
    content.is_exchanged = kind.is_exchanged;
    const Indices& indices = indices_[at(found.block)];
    std::copy_n(indices.line, 16, content.color);
    std::copy_n(indices.second, 16, content.alpha);
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
    if (exchanges_) exchange_red_and_alpha(content);
    write_bc7(content, block);
}

void Bc7Batch::encode(int count, bool has_alpha, std::byte* const* blocks) {
    has_alpha_ = has_alpha;
    make_unit(count);
    for (int block = 0; block < count; ++block) {
        for (float(&texel)[4] : texels_[at(block)].value) texel[3] = std::min(std::max(0.0f, texel[3]), 1.0f) * 255.0f;
    }
    tries_.clear();
    group_.has_alpha = has_alpha_;
    for (int first = 0; first < count; first += lanes_) {
        load(first);
        guess_bc7(group_, effort_.search, guesses_);
        for (int lane = 0; lane < std::min(lanes_, count - first); ++lane) {
            add_guesses(first + lane, lane);
            add_lines(first + lane, lane);
        }
    }
    // Where a block has one try in two planes, which nothing improves, its indices are final, unless a line is better.
    const bool is_final = effort_.planes == 1 && effort_.rounds == 0;
    fit(kBc7Planes, kBc7One, {true, 0, false, is_final});
    drop_hopeless(kBc7One, effort_.worth);
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
