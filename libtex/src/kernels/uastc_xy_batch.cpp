// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_xy_batch.h"

#include <algorithm>

#include "blocks/uastc_modes.h"
#include "kernels/uastc_xy_hints.h"

namespace tex::inline v1 {
namespace {

int most_xy_tries(const UastcXyEffort& effort) { return kUastcXyParts + effort.parts; }

std::uint8_t code_of_component(float component) {
    return static_cast<std::uint8_t>(std::clamp(127.5f * component + 128.0f, 0.0f, 255.0f));
}

}  // namespace

UastcXyEffort uastc_xy_effort(Effort effort) {
    switch (effort) {
        case Effort::fast: return {effort, 1, 1, 0, false, {2, 0}};
        case Effort::normal: return {effort, 2, 2, 4, false, {2, 2}};
        default: return {effort, kUastcXyMostParts, 6, 24, true, {3, 4}};
    }
}

UastcXyBatch::UastcXyBatch(const UastcXyEffort& effort) : BlockTries(most_xy_tries(effort)), effort_(effort) {}

std::size_t UastcXyBatch::memory(const UastcXyEffort& effort) { return memory_of(most_xy_tries(effort)); }

void UastcXyBatch::add_tries(int block, int lane) {
    Try one = {};
    one.error = kBc7None;
    one.block = static_cast<std::int16_t>(block);
    for (std::uint8_t c = 0; c < 3; ++c) one.component[c] = c;
    for (const UastcXyKindNumber kind : {kUastcXyPlanes, kUastcXyLine}) {
        one.kind = kind;
        tries_.push_back(one);
    }
    one.kind = kUastcXyParts;
    for (int k = 0; k < effort_.parts; ++k) {
        one.pattern = to_byte(guesses_.part[k][lane]);
        tries_.push_back(one);
    }
}

void UastcXyBatch::fit(const Bc7Steps& steps) {
    group_.has_alpha = false;
    for (int kind = 0; kind < kUastcXyKinds; ++kind) {
        const Bc7Kind& which = kUastcXyKindTable[kind];
        fit_kind(
            kind, which.subsets, 2, steps.indices,
            [&](unsigned pattern, int subset) { return uastc_texels(which.mode, pattern, subset); },
            [](const Try&) { return 0.0f; }, [&] { fit_uastc_xy(which, steps, group_); });
    }
}

UastcContent UastcXyBatch::content_of(const Try& found) const {
    UastcContent content;
    const float(&value)[16][3] = texels_[at(found.block)].value;
    if (std::all_of(value, value + 16, [&](const float(&v)[3]) { return std::equal(v, v + 2, value[0]); })) {
        content.mode = kUastcSolid;
        const std::uint8_t grey = code_of_component(value[0][0]);
        std::fill_n(content.ends[0][0], 3, grey);
        content.alpha = code_of_component(value[0][1]);
        content.hints = grey_hints(grey);
        return content;
    }
    content.mode = kUastcXyKindTable[found.kind].mode;
    content.pattern = found.pattern;
    content.second_channel = 1;
    for (int s = 0; s < 2; ++s) {
        for (int e = 0; e < 2; ++e) std::copy_n(found.ends[s][e], 2, content.ends[s][e]);
    }
    const Indices& indices = indices_[at(found.block)];
    std::copy_n(indices.line, 16, content.weights[0]);
    std::copy_n(indices.second, 16, content.weights[1]);
    std::uint8_t codes[3][16];
    uastc_texels(content, codes);
    find_uastc_xy_hints(effort_.effort, codes[0], codes[1], content.hints);
    return content;
}

void UastcXyBatch::encode(int count, std::byte* blocks) {
    make_unit(count);
    tries_.clear();
    for (int first = 0; first < count; first += lanes_) {
        load(first);
        guess_uastc_xy(group_, effort_.parts, guesses_);
        for (int lane = 0; lane < std::min(lanes_, count - first); ++lane) add_tries(first + lane, lane);
    }
    fit({true, 0, false, false, effort_.solves[0]});
    keep(effort_.kept);
    if (effort_.rounds > 0) {
        fit({false, effort_.rounds, effort_.pairs, false, effort_.solves[1]});
        keep(1);
    }
    fit({false, 0, false, true});
    for (const Try& found : tries_)
        write_uastc(content_of(found), blocks + std::ptrdiff_t{found.block} * kUastcBlockBytes);
}

}  // namespace tex::inline v1
