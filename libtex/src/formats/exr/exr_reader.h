// SPDX-License-Identifier: Apache-2.0
// exr_reader.h: rows of texels of the first part of an EXR file. OpenEXR's objects are for one thread at a time: each
// thread has a reader of its own.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfTiledInputPart.h>

#include "files/input_file.h"
#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_part.h"

namespace tex {

// Where texels of some rows go: of each row all of a channel, each value as the file has it, then those of the next
// channel.
struct ExrPlane {
    ExrChannel channel;
    std::size_t offset = 0;  // of the channel in a row, in bytes
};

struct ExrTarget {
    std::span<const ExrPlane> planes;
    std::byte* rows = nullptr;
    std::size_t row_bytes = 0;
};

// All but the constructor throw what OpenEXR throws, also for chunks that do not hold all of their texels, and
// std::bad_alloc.
class ExrReader {
public:
    explicit ExrReader(const InputFile& file) : file_(file), stream_(file) {}

    // The header, read when it is first asked for.
    const Imf::Header& header();

    // The texels of a level, in the file's coordinates. Precondition: as read().
    Imath::Box2i window(int level);

    // Reads rows [first, first + count) of a level. Precondition: the header has proved sound, as this takes memory by
    // it; the level exists.
    void read(int level, int first, int count, const ExrTarget& target);

    // What the system said, where it was not the format that failed.
    [[nodiscard]] const std::optional<Error>& failure() const { return stream_.failure(); }

private:
    void open_part();
    // Lines in the file's coordinates.
    void read_lines(int first, int last, const ExrTarget& target);
    void unzip_lines(int first, int last, const ExrTarget& target);
    // Rows [begin, end) of a level, whole tiles.
    void read_tiles(int level, int begin, int end, const ExrTarget& target);
    // Makes sure that the chunk read last holds `width` x `height` texels.
    void check_chunk(int width, int height);
    // Makes sure that it is the one that the table of chunks tells of.
    void check_place(int chunk) const;

    const InputFile& file_;
    ExrStream stream_;
    std::optional<std::uint64_t> table_;  // of chunks, in a file of one part
    std::optional<Imf::MultiPartInputFile> exr_;
    std::optional<Imf::InputPart> lines_;
    std::optional<Imf::TiledInputPart> tiles_;
    Unzipper unzipper_;
};

}  // namespace tex
