// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include <ImfChannelList.h>

namespace tex::inline v1 {
namespace {

std::size_t size_of(Extent extent, std::size_t each) { return static_cast<std::size_t>(extent.texels()) * each; }

// Bytes of a texel in the channels before this one. In a line of a chunk, whose channels are sorted by name, those of
// all texels lie before the first value of the channel.
std::size_t bytes_before(const Imf::Header& header, const std::string& name) {
    std::size_t bytes = 0;
    for (auto it = header.channels().begin(); it != header.channels().end() && it.name() != name; ++it)
        bytes += value_bytes(it.channel().type);
    return bytes;
}

// The side of a level: halved, and rounded up or down.
int side_of(int base, int level, Imf::LevelRoundingMode rounding) {
    const int more = rounding == Imf::ROUND_UP && (base & ((1 << level) - 1)) != 0 ? 1 : 0;
    return std::max(1, (base >> level) + more);
}

int level_count_of(Extent base, const Imf::TileDescription& tiles) {
    if (tiles.mode != Imf::MIPMAP_LEVELS) return 1;
    int levels = 1;
    while (side_of(std::max(base.width, base.height), levels - 1, tiles.roundingMode) > 1) ++levels;
    return levels;
}

}  // namespace

Extent ExrReader::Level::chunk_extent(int i, int j) const {
    return {std::min(chunk.width, extent.width - i * chunk.width),
            std::min(chunk.height, extent.height - j * chunk.height)};
}

Error ExrReader::damaged(const char* reason) const {
    return {ErrorCode::bad_data, file_->path(), std::string("damaged EXR: ") + reason};
}

Result<std::shared_ptr<ExrReader>> ExrReader::open(const InputFile& file, const ExrHeaders& headers, int part) {
    const std::optional<std::int32_t> number = headers.count() > 1 ? std::optional(part) : std::nullopt;
    std::shared_ptr<ExrReader> reader(new ExrReader(headers[part], number));
    reader->file_ = &file;
    reader->find_levels();
    if (const Result<void> read = reader->read_table(headers.table(part)); !read) return read.error();
    return reader;
}

Result<std::shared_ptr<ExrReader>> ExrReader::open(InputFile file, const ExrHeaders& headers) {
    Result<std::shared_ptr<ExrReader>> reader = open(file, headers, 0);
    if (!reader) return reader;
    (*reader)->kept_ = std::move(file);
    (*reader)->file_ = &*(*reader)->kept_;
    return reader;
}

void ExrReader::find_levels() {
    for (auto it = header_.channels().begin(); it != header_.channels().end(); ++it)
        texel_bytes_ += value_bytes(it.channel().type);
    const Imath::Box2i& window = header_.dataWindow();
    const Extent base{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
    const std::optional<Imf::TileDescription> tiles = tiles_of(header_);
    has_tiles_ = tiles.has_value();
    std::size_t chunks = 0;
    for (int k = 0; k < (tiles ? level_count_of(base, *tiles) : 1); ++k) {
        Level level;
        level.extent = base;
        level.chunk = {base.width, chunk_lines(header_.compression())};
        if (tiles) {
            level.extent = {side_of(base.width, k, tiles->roundingMode), side_of(base.height, k, tiles->roundingMode)};
            level.chunk = {static_cast<int>(tiles->xSize), static_cast<int>(tiles->ySize)};
        }
        const auto parts = [](int a, int b) { return a / b + (a % b != 0 ? 1 : 0); };
        level.across = parts(level.extent.width, level.chunk.width);
        level.first = chunks;
        chunks += static_cast<std::size_t>(level.across) *
                  static_cast<std::size_t>(parts(level.extent.height, level.chunk.height));
        levels_.push_back(level);
    }
    chunks_ = chunks;
}

int ExrReader::rows_together(int level) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    return std::min(of.chunk.height, of.extent.height);
}

Result<void> ExrReader::read_table(std::uint64_t place) {
    const auto size = static_cast<std::uint64_t>(*file_->size());
    if (place > size || chunks_ > (size - place) / sizeof(std::uint64_t)) return damaged("the file ends too early");
    table_.resize(chunks_);
    const std::size_t bytes = chunks_ * sizeof(std::uint64_t);
    const Result<std::size_t> got =
        file_->read_at(static_cast<std::int64_t>(place), reinterpret_cast<std::byte*>(table_.data()), bytes);
    if (!got) return got.error();
    if (*got < bytes) return damaged("the file ends too early");
    return {};
}

// A chunk begins with the number of the part, if there are several; then the number of its first line, or the places of
// the tile and of the level, each across and down; then its size in bytes. All are 32-bit integers.
Result<void> ExrReader::read_chunk(int level, int i, int j, ChunkDecoder& decoder) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    std::array<std::int32_t, 5> expected{};
    std::size_t fields = 0;
    if (part_) expected[fields++] = *part_;
    if (has_tiles_) {
        for (const int field : {i, j, level, level}) expected[fields++] = field;
    } else {
        expected[fields++] = header_.dataWindow().min.y + j * of.chunk.height;
    }
    std::array<std::int32_t, 6> head{};  // with the size
    const std::size_t head_bytes = (fields + 1) * sizeof head[0];

