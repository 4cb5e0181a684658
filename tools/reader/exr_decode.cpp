// SPDX-License-Identifier: Apache-2.0
// A part of an EXR file, decoded by OpenEXR, becomes an uncompressed file with the same channels, levels and
// attributes.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfThreading.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>

#include "decoders.h"
#include "open_input.h"

namespace tex::reader {
namespace {

// A damaged chunk may decode to fewer bytes than its texels need. What OpenEXR leaves in the other texels depends on
// the number of threads, so it is the same on every machine; and new memory is filled with zeros.
constexpr int kThreads = 4;

constexpr int kLinesAtOnce = 256;  // the lines of the largest chunk

class Sink final : public Imf::OStream {
public:
    Sink() : Imf::OStream("") { held_.reserve(kMostHeld); }
    void write(const char data[], int n) override {
        const auto count = static_cast<std::size_t>(n);
        if (held_.size() + count > kMostHeld) flush();
        if (count > kMostHeld)
            put(data, count);
        else
            held_.insert(held_.end(), data, data + count);
    }
    std::uint64_t tellp() override { return at_ + held_.size(); }
    void seekp(std::uint64_t at) override {
        flush();
        at_ = at;
    }
    // The size of the file. Throws std::bad_alloc if it is not complete, because OpenEXR's destructors hide exceptions.
    std::uint64_t finish() {
        flush();
        if (written_ < begun_) throw std::bad_alloc();
        return end_;
    }

private:
    static constexpr std::size_t kMostHeld = std::size_t{1} << 16;

    void flush() {
        const std::vector<char> held = std::move(held_);
        held_.clear();
        put(held.data(), held.size());
    }
    void put(const char* data, std::size_t count) {
        ++begun_;
        if (at_ + count > end_) {
            reserve_result(at_ + count - end_);
            end_ = at_ + count;
        }
        put_bytes(kReaderDataOffset + at_, data, count);
        at_ += count;
        ++written_;
    }

    std::vector<char> held_;  // follows at_
    std::uint64_t at_ = 0, end_ = 0;
    int begun_ = 0, written_ = 0;
};

// Rows of all channels, for OpenEXR to fill and to write.
class Rows {
public:
    explicit Rows(const Imf::Header& header) : channels_(header.channels()) {}
    // A frame buffer for lines [top, top + count) of a level.
    Imf::FrameBuffer buffer(const Imath::Box2i& window, int top, int count) {
        const int width = window.max.x - window.min.x + 1;
        std::size_t bytes = 0;  // of a line
        for (auto it = channels_.begin(); it != channels_.end(); ++it) bytes += line_bytes(it.channel(), width);
        texels_.assign(bytes * static_cast<std::size_t>(count), 0);
        Imf::FrameBuffer buffer;
        char* channel = texels_.data();
        for (auto it = channels_.begin(); it != channels_.end(); ++it) {
            const std::size_t line = line_bytes(it.channel(), width);
            buffer.insert(it.name(), Imf::Slice::Make(it.channel().type, channel, {window.min.x, top}, width, count,
                                                      value_bytes(it.channel()), line));
            channel += line * static_cast<std::size_t>(count);
        }
        return buffer;
    }

private:
    static std::size_t value_bytes(const Imf::Channel& channel) { return channel.type == Imf::HALF ? 2 : 4; }
    static std::size_t line_bytes(const Imf::Channel& channel, int width) {
        return value_bytes(channel) * static_cast<std::size_t>(width);
    }
    Imf::ChannelList channels_;
    std::vector<char> texels_;
};

Imf::Header plain_header(const Imf::Header& header) {
    Imf::Header plain = header;
    plain.compression() = Imf::NO_COMPRESSION;
    plain.lineOrder() = Imf::INCREASING_Y;
    plain.erase("chunkCount");
    return plain;
}

void copy_lines(Imf::MultiPartInputFile& file, int part, Sink& sink) {
    Imf::InputPart from(file, part);
    Imf::OutputFile to(sink, plain_header(from.header()));
    const Imath::Box2i window = from.header().dataWindow();
    Rows rows(from.header());
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    for (std::int64_t done = 0; done < height; done += kLinesAtOnce) {
        const int top = window.min.y + static_cast<int>(done);
        const int count = static_cast<int>(std::min<std::int64_t>(kLinesAtOnce, height - done));
        const Imf::FrameBuffer buffer = rows.buffer(window, top, count);
        from.setFrameBuffer(buffer);
        to.setFrameBuffer(buffer);
        from.readPixels(top, top + count - 1);
        to.writePixels(count);
    }
}

// A ripmap has only its largest level copied.
void copy_tiles(Imf::MultiPartInputFile& file, int part, Sink& sink) {
    Imf::TiledInputPart from(file, part);
    Imf::Header header = plain_header(from.header());
    Imf::TileDescription tiles = header.tileDescription();
    if (tiles.mode == Imf::RIPMAP_LEVELS) tiles.mode = Imf::ONE_LEVEL;
    header.setTileDescription(tiles);
    Imf::TiledOutputFile to(sink, header);
    Rows rows(header);
    for (int level = 0; level < (tiles.mode == Imf::ONE_LEVEL ? 1 : from.numLevels()); ++level) {
        const Imath::Box2i window = from.dataWindowForLevel(level, level);
        for (int j = 0; j < from.numYTiles(level); ++j) {
            const Imath::Box2i tile = from.dataWindowForTile(0, j, level, level);
            const Imf::FrameBuffer buffer = rows.buffer(window, tile.min.y, tile.max.y - tile.min.y + 1);
            from.setFrameBuffer(buffer);
            to.setFrameBuffer(buffer);
            from.readTiles(0, from.numXTiles(level) - 1, j, j, level);
            to.writeTiles(0, to.numXTiles(level) - 1, j, j, level);
        }
    }
}

}  // namespace

bool decode_exr(const Task& task, ReaderHeader& header) {
    int part = 0;
    if (!parse_number(std::string_view(task.format).substr(task.format.find('/') + 1), part)) return false;
    settle_memory();
    Imf::setGlobalThreadCount(kThreads);
    std::unique_ptr<Imf::IStream> stream;
    Imf::MultiPartInputFile file = open_exr_input(stream, kThreads);
    if (part < 0 || part >= file.parts()) return refuse(header, ErrorCode::bad_data, "has no such part");
    Sink sink;
    const Imf::Header& described = file.header(part);
    if (described.hasType() && Imf::isTiled(described.type()))
        copy_tiles(file, part, sink);
    else
        copy_lines(file, part, sink);
    header.bytes = sink.finish();
    return true;
}

}  // namespace tex::reader
