// SPDX-License-Identifier: Apache-2.0
// decoders.h: what tex-reader decodes and encodes itself. Everything here may end the process, after a refusal.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "canvas.h"
#include "reader.h"

namespace tex::reader {

// Does the task, by the decoder or encoder of its format.
bool read_or_write(const Task& task, ReaderHeader& header);

bool decode_tiff(const Task& task, ReaderHeader& header);
bool decode_jpeg(const Task& task, ReaderHeader& header);
bool decode_exr(const Task& task, ReaderHeader& header);  // answers with an uncompressed EXR file
bool encode_tiff(const Task& task, ReaderHeader& header);
bool encode_jpeg(const Task& task, ReaderHeader& header);
bool decode_webp(const Task& task, ReaderHeader& header);
bool encode_webp(const Task& task, ReaderHeader& header);

// Names the channels: Y, or Y and A, R, G and B, or R, G, B and A.
void name_channels(ReaderHeader& header);

// How samples are stored, and the type as which they are handed over.
struct Samples {
    int bits = 8;
    int format = 1;            // as TIFF numbers them: 1 unsigned, 2 signed, 3 floating
    bool is_inverted = false;  // 0 is white
    ReaderType type = ReaderType::u8;

    // Whether the bytes that the file stores are those that are handed over.
    [[nodiscard]] bool is_plain() const {
        return !is_inverted && static_cast<std::size_t>(bits) == 8 * reader_type_bytes(type);
    }
};

// Sets `type`. Integers of n bits are moved to the upper bits of the smallest type that holds them; those that no type
// holds, of more than 32 bits or signed and of odd numbers of bits, become floats in [0, 1] or [-1, 1]. Floating-point
// numbers of 24 and 64 bits become floats. False if the kind of sample is not known.
bool choose_type(Samples& samples);

// Unpacks `count` samples from a row, which begins with a whole byte: samples of 8, 16, 24, 32 and 64 bits in native
// byte order, others as a stream of bits, most significant bit first. They go to every `step`-th sample of `to`.
void unpack(const Samples& samples, const std::byte* row, std::size_t count, std::size_t step, std::byte* to);

// Writes a sample that stands for this value, as unpack() would; false if no sample has the value.
bool put_value(double value, const Samples& samples, std::byte* to);

// The code of sample k of a row of integers of up to 16 bits.
std::uint64_t code_at(const std::byte* row, int bits, std::size_t k);

}  // namespace tex::reader
