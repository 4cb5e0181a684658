// SPDX-License-Identifier: Apache-2.0
// exr_reader.h: reads rows of texels of the first part of an EXR file. Only one thread at a time may use an OpenEXR
// object, so each thread has its own reader.

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
#include "formats/exr/exr_part.h"
#include "formats/exr/exr_zip.h"

namespace tex {

// Where the texels of some rows go. A row holds all values of one channel, each as in the file, then those of the next
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

// All functions except the constructor throw std::bad_alloc and what OpenEXR throws. They also throw if a chunk does
// not hold all of its texels.
class ExrReader {
public:
    explicit ExrReader(const InputFile& file) : file_(file), stream_(file) {}

    // The header. It is read when this is first called.
    const Imf::Header& header();

    // The data window of a level, in the file's coordinates. Precondition: as read().
    Imath::Box2i window(int level);

    // Reads rows [first, first + count) of a level. Preconditions: the header has been checked, because it determines
    // how much memory is allocated; the level exists.
    void read(int level, int first, int count, const ExrTarget& target);

    // The system's error, if reading failed for another reason than the format.
    [[nodiscard]] const std::optional<Error>& failure() const { return stream_.failure(); }

private:
    void open_part();
    // To be called before the lines of chunk `begin` are read, and those that follow up to chunk `end` - 1.
    void begin_lines(int begin, int end);
    // Lines are in the file's coordinates.
    void read_lines(int first, int last, const ExrTarget& target);
    void unzip_lines(int first, int last, const ExrTarget& target);
    // Reads rows [begin, end) of a level, whole tiles.
    void read_tiles(int level, int begin, int end, const ExrTarget& target);
    // Checks that the chunk read last holds `width` x `height` texels.
    void check_chunk(int width, int height);
    // Checks that the chunk read last is at the place that the table of chunks states.
    void check_place(int chunk) const;

    const InputFile& file_;
    ExrStream stream_;
    std::optional<std::uint64_t> table_;  // where the table of chunks begins, in a file of one part
    std::optional<Imf::MultiPartInputFile> exr_;
    std::optional<Imf::InputPart> lines_;
    int last_chunk_ = 0;  // of the lines that were read last
    std::optional<Imf::TiledInputPart> tiles_;
    Unzipper unzipper_;
};

}  // namespace tex
