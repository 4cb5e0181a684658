// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_plan.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>

#include "blocks/astc_endpoints.h"
#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

constexpr int header_bits(int partitions) { return partitions == 1 ? 17 : 29; }

// Partitions with their own modes of endpoints have as many more bits, below those of the weights.
constexpr int mixed_bits(int partitions) { return 3 * partitions - 4; }

// `meanings` are values from 0 to `top`. `nearest` gets the nearest value (the lower one of two) to each multiple of
// top / steps.
AstcValues values_of(const std::uint8_t* meanings, int levels, int top, int steps) {
    AstcValues values{};
    bool is_value[256] = {};
    for (int v = 0; v < levels; ++v) {
        is_value[meanings[v]] = true;
        values.stored[meanings[v]] = static_cast<std::uint8_t>(v);
    }
    int below[256], above[256];  // the value at or below, at or above
    for (int k = 0, last = 0; k <= top; ++k) below[k] = last = is_value[k] ? k : last;
    for (int k = top, last = top; k >= 0; --k) above[k] = last = is_value[k] ? k : last;
    for (int k = 0; k <= steps; ++k) {
        const int down = below[k * top / steps], up = above[(k * top + steps - 1) / steps];
        values.nearest[k] = static_cast<float>(k * top - down * steps <= up * steps - k * top ? down : up);
    }
    for (int k = 0; k <= top; ++k) {
        values.lower[k] = static_cast<float>(k == 0 ? 0 : below[k - 1]);
        values.upper[k] = static_cast<float>(k == top ? top : above[k + 1]);
    }
    return values;
}

// `is_there` says which of `count` numbers there are. Gets the nearest one (the lower one of two), the next lower and
// the next higher one, or the same at the ends.
void fill_nearest(const bool* is_there, int count, float* nearest, float* lower, float* upper) {
    for (int k = 0; k < count; ++k) {
        int down = k, up = k, below = k - 1, above = k + 1;
        while (down >= 0 && !is_there[down]) --down;
        while (up < count && !is_there[up]) ++up;
        while (below >= 0 && !is_there[below]) --below;
        while (above < count && !is_there[above]) ++above;
        nearest[k] = static_cast<float>(down < 0 || (up < count && up - k < k - down) ? up : down);
        lower[k] = below >= 0 ? static_cast<float>(below) : nearest[k];
        upper[k] = above < count ? static_cast<float>(above) : nearest[k];
    }
}

AstcOffsets offsets_of(const std::uint8_t* meanings, int levels) {
    AstcOffsets made{};
    bool is_base[256] = {}, is_offset[128] = {};
    std::fill(std::begin(made.stored_offset), std::end(made.stored_offset), std::int16_t{-1});
    for (int v = 0; v < levels; ++v) {
        const int value = meanings[v], base = value >> 1, six = value >> 1 & 0x3f;
        is_base[base] = is_base[base + 128] = true;
        made.stored_base[base] = static_cast<std::uint8_t>(v);
        const int place = AstcOffsets::place(value & 0x80, six >= 32 ? six - 64 : six);
        is_offset[place] = true;
        made.stored_offset[place] = static_cast<std::int16_t>(v);
    }
    fill_nearest(is_base, 256, made.nearest, made.lower, made.upper);
    for (int half = 0; half < 128; half += 64) {
        float* const tables[] = {made.nearest_offset + half, made.lower_offset + half, made.upper_offset + half};
        fill_nearest(is_offset + half, 64, tables[0], tables[1], tables[2]);
        for (float* table : tables) {
            for (int k = 0; k < 64; ++k) table[k] -= 32.0f;
        }
        for (int k = half + 1; k < half + 64; ++k) {
            if (!is_offset[k]) made.stored_offset[k] = made.stored_offset[k - 1];
        }
    }
    return made;
}

std::unique_ptr<AstcGrid> make_grid(Extent block, Extent extent) {
    auto made = std::make_unique<AstcGrid>();
    AstcGrid& grid = *made;
    grid.extent = extent;
    grid.texels = block.width * block.height;
    grid.weights = extent.width * extent.height;
    grid.is_full = extent == block;
    float of_weight[kAstcMostWeights][kAstcMostPlanned] = {};
    for (int k = 0; k < grid.texels; ++k) {
        const AstcInfill across = astc_infill(k % block.width, block.width, extent.width);
        const AstcInfill down = astc_infill(k / block.width, block.height, extent.height);
        const AstcShares shares = astc_shares(across.part, down.part);
        for (int s = 0; s < 4; ++s) {
            const int weight = (down.first + s / 2) * extent.width + across.first + s % 2;
            grid.around[k][s] = shares.share[s] == 0 ? 0 : weight;
            grid.infill[k][s] = static_cast<float>(shares.share[s]);
            if (shares.share[s] != 0) of_weight[weight][k] = static_cast<float>(shares.share[s]) / 16.0f;
        }
    }
    int next = 0;
    for (int w = 0; w < grid.weights; ++w) {
        grid.begin[w] = next;
        float sum = 0, squares = 0;
        for (int k = 0; k < grid.texels; ++k) {
            const float share = of_weight[w][k];
            if (share == 0) continue;
            grid.shares[next++] = {k, share};
            sum += share;
            squares += share * share;
        }
        grid.over_sum[w] = 1.0f / sum;
        grid.over_squares[w] = 1.0f / squares;
    }
    grid.begin[grid.weights] = next;
    int placed = 0;
    for (const int first : {0, 3, 1, 2}) {
        for (int j = first / 2; j < extent.height; j += 2) {
            for (int i = first % 2; i < extent.width; i += 2) grid.order[placed++] = j * extent.width + i;
        }
    }
    return made;
}

