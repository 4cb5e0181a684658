// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_batch.h"

#include <algorithm>

#include "blocks/uastc_modes.h"
#include "kernels/uastc_kinds.h"
#include "kernels/uastc_solid.h"

namespace tex::inline v1 {
namespace {

// The most tries that a block has at a time.
int most_tries(const UastcEffort& effort) { return effort.planes + effort.search.parts + 3; }

}  // namespace

UastcEffort uastc_effort(Effort effort) {
    switch (effort) {
        case Effort::fast: return {effort, 1, 1.0f, {2, 30, false, 0}, 1, 0, false, {2, 0}, 1};
        case Effort::normal: return {effort, 2, 1.5f, {3, 30, true, 0}, 2, 2, false, {3, 3}, 2};
        default: return {effort, 2, 4.0f, {kUastcMostParts, 30, true, 3}, 10, 12, true, {3, 6}, 3};
    }
}

UastcBatch::UastcBatch(const UastcEffort& effort) : BlockTries(most_tries(effort)), effort_(effort) {
    ranked_.reserve(at(kMost * effort.finals));
    chosen_.resize(at(kMost));
}

std::size_t UastcBatch::memory(const UastcEffort& effort) {
    return memory_of(most_tries(effort)) + LentMemory::taken_by(at(kMost * effort.finals) * sizeof(Try)) +
           LentMemory::taken_by(at(kMost) * sizeof(Chosen));
}

// Adds what seems worth a fit; lines with the errors that they are guessed to have.
void UastcBatch::add_tries(int block, int lane) {
    Try one = {};
    one.error = kBc7None;
    one.block = static_cast<std::int16_t>(block);
    one.kind = kUastcPlanes;
    const auto axis = static_cast<int>(guesses_.axis[lane]);
    const int others[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    for (int n = 0; n < effort_.planes; ++n) {
        one.component[0] = static_cast<std::uint8_t>(others[n]);
        one.component[1] = static_cast<std::uint8_t>(others[1 - n]);
        one.component[2] = static_cast<std::uint8_t>(axis);
        for (int e = 0; e < 2; ++e) {
            one.ends[0][e][0] = to_byte(guesses_.ends[n][e][lane]);
            one.ends[0][e][1] = to_byte(guesses_.ends[1 - n][e][lane]);
        }
        tries_.push_back(one);
    }
    for (int k = 0; k < 3; ++k) {
        one.component[k] = static_cast<std::uint8_t>(k);
        for (auto& end : one.ends[0]) end[k] = 0;
    }
    for (int k = kUastcOne; k < kUastcParts; ++k) {
        one.kind = static_cast<std::uint8_t>(k);
        one.error = guesses_.line[k - kUastcOne][lane];
        tries_.push_back(one);
    }
    for (int k = 0; k < effort_.search.parts; ++k) {
        const auto number = static_cast<int>(guesses_.part[k][lane]);
        if (number < 0) break;
        one.kind = static_cast<std::uint8_t>(number / 64);
        one.pattern = static_cast<std::uint8_t>(number % 64);
        one.error = guesses_.part_error[k][lane];
        tries_.push_back(one);
    }
}

void UastcBatch::fit(int first, int end, const Bc7Steps& steps) {
    group_.has_alpha = false;
    for (int kind = first; kind < end; ++kind) {
        const Bc7Kind& which = kUastcKindTable[kind];
        fit_kind(
            kind, which.subsets, 3, steps.indices,
            [&](unsigned pattern, int subset) { return uastc_texels(which.mode, pattern, subset); },
            [](const Try&) { return 0.0f; },
            [&] { kind < kUastcOne ? fit_uastc_planes(which, steps, group_) : fit_uastc_lines(which, steps, group_); });
    }
}

UastcContent UastcBatch::content_of(const Try& found) const {
    UastcContent content;
    content.mode = kUastcKindTable[found.kind].mode;
    content.pattern = found.pattern;
    content.second_channel = found.component[0];
    for (int s = 0; s < 3; ++s) {
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 3; ++c) content.ends[s][e][found.component[c]] = found.ends[s][e][c];
        }
    }
    const Indices& indices = indices_[at(found.block)];
    std::copy_n(indices.line, 16, content.weights[0]);
    std::copy_n(indices.second, 16, content.weights[1]);
    return content;
}

// Blocks of one direction are stored as one colour.
bool UastcBatch::write_solid(int block, std::byte* to) {
    const float(&value)[16][3] = texels_[at(block)].value;
    for (const float(&texel)[3] : value) {
        if (!std::equal(texel, texel + 3, value[0])) return false;
    }
    write_uastc(uastc_solid(value[0]), to);
    return true;
}

// What BC1 may take from a block.
void UastcBatch::gather_ends(const UastcContent& content, int lane) {
    const UastcMode& mode = kUastcModeTable[content.mode];
    hints_.is_one[lane] = mode.subsets == 1 ? 1.0f : 0.0f;
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < 3; ++c) hints_.end[e][c][lane] = uastc_code(mode.color_range, content.ends[0][e][c]);
    }
    // So many weights at either end are the first and the last step: 6 of 32, 1 of 4.
    constexpr int kFirst[6] = {0, 0, 1, 2, 3, 6};
    const int levels = 1 << mode.weight_bits, first = kFirst[mode.weight_bits];
    for (int k = 0; k < kUastcTexels; ++k) {
        const int weight = content.weights[0][k];
        const int steps =
            (weight >= first ? 1 : 0) + (2 * weight >= levels ? 1 : 0) + (weight >= levels - first ? 1 : 0);
        hints_.step[k][lane] = static_cast<float>(steps);
    }
}

