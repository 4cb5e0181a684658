// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <half.h>

#include "decoders.h"

namespace tex::reader {
namespace {

constexpr double kGreatest = std::numeric_limits<float>::max();

// A floating-point number of 24 bits: sign, 7 bits of exponent, 16 bits of fraction.
float float_of_24(std::uint32_t code) {
    const std::uint32_t sign = code >> 23 & 1, exponent = code >> 16 & 0x7f, fraction = code & 0xffff;
    if (exponent == 0) {
        const float value = std::ldexp(static_cast<float>(fraction), -62 - 16);
        return sign != 0 ? -value : value;
    }
    const std::uint32_t wide = exponent == 0x7f ? 0xff : exponent + 127 - 63;
    const std::uint32_t bits = sign << 31 | wide << 23 | fraction << 7;
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

// What store() of libtex makes of integers that fit: codes over the largest code, and at least -1.
float unit_of(std::uint64_t code, const Samples& samples) {
    if (samples.format == 2) {
        const int unused = 64 - samples.bits;
        const auto value = static_cast<std::int64_t>(code << unused) >> unused;
        const double top = std::ldexp(1.0, samples.bits - 1) - 1.0;
        return static_cast<float>(std::max(static_cast<double>(value) / std::max(top, 1.0), -1.0));
    }
    return static_cast<float>(static_cast<double>(code) / (std::ldexp(1.0, samples.bits) - 1.0));
}

float float_of(std::uint64_t code, const Samples& samples) {
    if (samples.format != 3) return unit_of(code, samples);
    if (samples.bits == 24) return float_of_24(static_cast<std::uint32_t>(code));
    double value = 0;
    std::memcpy(&value, &code, sizeof value);
    return static_cast<float>(value);
}

void put_sample(std::uint64_t code, const Samples& samples, std::byte* to) {
    const std::size_t bytes = reader_type_bytes(samples.type);
    if (samples.is_inverted) code = ~code & ~std::uint64_t{0} >> (64 - samples.bits);
    if (samples.type == ReaderType::f32 && !(samples.format == 3 && samples.bits == 32)) {
        const float value = float_of(code, samples);
        std::memcpy(to, &value, sizeof value);
        return;
    }
    code <<= 8 * bytes - static_cast<std::size_t>(samples.bits);
    const auto as = [&](auto value) { std::memcpy(to, &value, sizeof value); };
    if (bytes == 1) as(static_cast<std::uint8_t>(code));
    if (bytes == 2) as(static_cast<std::uint16_t>(code));
    if (bytes == 4) as(static_cast<std::uint32_t>(code));
}

template <class T>
std::uint64_t whole(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

}  // namespace

bool choose_type(Samples& samples) {
    const int bits = samples.bits;
    if (bits < 1 || bits > 64) return false;
    samples.type = ReaderType::f32;
    switch (samples.format) {
        case 1:
            if (bits <= 32) samples.type = bits <= 8 ? ReaderType::u8 : bits <= 16 ? ReaderType::u16 : ReaderType::u32;
            return true;
        case 2:
            samples.is_inverted = false;
            if (bits == 8) samples.type = ReaderType::s8;
            if (bits == 16) samples.type = ReaderType::s16;
            if (bits == 32) samples.type = ReaderType::s32;
            return true;
        case 3:
            samples.is_inverted = false;
            if (bits == 16) samples.type = ReaderType::f16;
            return bits == 16 || bits == 24 || bits == 32 || bits == 64;
        default: return false;
    }
}

std::uint64_t code_at(const std::byte* row, int bits, std::size_t k) {
    switch (bits) {
        case 8: return whole<std::uint8_t>(row + k);
        case 16: return whole<std::uint16_t>(row + 2 * k);
        case 32: return whole<std::uint32_t>(row + 4 * k);
        case 64: return whole<std::uint64_t>(row + 8 * k);
        case 24: {
            const auto byte = [&](std::size_t at) { return static_cast<std::uint64_t>(row[3 * k + at]); };
            constexpr std::uint16_t kOne = 1;
            unsigned char first = 0;
            std::memcpy(&first, &kOne, 1);
            return first == 1 ? byte(0) | byte(1) << 8 | byte(2) << 16 : byte(2) | byte(1) << 8 | byte(0) << 16;
        }
        default: break;
    }
    std::uint64_t code = 0;
    const std::size_t begin = k * static_cast<std::size_t>(bits);
    for (std::size_t bit = begin; bit < begin + static_cast<std::size_t>(bits); ++bit)
        code = code << 1 | (static_cast<std::uint64_t>(row[bit / 8]) >> (7 - bit % 8) & 1);
    return code;
}

void unpack(const Samples& samples, const std::byte* row, std::size_t count, std::size_t step, std::byte* to) {
    const std::size_t bytes = reader_type_bytes(samples.type);
    if (samples.is_plain() && step == 1) {
        std::memcpy(to, row, count * bytes);
        return;
    }
    if (samples.is_plain()) {
        for (std::size_t k = 0; k < count; ++k) std::memcpy(to + k * step * bytes, row + k * bytes, bytes);
        return;
    }
    for (std::size_t k = 0; k < count; ++k) put_sample(code_at(row, samples.bits, k), samples, to + k * step * bytes);
}

bool put_value(double value, const Samples& samples, std::byte* to) {
    if (samples.format == 3) {
        const auto single = static_cast<float>(std::clamp<double>(value, -kGreatest, kGreatest));
        if (samples.type == ReaderType::f16) {
            const Imath::half half(single);
            std::memcpy(to, &half, sizeof half);
        } else {
            std::memcpy(to, &single, sizeof single);
        }
        return true;
    }
    const bool is_signed = samples.format == 2;
    const double end = std::ldexp(1.0, samples.bits - (is_signed ? 1 : 0));
    if (value != std::floor(value) || value >= end || value < (is_signed ? -end : 0.0)) return false;
    const std::uint64_t code =
        is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(value)) : static_cast<std::uint64_t>(value);
    Samples as_handed_over = samples;
    as_handed_over.is_inverted = false;
    put_sample(code & ~std::uint64_t{0} >> (64 - samples.bits), as_handed_over, to);
    return true;
}

void name_channels(ReaderHeader& header) {
    const std::string_view names = header.channels < 3 ? "YA" : "RGBA";
    for (std::size_t c = 0; c < static_cast<std::size_t>(header.channels) && c < names.size(); ++c)
        header.names[c][0] = names[c];
}

}  // namespace tex::reader
