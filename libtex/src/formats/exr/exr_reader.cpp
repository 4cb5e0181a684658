// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_reader.h"

#include <algorithm>
#include <cstring>

#include <Iex.h>
#include <ImfChannelList.h>

#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_dwa.h"

namespace tex {
namespace {

std::size_t value_bytes(Imf::PixelType type) {
    return type == Imf::HALF ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
}

// Bytes of a texel, over all channels.
std::size_t texel_bytes(const Imf::Header& header) {
    std::size_t bytes = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
        bytes += value_bytes(it.channel().type);
    return bytes;
}

bool is_zip(const Imf::Header& header) {
    return header.compression() == Imf::ZIP_COMPRESSION || header.compression() == Imf::ZIPS_COMPRESSION;
}

std::size_t size_of(int width, int height, std::size_t each) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * each;
}

int width_of(const Imath::Box2i& window) { return window.max.x - window.min.x + 1; }

// The chunks of scan lines that hold lines [first, last].
struct Chunks {
    Chunks(const Imf::Header& header, int first, int last)
        : window(header.dataWindow()), lines(chunk_lines(header.compression())), begin((first - window.min.y) / lines),
          end((last - window.min.y) / lines + 1) {}
    [[nodiscard]] int first_line(int chunk) const { return window.min.y + chunk * lines; }
    [[nodiscard]] int last_line(int chunk) const { return std::min(first_line(chunk) + lines - 1, window.max.y); }

    Imath::Box2i window;
    int lines = 1;
    int begin = 0;
    int end = 0;
};

// The frame buffer into which OpenEXR writes `count` lines from line `top` of `window`.
Imf::FrameBuffer buffer_of(const Imath::Box2i& window, int top, int count, const ExrTarget& target) {
    Imf::FrameBuffer buffer;
    for (const ExrPlane& plane : target.planes) {
        buffer.insert(plane.channel.name.c_str(),
                      Imf::Slice::Make(plane.channel.type, target.rows + plane.offset, {window.min.x, top},
                                       width_of(window), count, value_bytes(plane.channel.type), target.row_bytes));
    }
    return buffer;
}

}  // namespace

const Imf::Header& ExrReader::header() {
    if (!exr_) {
        table_ = check_attributes(stream_);
        constexpr int kNoThreads = 0;
        constexpr bool kKeepTable = false;  // a file whose table would have to be guessed is damaged
        exr_.emplace(stream_, kNoThreads, kKeepTable);
    }
    return exr_->header(0);
}

void ExrReader::open_part() {
    if (tiles_ || lines_) return;
    tiles_of(header()) ? void(tiles_.emplace(*exr_, 0)) : void(lines_.emplace(*exr_, 0));
}

Imath::Box2i ExrReader::window(int level) {
    if (level == 0) return header().dataWindow();
    open_part();
    return tiles_->dataWindowForLevel(level, level);
}

void ExrReader::read(int level, int first, int count, const ExrTarget& target) {
    open_part();
    const Imath::Box2i all = window(level);
    if (lines_) {
        const int top = all.min.y + first;
        return is_zip(header()) ? unzip_lines(top, top + count - 1, target) : read_lines(top, top + count - 1, target);
    }
    // OpenEXR can only write whole tiles to the buffer.
    const auto tile = static_cast<int>(tiles_->tileYSize());
    const int begin = first / tile * tile;
    const int end = std::min(((first + count - 1) / tile + 1) * tile, all.max.y - all.min.y + 1);
    if (begin == first && end == first + count) return read_tiles(level, begin, end, target);
    std::vector<std::byte> rows(target.row_bytes * static_cast<std::size_t>(end - begin));
    read_tiles(level, begin, end, {target.planes, rows.data(), target.row_bytes});
    std::memcpy(target.rows, rows.data() + target.row_bytes * static_cast<std::size_t>(first - begin),
                target.row_bytes * static_cast<std::size_t>(count));
}

// OpenEXR trusts the line order that the header states. If that is from the bottom, and the chunk below was read last,
// it reads on from there and does not look at the table. If the header is wrong, the lines could then be read or not,
// depending on what was read before. A new reader always looks at the table first.
void ExrReader::begin_lines(int begin, int end) {
    if (header().lineOrder() != Imf::INCREASING_Y && begin == last_chunk_ - 1) {
        lines_.reset();
        exr_.reset();
        stream_.seekg(0);
        open_part();
    }
    last_chunk_ = end - 1;
}

