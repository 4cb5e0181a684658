// SPDX-License-Identifier: Apache-2.0

#include "blocks/uastc_modes.h"

#include <algorithm>
#include <iterator>

#include "blocks/astc_mode.h"

namespace tex::inline v1 {
namespace {

// The partitions of ASTC that patterns stand for: those that BC7 has, too. Mode 7 has two subsets where BC7 has three.
constexpr std::uint16_t kTwoSubsetPatterns[] = {28,  20,  16,  29,  91,  9,   107, 72,  149, 204,
                                                50,  114, 496, 17,  78,  39,  252, 828, 43,  156,
                                                116, 210, 476, 273, 684, 359, 246, 195, 694, 524};
constexpr std::uint16_t kThreeSubsetPatterns[] = {260, 74, 32, 156, 183, 15, 745, 0, 335, 902, 254};
constexpr std::uint16_t kMergedPatterns[] = {36,  48,  61,  137, 161, 183, 226, 281, 302, 307,
                                             479, 495, 593, 594, 605, 799, 812, 988, 993};

UastcPattern make_pattern(int subsets, unsigned partition) {
    UastcPattern pattern;
    astc_partitions({4, 4}, subsets, partition, pattern.subset);
    for (int s = 0; s < subsets; ++s)
        pattern.anchor[s] =
            static_cast<std::uint8_t>(std::find(pattern.subset, pattern.subset + kUastcTexels, s) - pattern.subset);
    std::sort(pattern.anchor, pattern.anchor + subsets);
    for (int s = 0; s < subsets; ++s) pattern.is_anchor[pattern.anchor[s]] = true;
    for (int k = 0; k < kUastcTexels; ++k)
        pattern.texels[pattern.subset[k]] = static_cast<std::uint16_t>(pattern.texels[pattern.subset[k]] | 1u << k);
    return pattern;
}

struct UastcPatterns {
    UastcPattern one, two[std::size(kTwoSubsetPatterns)], three[std::size(kThreeSubsetPatterns)],
        merged[std::size(kMergedPatterns)];

    UastcPatterns() {
        one.is_anchor[0] = true;
        one.texels[0] = 0xffff;
        for (std::size_t k = 0; k < std::size(two); ++k) two[k] = make_pattern(2, kTwoSubsetPatterns[k]);
        for (std::size_t k = 0; k < std::size(three); ++k) three[k] = make_pattern(3, kThreeSubsetPatterns[k]);
        for (std::size_t k = 0; k < std::size(merged); ++k) merged[k] = make_pattern(2, kMergedPatterns[k]);
    }
};

const UastcPatterns& all_patterns() {
    static const UastcPatterns patterns;
    return patterns;
}

}  // namespace

unsigned uastc_patterns(int mode) {
    constexpr int kMergedMode = 7;
    const int subsets = kUastcModeTable[mode].subsets;
    if (subsets <= 1) return 1;
    if (subsets == 3) return std::size(kThreeSubsetPatterns);
    return mode == kMergedMode ? std::size(kMergedPatterns) : std::size(kTwoSubsetPatterns);
}

const UastcPattern* uastc_pattern(int mode, unsigned number) {
    constexpr int kMergedMode = 7;
    const UastcPatterns& all = all_patterns();
    const int subsets = kUastcModeTable[mode].subsets;
    if (number >= uastc_patterns(mode)) return nullptr;
    if (subsets <= 1) return &all.one;
    if (subsets == 3) return all.three + number;
    return (mode == kMergedMode ? all.merged : all.two) + number;
}

}  // namespace tex::inline v1
