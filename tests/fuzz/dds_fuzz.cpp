// SPDX-License-Identifier: Apache-2.0
// A DDS file of any bytes is read or refused; what is read is whole, and can be unpacked and written again.
//
// Mutations of single bits hardly ever leave a header that is believed: half of them choose fields from values that
// real files have, and give the file the length that it then claims, or nearly so.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>

#include "formats/dds/dds.h"
#include "fuzz/whole_texture.h"
#include "reference/dds_file.h"

namespace {

using tex::reference::four_cc;
using namespace tex::reference::dds;

// What is likely to stand in a field.
constexpr std::uint32_t kFourCcs[] = {four_cc("DXT1"),
                                      four_cc("DXT2"),
                                      four_cc("DXT3"),
                                      four_cc("DXT4"),
                                      four_cc("DXT5"),
                                      four_cc("ATI1"),
                                      four_cc("ATI2"),
                                      four_cc("BC4U"),
                                      four_cc("BC4S"),
                                      four_cc("BC5U"),
                                      four_cc("BC5S"),
                                      four_cc("RXGB"),
                                      four_cc("DX10"),
                                      four_cc("A2XY"),
                                      36,
                                      110,
                                      111,
                                      112,
                                      113,
                                      114,
                                      115,
                                      116,
                                      117};
constexpr std::uint32_t kFormatFlagValues[] = {0x1,     0x2,     0x4,     0x40,       0x41,
                                               0x20000, 0x20001, 0x80000, 0x80000004, 0x80000};
constexpr std::uint32_t kMaskValues[] = {0,     0xff, 0xff00, 0xff0000, 0xff000000, 0xffff, 0xffff0000, 0x7c00,
                                         0x3e0, 0x1f, 0x8000, 0xf800,   0x7e0,      0x3ff,  0xffc00};

void put(std::uint8_t* data, std::size_t offset, std::uint32_t value) {
    std::memcpy(data + offset, &value, sizeof value);
}

template <std::size_t N>
std::uint32_t one_of(const std::uint32_t (&values)[N], std::minstd_rand& random) {
    return values[random() % N];
}

void change_a_field(std::uint8_t* data, std::size_t size, std::minstd_rand& random) {
    constexpr std::uint32_t kEdges[] = {0,       1,          0x7f,       0xff,       0x7fff,    0xffff,
                                        0x10000, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
    switch (random() % 12) {
        case 0: return put(data, kHeight, static_cast<std::uint32_t>(random() % 70));
        case 1: return put(data, kWidth, static_cast<std::uint32_t>(random() % 70));
        case 2: return put(data, kMipCount, static_cast<std::uint32_t>(random() % 9));
        case 3: return put(data, kFormatFlags, one_of(kFormatFlagValues, random));
        case 4: return put(data, kFourCc, one_of(kFourCcs, random));
        case 5: return put(data, kBitCount, static_cast<std::uint32_t>(random() % 9 * 8));
        case 6: return put(data, kMasks + random() % 4 * 4, one_of(kMaskValues, random));
        case 7: return put(data, random() % 2 == 0 ? kCaps2 : kFlags, static_cast<std::uint32_t>(random()) & 0xfe00u);
        case 8: return put(data, 4 + random() % (kHeader10End / 4 - 1) * 4, one_of(kEdges, random));
        default: break;
    }
    if (size < kHeader10End) return;
    put(data, kFourCc, four_cc("DX10"));
    put(data, kFormatFlags, 0x4);
    if (random() % 8 == 0)
        return put(data, random() % 2 == 0 ? kMiscFlag : kArraySize, static_cast<std::uint32_t>(random() % 8));
    put(data, kDxgi, static_cast<std::uint32_t>(random() % 132));
}

}  // namespace

// A function of libFuzzer; programs that replay the corpus do not have it, and do not mutate.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::minstd_rand random(seed);
    if (size < kHeader10End || random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, "DDS ", 4);
    put(data, 4, 124);
    put(data, 76, 32);
    change_a_field(data, size, random);
    // A new end: sizes are multiples of blocks. What is added is what was there.
    if (random() % 4 == 0) {
        const std::size_t wanted =
            std::min<std::size_t>(most, kHeaderEnd + random() % 600 * 16 + random() % 2 * (kHeader10End - kHeaderEnd));
        for (std::size_t k = size; k < wanted; ++k) data[k] = data[kHeaderEnd + (k - kHeaderEnd) % (size - kHeaderEnd)];
        return std::max<std::size_t>(wanted, kHeader10End);
    }
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tex::ReadOptions options = fuzz_options();
    for (const char* layer : {"", "1"}) {
        options.layer = layer;
        const auto texture =
            tex::load_texture(tex::parse_dds, reinterpret_cast<const std::byte*>(data), size, "fuzz.dds", options);
        if (texture) expect_whole(*texture);
    }
    return 0;
}
