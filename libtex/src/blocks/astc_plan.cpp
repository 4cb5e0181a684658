// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_plan.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <set>
#include <tuple>

#include "blocks/astc_endpoints.h"
#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

constexpr int header_bits(int partitions) { return partitions == 1 ? 17 : 29; }

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
    return made;
}

void add_plans(int partitions, AstcPlans& plans) {
    std::set<std::tuple<int, int, int, int>> seen;  // some modes can be written in several ways
    for (unsigned bits = 0; bits < 1u << kAstcModeBits; ++bits) {
        if ((bits & 0x1ff) == kAstcVoid) continue;
        const std::optional<AstcMode> mode = astc_mode(bits, plans.block);
        if (!mode || !seen.insert({mode->grid.width, mode->grid.height, mode->planes, mode->range}).second) continue;
        const int color_bits = 128 - header_bits(partitions) - mode->weight_bits() - (mode->planes == 2 ? 2 : 0);
        const int color_range = astc_range_within(4 * partitions, color_bits);
        if (color_range < kAstcLeastColorRange) continue;
        auto grid = std::find_if(plans.grids.begin(), plans.grids.end(),
                                 [&](const auto& made) { return made->extent == mode->grid; });
        if (grid == plans.grids.end()) {
            plans.grids.push_back(make_grid(plans.block, mode->grid));
            grid = plans.grids.end() - 1;
        }
        plans.plans.push_back({*mode, bits, partitions, color_range, grid->get(), &astc_weight_values(mode->range),
                               &astc_color_values(color_range)});
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

AstcPlans make_plans(Extent block) {
    AstcPlans plans;
    plans.block = block;
    for (int partitions = 1; partitions <= 3; ++partitions) add_plans(partitions, plans);
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

const AstcPlans& astc_plans(Extent block) {
    static std::array<std::once_flag, 81> once;
    static std::array<std::unique_ptr<const AstcPlans>, 81> made;
    const auto place = static_cast<std::size_t>(block.width * 9 + block.height);
    std::call_once(once[place], [&] { made[place] = std::make_unique<const AstcPlans>(make_plans(block)); });
    return *made[place];
}

void write_astc(const AstcPlan& plan, const AstcContent& content, std::byte* block) {
    AstcBits bits;
    bits.put(0, kAstcModeBits, plan.mode_bits);
    if (plan.partitions == 1) {
        bits.put(13, 4, kAstcLuminanceAlpha);
    } else {
        bits.put(11, 2, static_cast<unsigned>(plan.partitions - 1));
        bits.put(13, 10, content.pattern);
        bits.put(25, 4, kAstcLuminanceAlpha);
    }
    std::uint8_t values[12];
    for (int p = 0; p < plan.partitions; ++p) {
        for (int k = 0; k < 4; ++k) values[4 * p + k] = plan.colors->stored[content.ends[p][k / 2][k % 2]];
    }
    write_astc_ise(bits, header_bits(plan.partitions), plan.color_range, 4 * plan.partitions, values);

    std::uint8_t stored[kAstcMostWeights];
    const int planes = plan.mode.planes;
    for (int p = 0; p < planes; ++p) {
        for (int w = 0; w < plan.grid->weights; ++w)
            stored[planes * w + p] = plan.weights->stored[content.weights[p][w]];
    }
    AstcBits weights;
    write_astc_ise(weights, 0, plan.mode.range, planes * plan.grid->weights, stored);
    const AstcBits reversed = weights.reversed();
    if (planes == 2) bits.put(128 - plan.mode.weight_bits() - 2, 2, 3);  // alpha
    bits.low |= reversed.low;
    bits.high |= reversed.high;
    write_astc_bits(bits, block);
}

void write_astc_void(int x, int y, std::byte* block) {
    const auto low = static_cast<std::uint64_t>(x), high = static_cast<std::uint64_t>(y);
    write_astc_bits({~std::uint64_t{0x203}, low | low << 16 | low << 32 | high << 48}, block);
}

}  // namespace tex::inline v1
