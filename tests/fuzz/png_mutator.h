// SPDX-License-Identifier: Apache-2.0
// png_mutator.h: changes PNG files for fuzzers.
//
// Mutations of bytes end at the sums of chunks: three of four change chunks, the header or the texels under the
// compression, and mend lengths and sums.

#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <utility>
#include <vector>

#include "fuzz/png_chunks.h"

// A function of libFuzzer; programs that replay the corpus do not have it, and do not mutate.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

inline constexpr std::size_t kMostTexelBytes = 1 << 14;

using Random = std::minstd_rand;

inline std::size_t below(std::size_t count, Random& random) { return random() % count; }

template <class T, std::size_t N>
T one_of(const T (&values)[N], Random& random) {
    return values[below(N, random)];
}

inline void mutate(PngBytes& bytes, std::size_t more) {
    const std::size_t size = bytes.size();
    bytes.resize(size + more + 1);
    bytes.resize(LLVMFuzzerMutate(bytes.data(), size, bytes.size()));
}

inline void change_header(PngChunk& chunk, Random& random) {
    PngHeader header = png_header(chunk.data);
    switch (below(6, random)) {
        case 0: header.width = static_cast<std::uint32_t>(1 + below(40, random)); break;
        case 1: header.height = static_cast<std::uint32_t>(1 + below(40, random)); break;
        case 2: header.interlace ^= 1; break;
        case 3: mutate(chunk.data, 0); return;
        default: {
            constexpr std::pair<std::uint8_t, std::uint8_t> kKinds[] = {{1, 0}, {2, 0},  {4, 0},  {8, 0}, {16, 0},
                                                                        {8, 2}, {16, 2}, {1, 3},  {2, 3}, {4, 3},
                                                                        {8, 3}, {8, 4},  {16, 4}, {8, 6}, {16, 6}};
            const auto [bits, color_type] = one_of(kKinds, random);
            header.bit_depth = bits;
            header.color_type = color_type;
        }
    }
    chunk = png_chunk(header);
}

// The texels under the compression; often as many as the header asks for, with filters that there are.
inline void change_texels(std::vector<PngChunk>& chunks, Random& random) {
    PngBytes packed;
    for (const PngChunk& chunk : chunks) {
        if (chunk.is("IDAT")) packed.insert(packed.end(), chunk.data.begin(), chunk.data.end());
    }
    PngBytes texels = inflated(packed, kMostTexelBytes);
    if (below(3, random) == 0) mutate(texels, 8);
    if (below(8, random) != 0) {
        const std::vector<std::size_t> rows =
            png_rows(chunks.empty() ? PngHeader{} : png_header(chunks[0].data), kMostTexelBytes);
        while (texels.size() < rows.back()) texels.push_back(static_cast<std::uint8_t>(random()));
        texels.resize(rows.back());
        for (std::size_t k = 0; k + 1 < rows.size(); ++k)
            texels[rows[k]] = static_cast<std::uint8_t>(texels[rows[k]] % 5);
    }
    packed = deflated(texels, static_cast<int>(below(10, random)));
    // In place of the first IDAT, in one piece or two.
    const auto first =
        std::find_if(chunks.begin(), chunks.end(), [](const PngChunk& chunk) { return chunk.is("IDAT"); });
    auto at = chunks.begin() + std::min<std::ptrdiff_t>(first - chunks.begin(), std::ssize(chunks));
    std::vector<PngChunk> changed(chunks.begin(), at);
    const auto cut =
        packed.begin() + static_cast<std::ptrdiff_t>(below(2, random) == 0 ? 0 : below(packed.size() + 1, random));
    changed.push_back({{'I', 'D', 'A', 'T'}, {packed.begin(), cut}});
    changed.push_back({{'I', 'D', 'A', 'T'}, {cut, packed.end()}});
    for (; at != chunks.end(); ++at) {
        if (!at->is("IDAT")) changed.push_back(*at);
    }
    chunks = std::move(changed);
}

inline void insert_chunk(std::vector<PngChunk>& chunks, Random& random) {
    // With a length that the chunk may have; of those that libtex wants libpng to skip as well.
    constexpr std::pair<const char*, std::size_t> kChunks[] = {
        {"PLTE", 3},   {"PLTE", 48}, {"PLTE", 768}, {"tRNS", 1}, {"tRNS", 2},  {"tRNS", 6},  {"tRNS", 16},
        {"tRNS", 256}, {"IEND", 0},  {"IDAT", 4},   {"gAMA", 4}, {"sRGB", 1},  {"sBIT", 3},  {"iCCP", 24},
        {"cHRM", 32},  {"bKGD", 6},  {"hIST", 32},  {"pHYs", 9}, {"eXIf", 12}, {"tEXt", 12}, {"zTXt", 20},
        {"iTXt", 20},  {"sPLT", 20}, {"tIME", 7},   {"acTL", 8}, {"fcTL", 26}, {"CRIT", 5},  {"priv", 5}};
    const auto& [name, length] = one_of(kChunks, random);
    PngChunk chunk;
    std::copy_n(name, chunk.type.size(), chunk.type.begin());
    for (std::size_t k = 0; k < length; ++k) chunk.data.push_back(static_cast<std::uint8_t>(random()));
    chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(below(chunks.size() + 1, random)), std::move(chunk));
}

inline void change_chunks(std::vector<PngChunk>& chunks, Random& random) {
    const std::size_t k = chunks.empty() ? 0 : below(chunks.size(), random);
    if (chunks.empty() || below(4, random) == 0) return insert_chunk(chunks, random);
    switch (below(8, random)) {
        case 0: mutate(chunks[k].data, 64); break;
        case 1: chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(k)); break;
        case 2: std::swap(chunks[k], chunks[below(chunks.size(), random)]); break;
        case 3: change_texels(chunks, random); break;
        default:
            change_header(chunks[0], random);
            if (below(4, random) != 0) change_texels(chunks, random);
    }
}

// Called by LLVMFuzzerCustomMutator().
inline std::size_t mutate_png(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    Random random(seed);
    if (below(4, random) == 0) return LLVMFuzzerMutate(data, size, most);
    std::vector<PngChunk> chunks = png_chunks(data, size);
    if (chunks.empty()) chunks = {png_chunk(PngHeader{}), {{'I', 'E', 'N', 'D'}, {}}};
    change_chunks(chunks, random);
    const PngBytes file = png_file(chunks);
    if (file.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::copy(file.begin(), file.end(), data);
    return file.size();
}
