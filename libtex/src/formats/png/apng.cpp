// SPDX-License-Identifier: Apache-2.0

#include "formats/png/apng.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "formats/png/png_chunk.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kSignature = 8;
constexpr std::size_t kFrame = 12;  // length, type and CRC of a chunk

std::uint32_t get32(const std::byte* p) {
    std::uint32_t value = 0;
    for (int k = 0; k < 4; ++k) value = value << 8 | std::to_integer<std::uint32_t>(p[k]);
    return value;
}

void put_chunk(Bytes& to, std::string_view type, std::span<const std::byte> content) {
    const std::size_t begun = begin_png_chunk(to, type);
    to.insert(to.end(), content.begin(), content.end());
    end_png_chunk(to, begun);
}

// A chunk of a file that encode_png() made.
struct Chunk {
    std::string_view type;
    std::span<const std::byte> content;
};

std::vector<Chunk> chunks_of(const Bytes& file) {
    std::vector<Chunk> chunks;
    for (std::size_t at = kSignature; at + kFrame <= file.size();) {
        const std::size_t size = get32(&file[at]);
        chunks.push_back({{reinterpret_cast<const char*>(&file[at + 4]), 4}, {&file[at] + 8, size}});
        at += kFrame + size;
    }
    return chunks;
}

// fcTL: which part of the picture a frame replaces (all of it), and how long the frame is shown.
Bytes frame_control(std::uint32_t sequence, std::span<const std::byte> header, int frames_per_second) {
    Bytes control;
    put_png_number(control, sequence, 4);
    control.insert(control.end(), header.begin(), header.begin() + 8);  // width, height
    put_png_number(control, 0, 4);                                      // left
    put_png_number(control, 0, 4);                                      // top
    put_png_number(control, 1, 2);
    put_png_number(control, static_cast<std::uint32_t>(frames_per_second), 2);
    put_png_number(control, 0, 2);  // no disposal, no blending
    return control;
}

}  // namespace

Result<std::vector<std::byte>> join_png_frames(const std::vector<std::vector<std::byte>>& frames,
                                               int frames_per_second) {
    return no_throw([&]() -> Result<Bytes> {
        const std::vector<Chunk> first = chunks_of(frames.front());
        const std::span<const std::byte> header = first.front().content;
        Bytes file(frames.front().begin(), frames.front().begin() + kSignature);
        put_chunk(file, "IHDR", header);
        Bytes animation;
        put_png_number(animation, static_cast<std::uint32_t>(frames.size()), 4);
        put_png_number(animation, 0, 4);  // repeat forever
        put_chunk(file, "acTL", animation);
        for (const Chunk& chunk : first) {  // sRGB and similar chunks, which all frames share
            if (chunk.type != "IHDR" && chunk.type != "IDAT" && chunk.type != "IEND")
                put_chunk(file, chunk.type, chunk.content);
        }
        std::uint32_t sequence = 0;
        for (const Bytes& frame : frames) {
            const std::vector<Chunk> chunks = chunks_of(frame);
            if (std::memcmp(chunks.front().content.data(), header.data(), header.size()) != 0) {
                return Error{ErrorCode::bad_option, {}, "the frames differ in size"};
            }
            const bool is_first = sequence == 0;
            put_chunk(file, "fcTL", frame_control(sequence++, header, frames_per_second));
            for (const Chunk& chunk : chunks) {
                if (chunk.type != "IDAT") continue;
                if (is_first) {
                    put_chunk(file, "IDAT", chunk.content);
                    continue;
                }
                Bytes data;
                data.reserve(4 + chunk.content.size());
                put_png_number(data, sequence++, 4);
                data.insert(data.end(), chunk.content.begin(), chunk.content.end());
                put_chunk(file, "fdAT", data);
            }
        }
        put_chunk(file, "IEND", {});
        return file;
    });
}

}  // namespace tex::inline v1
