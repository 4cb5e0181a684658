// SPDX-License-Identifier: Apache-2.0

#include "blocks/block_half.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "blocks/eac.h"

namespace tex::inline v1 {
namespace {

int byte_at(const std::byte* half, int k) { return std::to_integer<int>(half[k]); }

int signed_at(const std::byte* half, int k) { return std::max<int>(static_cast<std::int8_t>(half[k]), -127); }

std::uint64_t bc4_indices(const std::byte* half) {
    std::uint64_t bits = 0;
    for (int k = 7; k >= 2; --k) bits = bits << 8 | std::to_integer<std::uint64_t>(half[k]);
    return bits;
}

float from_unorm(float value) { return 2.0f * value - 1.0f; }

// A code of 6 bits, and the component that decoders make of it.
int green_code(const std::byte* color) { return (byte_at(color, 0) >> 5 | byte_at(color, 1) << 3) & 63; }
float green_value(int code) { return from_unorm(static_cast<float>(widen_green(code)) / 255.0f); }

HalfLine bc4_line(int e0, int e1, bool is_signed) {
    const float code = is_signed ? 1.0f / 127.0f : 2.0f / 255.0f;
    return {static_cast<float>(e1) * code - (is_signed ? 0.0f : 1.0f), static_cast<float>(e0 - e1) * code};
}

HalfLine eac_line(int base, int multiplier, bool is_signed) {
    const float code = is_signed ? 1.0f / 1023.0f : 2.0f / 2047.0f;
    return {is_signed ? static_cast<float>(8 * base) * code : static_cast<float>(8 * base + 4) * code - 1.0f,
            static_cast<float>(multiplier == 0 ? 1 : 8 * multiplier) * code};
}

HalfShape bc4_shape(const std::byte* half, bool is_signed) {
    const int e0 = is_signed ? signed_at(half, 0) : byte_at(half, 0);
    const int e1 = is_signed ? signed_at(half, 1) : byte_at(half, 1);
    HalfShape shape;
    shape.line = bc4_line(e0, e1, is_signed);
    shape.is_line = true;
    constexpr float kWeights[8] = {1.0f,        0.0f,        6.0f / 7.0f, 5.0f / 7.0f,
                                   4.0f / 7.0f, 3.0f / 7.0f, 2.0f / 7.0f, 1.0f / 7.0f};
    const std::uint64_t bits = bc4_indices(half);
    for (int k = 0; k < 16; ++k) {
        const std::uint64_t index = bits >> (3 * k) & 7;
        shape.weights[k] = kWeights[index];
        if (e0 <= e1 && index > 1) shape.is_line = false;
    }
    return shape;
}

HalfShape green_shape(const std::byte* half) {
    constexpr float kWeights[4] = {1.0f, 0.0f, 2.0f / 3.0f, 1.0f / 3.0f};
    HalfShape shape;
    shape.line.offset = green_value(green_code(half + 2));
    shape.line.slope = green_value(green_code(half)) - shape.line.offset;
    shape.is_line = true;
    for (int k = 0; k < 16; ++k) shape.weights[k] = kWeights[byte_at(half, 4 + k / 4) >> (2 * (k % 4)) & 3];
    return shape;
}

HalfShape eac_shape(const std::byte* half, bool is_signed) {
    const int multiplier = byte_at(half, 1) >> 4;
    const int table = byte_at(half, 1) & 15;
    HalfShape shape;
    shape.line = eac_line(is_signed ? signed_at(half, 0) : byte_at(half, 0), multiplier, is_signed);
    shape.is_line = true;
    std::uint64_t bits = 0;
    for (int k = 2; k < 8; ++k) bits = bits << 8 | std::to_integer<std::uint64_t>(half[k]);
    for (int k = 0; k < 16; ++k) {
        const int selector = static_cast<int>(bits >> (45 - 3 * (4 * (k % 4) + k / 4)) & 7);
        shape.weights[k] = static_cast<float>(kEacModifiers[table][selector]);
    }
    return shape;
}

int nearest_code(float value, float low, float high) {
    return static_cast<int>(std::floor(std::min(std::max(value, low), high) + 0.5f));
}

// Collects variants of a source half.
struct Variants {
    const std::byte* source;
    HalfVariant* out;
    int count = 0;