    const auto size = static_cast<std::uint64_t>(*file_->size());
    const std::uint64_t place = table_[of.first + static_cast<std::size_t>(j) * static_cast<std::size_t>(of.across) +
                                       static_cast<std::size_t>(i)];
    if (place > size || head_bytes > size - place) return damaged("the file ends too early");
    const auto read = [&](std::uint64_t at, std::byte* to, std::size_t count) -> Result<void> {
        const Result<std::size_t> got = file_->read_at(static_cast<std::int64_t>(at), to, count);
        if (!got) return got.error();
        if (*got < count) return damaged("the file ends too early");
        return {};
    };
    if (Result<void> done = read(place, reinterpret_cast<std::byte*>(head.data()), head_bytes); !done) return done;
    if (!std::equal(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(fields), head.begin()))
        return damaged("the table of chunks does not say where they are");
    const auto count = static_cast<std::uint64_t>(static_cast<std::uint32_t>(head[fields]));
    if (count > size_of(of.chunk, texel_bytes_)) return damaged("a chunk is larger than its texels");
    if (count > size - place - head_bytes) return damaged("the file ends too early");
    decoder.bytes.resize(count);
    return read(place + head_bytes, decoder.bytes.data(), count);
}

Result<void> ExrReader::read(int level, int first, int count, const ExrTarget& target) {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    const std::shared_ptr<ChunkDecoder> decoder = decoders_.take([] { return std::make_unique<ChunkDecoder>(); });
    for (int j = first / of.chunk.height; j * of.chunk.height < first + count; ++j) {
        for (int i = 0; i < of.across; ++i) {
            if (Result<void> done = read_chunk(level, i, j, *decoder); !done) return done;
            const Extent extent = of.chunk_extent(i, j);
            const std::span<const std::byte> texels = decoder->texels(
                header_.compression(), decoder->bytes, size_of(extent, texel_bytes_), size_of(of.chunk, texel_bytes_));
            if (texels.empty()) return damaged("a chunk is damaged or ends too early");
            store(texels.data(), extent, i * of.chunk.width, j * of.chunk.height - first, count, target);
        }
    }
    return {};
}

// Stores the lines of a chunk that are among the `count` rows of the target. `left` and `top` are the place of the
// chunk in the target.
void ExrReader::store(const std::byte* texels, Extent extent, int left, int top, int count,
                      const ExrTarget& target) const {
    const auto width = static_cast<std::size_t>(extent.width);
    for (const ExrPlane& plane : target.planes) {
        const std::size_t each = value_bytes(plane.channel.type);
        const std::byte* const values = texels + bytes_before(header_, plane.channel.name) * width;
        std::byte* const to = target.rows + plane.offset + static_cast<std::size_t>(left) * each;
        for (int line = std::max(0, -top); line < std::min(extent.height, count - top); ++line) {
            std::memcpy(to + static_cast<std::size_t>(top + line) * target.row_bytes,
                        values + static_cast<std::size_t>(line) * width * texel_bytes_, width * each);
        }
    }
}

}  // namespace tex::inline v1