// What a try holds, and in this lane what transcoders start from.
UastcContent UastcBatch::gather(const Try& found, int lane) {
    const UastcContent content = content_of(found);
    std::uint8_t codes[3][16];
    uastc_texels(content, codes);
    gather_ends(content, lane);
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) {
            hints_.value[k][c][lane] = texels_[at(found.block)].value[k][c];
            hints_.code[k][c][lane] = codes[c][k];
        }
    }
    return content;
}

// Takes, of the improved tries of each block, that whose error is least with a little of that as BC1, and its indices.
void UastcBatch::choose(int count) {
    constexpr float kAsBc1 = 0.05f, kWorse = 1.3f;  // no try whose own error is so many times the least one
    ranked_.clear();
    for (const Try& found : tries_) ranked_.push_back(found);
    for (int block = 0; block < count; ++block) chosen_[at(block)].cost = kBc7None;
    for (int rank = 0; rank < effort_.finals; ++rank) {
        tries_.clear();
        int block = -1, its_rank = 0;
        for (const Try& found : ranked_) {
            its_rank = found.block == block ? its_rank + 1 : 0;
            block = found.block;
            float& first = chosen_[at(block)].first;
            if (its_rank == 0) first = found.error;
            if (its_rank == rank && found.error <= kWorse * first) tries_.push_back(found);
        }
        fit(kUastcPlanes, kUastcKinds, {false, 0, false, true});
        const auto tried = static_cast<int>(tries_.size());
        for (int n = 0; n < tried; n += lanes_) {
            for (int lane = 0; lane < lanes_; ++lane) gather(tries_[at(std::min(n + lane, tried - 1))], lane);
            find_bc1_hints(hints_);
            for (int lane = 0; lane < std::min(lanes_, tried - n); ++lane) {
                const Try& found = tries_[at(n + lane)];
                Chosen& chosen = chosen_[at(found.block)];
                const float cost = found.error + kAsBc1 * 2.0f * (16.0f - hints_.bc1_cosines[lane]);
                if (cost < chosen.cost) chosen = {found, indices_[at(found.block)], chosen.first, cost};
            }
        }
    }
    tries_.clear();
    for (int block = 0; block < count; ++block) {
        tries_.push_back(chosen_[at(block)].found);
        indices_[at(block)] = chosen_[at(block)].indices;
    }
}

// Finds hints for what decoders make of each block, and writes it.
void UastcBatch::write(int count, std::byte* blocks) {
    for (int first = 0; first < count; first += lanes_) {
        UastcContent contents[kBc7Lanes];
        for (int lane = 0; lane < lanes_; ++lane)
            contents[lane] = gather(tries_[at(std::min(first + lane, count - 1))], lane);
        find_etc1_hints(effort_.effort, hints_);
        find_bc1_hints(hints_);
        for (int lane = 0; lane < std::min(lanes_, count - first); ++lane) {
            std::byte* const to = blocks + std::ptrdiff_t{first + lane} * kUastcBlockBytes;
            if (write_solid(first + lane, to)) continue;
            UastcHints& hints = contents[lane].hints;
            hints.flip = hints_.flip[lane] > 0;
            hints.diff = hints_.diff[lane] > 0;
            for (int half = 0; half < 2; ++half) hints.table[half] = to_byte(hints_.table[half][lane]);
            hints.bias = to_byte(hints_.bias[lane]);
            hints.bc1_ends = hints_.bc1[lane] > 1.5f;
            hints.bc1_weights = hints_.bc1[lane] > 0.5f && !hints.bc1_ends;
            write_uastc(contents[lane], to);
        }
    }
}

void UastcBatch::encode(int count, std::byte* blocks) {
    make_unit(count);
    tries_.clear();
    for (int first = 0; first < count; first += lanes_) {
        load(first);
        guess_uastc(group_, effort_.search, guesses_);
        for (int lane = 0; lane < std::min(lanes_, count - first); ++lane) add_tries(first + lane, lane);
    }
    // Where a block has one try in two planes, which nothing improves, its indices are final, unless a line is better.
    const bool is_final = effort_.planes == 1 && effort_.rounds == 0;
    fit(kUastcPlanes, kUastcOne, {true, 0, false, is_final, effort_.solves[0]});
    drop_hopeless(kUastcOne, effort_.worth);
    fit(kUastcOne, kUastcKinds, {true, 0, false, false});
    keep(effort_.kept);
    if (effort_.rounds > 0) {
        fit(kUastcPlanes, kUastcKinds, {false, effort_.rounds, effort_.pairs, false, effort_.solves[1]});
        keep(effort_.finals);
    }
    if (effort_.finals > 1)
        choose(count);
    else
        fit(is_final ? kUastcOne : kUastcPlanes, kUastcKinds, {false, 0, false, true});
    write(count, blocks);
}

}  // namespace tex::inline v1