int color_bits(int partitions, const AstcMode& mode) {
    return 128 - header_bits(partitions) - mode.weight_bits() - (mode.planes == 2 ? 2 : 0);
}

void add_plans(int partitions, AstcPlans& plans) {
    std::set<std::tuple<int, int, int, int>> seen;  // some modes can be written in several ways
    for (unsigned bits = 0; bits < 1u << kAstcModeBits; ++bits) {
        if ((bits & 0x1ff) == kAstcVoid) continue;
        const std::optional<AstcMode> mode = astc_mode(bits, plans.block);
        if (!mode || mode->planes > plans.channels) continue;
        if (!seen.insert({mode->grid.width, mode->grid.height, mode->planes, mode->range}).second) continue;
        const int color_range = astc_range_within(2 * plans.channels * partitions, color_bits(partitions, *mode));
        if (color_range < kAstcLeastColorRange) continue;
        auto grid = std::find_if(plans.grids.begin(), plans.grids.end(),
                                 [&](const auto& made) { return made->extent == mode->grid; });
        if (grid == plans.grids.end()) {
            plans.grids.push_back(make_grid(plans.block, mode->grid));
            grid = plans.grids.end() - 1;
        }
        plans.plans.push_back({*mode, bits, partitions, plans.channels, color_range, grid->get(),
                               &astc_weight_values(mode->range), &astc_color_values(color_range),
                               &astc_color_offsets(color_range)});
    }
}

void add_mixed_plans(AstcPlans& plans) {
    const std::size_t count = plans.plans.size();
    for (std::size_t k = 0; k < count; ++k) {
        AstcPlan plan = plans.plans[k];
        if (plan.partitions == 1) continue;
        const int color_range = astc_range_within(4 * plan.partitions,
                                                  color_bits(plan.partitions, plan.mode) - mixed_bits(plan.partitions));
        if (color_range < kAstcLeastColorRange) continue;
        plans.plans[k].mixed = static_cast<int>(plans.plans.size());
        plan.is_mixed = true;
        plan.color_range = color_range;
        plan.colors = &astc_color_values(color_range);
        plan.offsets = &astc_color_offsets(color_range);
        plans.plans.push_back(plan);
    }
}

void add_patterns(int partitions, AstcPlans& plans) {
    const int texels = plans.block.width * plans.block.height;
    std::set<std::array<std::uint64_t, 2>> seen;
    for (unsigned index = 0; index < 1024; ++index) {
        std::uint8_t of_texels[kAstcMostTexels];
        astc_partitions(plans.block, partitions, index, of_texels);
        std::uint64_t parts[3] = {};
        int order[3], used = 0;  // partitions in the order of their first texels
        for (int k = 0; k < texels; ++k) {
            const int p = of_texels[k];
            if (parts[p] == 0) order[used++] = p;
            parts[p] |= std::uint64_t{1} << k;
        }
        if (used < partitions) continue;
        if (seen.insert({parts[order[1]], partitions == 3 ? parts[order[2]] : 0}).second)
            plans.patterns[partitions - 2].push_back({index, {parts[1], parts[2]}});
    }
}

AstcPlans make_plans(Extent block, int channels) {
    AstcPlans plans;
    plans.block = block;
    plans.channels = channels;
    for (int partitions = 1; partitions <= 3; ++partitions) add_plans(partitions, plans);
    if (channels == 2) add_mixed_plans(plans);
    for (int partitions = 2; partitions <= 3; ++partitions) add_patterns(partitions, plans);
    return plans;
}

}  // namespace

const AstcValues& astc_weight_values(int range) {
    static const auto kValues = [] {
        std::array<AstcValues, kAstcWeightRanges> all;
        for (int r = 0; r < kAstcWeightRanges; ++r)
            all[static_cast<std::size_t>(r)] = values_of(kAstcMeanings.weight[r], kAstcRangeTable[r].levels, 64, 128);
        return all;
    }();
    return kValues[static_cast<std::size_t>(range)];
}