    std::byte* add(HalfLine line) {
        std::memcpy(out[count].half, source, kHalfBytes);
        out[count].line = line;
        return out[count++].half;
    }
};

void bc4_variants(Variants& to, Copied copied, bool is_signed, HalfLine line) {
    const float scale = is_signed ? 127.0f : 127.5f;
    const float zero = is_signed ? 0.0f : 127.5f;
    const int low = is_signed ? -127 : 0;
    const int high = is_signed ? 127 : 255;
    const auto code = [&](float value) {
        return nearest_code(value * scale + zero, static_cast<float>(low), static_cast<float>(high));
    };
    const bool is_free = copied == Copied::indices;
    const int kept = is_signed ? signed_at(to.source, 1) : byte_at(to.source, 1);
    const int e0 = code(line.offset + line.slope);
    const int e1 = is_free ? code(line.offset) : kept;
    const int reach = is_free ? 1 : 0;
    for (int first = std::max(e0 - 1, low); first <= std::min(e0 + 1, high); ++first) {
        for (int second = std::max(e1 - reach, low); second <= e1 + reach && second < first; ++second) {
            std::byte* half = to.add(bc4_line(first, second, is_signed));
            half[0] = static_cast<std::byte>(first);
            if (is_free) half[1] = static_cast<std::byte>(second);
        }
    }
}

void green_variants(Variants& to, Copied copied, HalfLine line) {
    const auto code = [](float value) { return nearest_code((value + 1.0f) * 31.5f, 0.0f, 63.0f); };
    const auto put = [](std::byte* color, int green) {
        const int word = 31 << 11 | green << 5 | 31;
        color[0] = static_cast<std::byte>(word);
        color[1] = static_cast<std::byte>(word >> 8);
    };
    const bool is_free = copied == Copied::indices;
    const int c0 = code(line.offset + line.slope);
    const int c1 = is_free ? code(line.offset) : green_code(to.source + 2);
    const int reach = is_free ? 1 : 0;
    for (int first = std::max(c0 - 1, 0); first <= std::min(c0 + 1, 63); ++first) {
        for (int second = std::max(c1 - reach, 0); second <= c1 + reach && second <= first; ++second) {
            const float offset = green_value(second);
            std::byte* half = to.add({offset, green_value(first) - offset});
            put(half, first);
            if (is_free) put(half + 2, second);
        }
    }
}

void eac_variants(Variants& to, Copied copied, bool is_signed, HalfLine line) {
    const float scale = is_signed ? 1023.0f / 8.0f : 2047.0f / 16.0f;
    const int low = is_signed ? -127 : 0;
    const int high = is_signed ? 127 : 255;
    const float middle = is_signed ? line.offset * scale : (line.offset + 1.0f) * scale - 0.5f;
    const int base = nearest_code(middle, static_cast<float>(low), static_cast<float>(high));
    const int kept = byte_at(to.source, 1);
    const bool is_free = copied == Copied::indices;
    const int multiplier = is_free ? nearest_code(line.slope * scale, 0.0f, 15.0f) : kept >> 4;
    const int reach = is_free ? 1 : 0;
    for (int first = std::max(base - 1, low); first <= std::min(base + 1, high); ++first) {
        for (int second = std::max(multiplier - reach, 0); second <= std::min(multiplier + reach, 15); ++second) {
            std::byte* half = to.add(eac_line(first, second, is_signed));
            half[0] = static_cast<std::byte>(first);
            half[1] = static_cast<std::byte>(second << 4 | (kept & 15));
        }
    }
}

}  // namespace

void decode_half(HalfKind kind, const std::byte* half, float values[16]) {
    float r[16], b[16], a[16];
    switch (kind) {
        case HalfKind::bc4_snorm: return decode_bc4_snorm(half, values);
        case HalfKind::eac_snorm: return decode_eac_snorm(half, values);
        case HalfKind::bc4_unorm: decode_bc4_unorm(half, values); break;
        case HalfKind::eac_unorm: decode_eac_unorm(half, values); break;
        case HalfKind::green: decode_bc1(half, Bc1Mode::four_colors, r, values, b, a); break;
    }
    for (int k = 0; k < 16; ++k) values[k] = from_unorm(values[k]);
}

HalfShape half_shape(HalfKind kind, const std::byte* half) {
    switch (kind) {
        case HalfKind::bc4_unorm: return bc4_shape(half, false);
        case HalfKind::bc4_snorm: return bc4_shape(half, true);
        case HalfKind::green: return green_shape(half);
        case HalfKind::eac_unorm: return eac_shape(half, false);
        default: return eac_shape(half, true);
    }
}

int literals_before(HalfKind kind, Copied copied) {
    const int all = kind == HalfKind::green ? 4 : 2;
    return copied == Copied::indices ? all : copied == Copied::all_but_first ? all / 2 : 0;
}

HalfFit::HalfFit(const HalfShape& shape, const float values[16]) : own_(shape.line) {
    for (int k = 0; k < 16; ++k) {
        w_ += shape.weights[k];
        ww_ += shape.weights[k] * shape.weights[k];
        v_ += values[k];
        vv_ += values[k] * values[k];
        wv_ += shape.weights[k] * values[k];
    }
}

HalfLine HalfFit::line(HalfKind kind, Copied copied) const {
    constexpr float kLeast = 1e-3f;  // weights that differ less are all equal
    if (copied == Copied::all_but_first && !keeps_slope(kind))
        return {own_.offset, ww_ > kLeast ? std::max(0.0f, (wv_ - own_.offset * w_) / ww_) : 0.0f};
    float slope = own_.slope;
    if (copied == Copied::indices) {
        const float variance = 16.0f * ww_ - w_ * w_;
        slope = variance > kLeast ? std::max(0.0f, (16.0f * wv_ - w_ * v_) / variance) : 0.0f;
    }
    return {(v_ - slope * w_) / 16.0f, slope};
}

float HalfFit::squared_error(HalfLine line) const {
    const float flat = vv_ - line.offset * (2.0f * v_ - 16.0f * line.offset);
    const float sloped = line.slope * (2.0f * (wv_ - line.offset * w_) - line.slope * ww_);
    return std::max(0.0f, flat - sloped);
}

int half_variants(HalfKind kind, const std::byte* source, Copied copied, HalfLine line,
                  HalfVariant variants[kMostVariants]) {
    Variants to{source, variants};
    switch (kind) {
        case HalfKind::bc4_unorm: bc4_variants(to, copied, false, line); break;
        case HalfKind::bc4_snorm: bc4_variants(to, copied, true, line); break;
        case HalfKind::green: green_variants(to, copied, line); break;
        case HalfKind::eac_unorm: eac_variants(to, copied, false, line); break;
        case HalfKind::eac_snorm: eac_variants(to, copied, true, line); break;
    }
    return to.count;
}

}  // namespace tex::inline v1
