// SPDX-License-Identifier: Apache-2.0
// An .astc file of any bytes is read or refused; what is read is whole, and can be unpacked and written again. The
// blocks are any bytes, too, so this tests their decoder.

#include <algorithm>
#include <cstring>
#include <random>

#include "formats/astc/astc_file.h"
#include "fuzz/whole_texture.h"

// A function of libFuzzer; programs that replay the corpus do not have it, and do not mutate.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// Half of the mutations keep a header that is believed, with an extent that the file can hold.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::minstd_rand random(seed);
    size = LLVMFuzzerMutate(data, size, most);
    if (size < 16 || random() % 2 == 0) return size;
    constexpr std::uint8_t kBlocks[][2] = {{4, 4}, {5, 4}, {6, 6}, {8, 5}, {8, 8}, {10, 6}, {12, 12}};
    const auto& block = kBlocks[random() % 7];
    const std::size_t across = 1 + random() % 4, down = std::max<std::size_t>(1, (size / 16 - 1) / across);
    const std::size_t width = block[0] * across - random() % 3, height = block[1] * down - random() % 3;
    const std::uint8_t header[16] = {0x13,
                                     0xab,
                                     0xa1,
                                     0x5c,
                                     block[0],
                                     block[1],
                                     1,
                                     static_cast<std::uint8_t>(width),
                                     0,
                                     0,
                                     static_cast<std::uint8_t>(height),
                                     static_cast<std::uint8_t>(height >> 8),
                                     0,
                                     1,
                                     0,
                                     0};
    std::memcpy(data, header, sizeof header);
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto texture =
        tex::load_texture(tex::parse_astc, reinterpret_cast<const std::byte*>(data), size, "fuzz.astc", fuzz_options());
    if (texture) expect_whole(*texture);
    return 0;
}