void ExrReader::read_lines(int first, int last, const ExrTarget& target) {
    const Chunks chunks(header(), first, last);
    begin_lines(chunks.begin, chunks.end);
    lines_->setFrameBuffer(buffer_of(chunks.window, first, last - first + 1, target));
    for (int chunk = chunks.begin; chunk < chunks.end; ++chunk) {
        const int begin = chunks.first_line(chunk);
        const int end = chunks.last_line(chunk);
        lines_->readPixels(std::max(begin, first), std::min(end, last));
        check_place(chunk);
        check_chunk(width_of(chunks.window), end - begin + 1);
    }
}

void ExrReader::unzip_lines(int first, int last, const ExrTarget& target) {
    const Chunks chunks(header(), first, last);
    const int width = width_of(chunks.window);
    const std::size_t pitch = size_of(width, 1, texel_bytes(header()));
    begin_lines(chunks.begin, chunks.end);
    for (int chunk = chunks.begin; chunk < chunks.end; ++chunk) {
        const int begin = chunks.first_line(chunk);
        const int end = chunks.last_line(chunk);
        const char* bytes = nullptr;
        int size = 0;
        lines_->rawPixelData(begin, bytes, size);
        check_place(chunk);
        const std::span<const std::byte> packed(reinterpret_cast<const std::byte*>(bytes),
                                                static_cast<std::size_t>(size));
        const auto texels = unzipper_.texels(packed, pitch * static_cast<std::size_t>(end - begin + 1),
                                             pitch * static_cast<std::size_t>(chunks.lines));
        if (texels.empty()) throw Iex::InputExc("a chunk is damaged or ends too early");
        std::size_t offset = 0;  // of a channel in a line
        for (auto it = header().channels().begin(); it != header().channels().end(); ++it) {
            const std::size_t channel = size_of(width, 1, value_bytes(it.channel().type));
            const auto plane = std::find_if(target.planes.begin(), target.planes.end(),
                                            [&](const ExrPlane& p) { return p.channel.name == it.name(); });
            for (int line = std::max(begin, first); plane != target.planes.end() && line <= std::min(end, last);
                 ++line) {
                std::memcpy(target.rows + static_cast<std::size_t>(line - first) * target.row_bytes + plane->offset,
                            texels.data() + static_cast<std::size_t>(line - begin) * pitch + offset, channel);
            }
            offset += channel;
        }
    }
}

void ExrReader::read_tiles(int level, int begin, int end, const ExrTarget& target) {
    const Imath::Box2i all = window(level);
    const auto height = static_cast<int>(tiles_->tileYSize());
    tiles_->setFrameBuffer(buffer_of(all, all.min.y + begin, end - begin, target));
    for (int j = begin / height; j * height < end; ++j) {
        for (int i = 0; i < tiles_->numXTiles(level); ++i) {
            tiles_->readTile(i, j, level, level);
            const Imath::Box2i tile = tiles_->dataWindowForTile(i, j, level, level);
            check_chunk(width_of(tile), tile.max.y - tile.min.y + 1);
        }
    }
}

// In a file of one part, OpenEXR uses the table only if the requested lines do not follow those that it read last. The
// result must not depend on that, so the table is always checked.
void ExrReader::check_place(int chunk) const {
    if (!table_) return;
    constexpr std::uint64_t kChunkHead = 8;  // number of the first line, and size
    std::uint64_t place = 0;
    const std::uint64_t entry = *table_ + sizeof place * static_cast<std::uint64_t>(chunk);
    const Result<std::size_t> got =
        file_.read_at(static_cast<std::int64_t>(entry), reinterpret_cast<std::byte*>(&place), sizeof place);
    if (!got || *got < sizeof place || place + kChunkHead != stream_.last_place())
        throw Iex::InputExc("the table of chunks does not say where they are");
}

// OpenEXR reads the bytes of a chunk with a single call, which is its last, so the stream still holds them.
void ExrReader::check_chunk(int width, int height) {
    const std::size_t texel = texel_bytes(header());
    const std::size_t wanted = size_of(width, height, texel);
    const Imf::Compression compression = header().compression();
    const bool is_dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    bool whole = chunk_is_whole(compression, stream_.last_read(), wanted);
    if (whole && is_dwa && stream_.last_read().size() < wanted)
        whole = dwa_is_whole(stream_.last_read(), width, height, header().channels());
    if (whole && is_zip(header())) {
        const std::size_t most =
            tiles_ ? size_of(static_cast<int>(tiles_->tileXSize()), static_cast<int>(tiles_->tileYSize()), texel)
                   : wanted;
        whole = !unzipper_.texels(stream_.last_read(), wanted, most).empty();
    }
    if (!whole) throw Iex::InputExc("a chunk ends too early");
}

}  // namespace tex