const AstcValues& astc_color_values(int range) {
    static const auto kValues = [] {
        std::array<AstcValues, kAstcRanges> all;
        for (int r = kAstcLeastColorRange; r < kAstcRanges; ++r)
            all[static_cast<std::size_t>(r)] = values_of(kAstcMeanings.color[r], kAstcRangeTable[r].levels, 255, 255);
        return all;
    }();
    return kValues[static_cast<std::size_t>(range)];
}

const AstcOffsets& astc_color_offsets(int range) {
    static const auto kOffsets = [] {
        std::array<AstcOffsets, kAstcRanges> all;
        for (int r = kAstcLeastColorRange; r < kAstcRanges; ++r)
            all[static_cast<std::size_t>(r)] = offsets_of(kAstcMeanings.color[r], kAstcRangeTable[r].levels);
        return all;
    }();
    return kOffsets[static_cast<std::size_t>(range)];
}

const AstcPlans& astc_plans(Extent block, int channels) {
    static std::array<std::atomic<const AstcPlans*>, 2 * 81> made;
    static std::array<std::unique_ptr<const AstcPlans>, 2 * 81> kept;
    static std::mutex mutex;
    const auto place = static_cast<std::size_t>(81 * (channels - 1) + block.width * 9 + block.height);
    if (const AstcPlans* const plans = made[place].load(std::memory_order_acquire)) return *plans;
    const std::lock_guard lock(mutex);  // not std::call_once: see guide_of() in encode_astc.cpp
    if (!kept[place]) {
        kept[place] = std::make_unique<const AstcPlans>(make_plans(block, channels));
        made[place].store(kept[place].get(), std::memory_order_release);
    }
    return *kept[place];
}

namespace {

// The values that store the endpoints of a channel.
void store_ends(const AstcPlan& plan, const std::uint8_t ends[2], bool is_offset, std::uint8_t* values) {
    if (!is_offset) {
        for (int e = 0; e < 2; ++e) values[e] = plan.colors->stored[ends[e]];
        return;
    }
    const AstcOffsets& offsets = *plan.offsets;
    const int base = ends[0], offset = ends[1] == 255 ? 31 : ends[1] - base;  // decoders limit the sum
    values[0] = offsets.stored_base[base & 0x7f];
    values[1] = static_cast<std::uint8_t>(offsets.stored_offset[AstcOffsets::place(base, offset)]);
}

void put_header(const AstcPlan& plan, const AstcContent& content, AstcBits& bits) {
    const auto mode_of = [&](int p) {
        if (plan.channels == 1) return kAstcLuminance;
        return (content.offsets >> p & 1) != 0 ? kAstcLuminanceAlphaOffset : kAstcLuminanceAlpha;
    };
    bits.put(0, kAstcModeBits, plan.mode_bits);
    if (plan.partitions == 1) return bits.put(13, 4, static_cast<unsigned>(mode_of(0)));
    bits.put(11, 2, static_cast<unsigned>(plan.partitions - 1));
    bits.put(13, 10, content.pattern);
    if (!plan.is_mixed) return bits.put(25, 4, static_cast<unsigned>(mode_of(0)));
    // Two bits say that all modes are at least 4, a bit for each says that it is below 8, and two are the rest of it.
    unsigned modes = 2;
    for (int p = 0; p < plan.partitions; ++p)
        modes |= static_cast<unsigned>(mode_of(p) - 4) << (2 + plan.partitions + 2 * p);
    const int more = mixed_bits(plan.partitions);
    bits.put(23, 6, modes & 0x3f);
    bits.put(128 - plan.mode.weight_bits() - more, more, modes >> 6);
}

}  // namespace

void write_astc(const AstcPlan& plan, const AstcContent& content, std::byte* block) {
    AstcBits bits;
    put_header(plan, content, bits);
    std::uint8_t values[12] = {};
    for (int p = 0; p < plan.partitions; ++p) {
        for (int c = 0; c < plan.channels; ++c) {
            store_ends(plan, content.ends[p][c], (content.offsets >> p & 1) != 0, values + 2 * (plan.channels * p + c));
        }
    }
    const int count = 2 * plan.channels * plan.partitions;
    write_astc_ise(bits, header_bits(plan.partitions), plan.color_range, count, values);

    std::uint8_t stored[kAstcMostWeights] = {};
    const int planes = plan.mode.planes;
    for (int p = 0; p < planes; ++p) {
        for (int w = 0; w < plan.grid->weights; ++w)
            stored[planes * w + p] = plan.weights->stored[content.weights[p][w]];
    }
    AstcBits weights;
    write_astc_ise(weights, 0, plan.mode.range, planes * plan.grid->weights, stored);
    const AstcBits reversed = weights.reversed();
    if (planes == 2) {
        const int modes = plan.is_mixed ? mixed_bits(plan.partitions) : 0;
        bits.put(128 - plan.mode.weight_bits() - modes - 2, 2, 3);  // alpha
    }
    bits.low |= reversed.low;
    bits.high |= reversed.high;
    write_astc_bits(bits, block);
}

}  // namespace tex::inline v1
