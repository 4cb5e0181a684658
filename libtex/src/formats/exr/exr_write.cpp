// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <OpenEXRConfig.h>

#include <tex/types.h>

#include "formats/exr/exr_part.h"
#include "formats/exr/exr_waiting.h"
#include "formats/row_target.h"
#include "threads/no_throw.h"
#include "threads/pool.h"

namespace tex::inline v1 {
namespace {

static_assert(std::endian::native == std::endian::little, "files and levels hold little-endian values");

// Where OpenEXR writes the header.
class HeaderStream final : public Imf::OStream {
public:
    explicit HeaderStream(std::vector<std::byte>& bytes) : Imf::OStream(""), bytes_(bytes) {}
    void write(const char data[], int count) override {
        const auto* from = reinterpret_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), from, from + count);
    }
    std::uint64_t tellp() override { return bytes_.size(); }
    void seekp(std::uint64_t at) override {
        if (at != bytes_.size()) throw Iex::LogicExc("the header goes back");
    }

private:
    std::vector<std::byte>& bytes_;
};

std::vector<std::string> channels_for(const FormatInfo& format) {
    if (format.channels == 1) return {"Y"};
    std::vector<std::string> names = {"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(format.channels));
    return names;
}

Imf::Header header_of(const TextureHead& texture) {
    const FormatInfo format = format_info(texture.format);
    Imf::Header header(texture.extent.width, texture.extent.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const Imf::PixelType type = format.bits == 16 ? Imf::HALF : Imf::FLOAT;
    for (const std::string& name : channels_for(format)) header.channels().insert(name, Imf::Channel(type));
    const bool holds_normals =
        std::find(texture.swizzle.begin(), texture.swizzle.end(), Component::x) != texture.swizzle.end();
    if (holds_normals) {
        header.insert(kNormalEncoding, Imf::StringAttribute("signed"));
        if (texture.y_known)
            header.insert(kNormalYAxis, Imf::StringAttribute(std::string(name_of(kYAxisNames, texture.y_axis))));
    }
    if (texture.bumpiness_x != 0.0f)
        header.insert(kHeightBumpiness, Imf::V2fAttribute({texture.bumpiness_x, texture.bumpiness_y}));
    if (texture.levels > 1)
        header.setTileDescription(Imf::TileDescription(kExrTile, kExrTile, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
    return header;
}

// What comes before the table of chunks.
std::vector<std::byte> bytes_of(const Imf::Header& header) {
    const bool has_tiles = header.hasTileDescription();
    constexpr char kVersion = 2, kTiled = 2;  // the second byte holds flags
    header.sanityCheck(has_tiles);
    std::vector<std::byte> bytes;
    HeaderStream stream(bytes);
    stream.write(kExrMagic.data(), static_cast<int>(kExrMagic.size()));
    const char version[] = {kVersion, has_tiles ? kTiled : char{0}, 0, 0};
    stream.write(version, sizeof version);
    header.writeTo(stream, has_tiles);
    return bytes;
}

// Collects rows in bands, and writes the blocks of these in the order of the table of chunks: level by level, from the
// top. (If they were stored in the order in which they arrive, the bytes would depend on the path that a texture
// takes.)
class ExrRowTarget final : public RowTarget {
public:
    // `head` is what comes before the table.
    ExrRowTarget(const TextureHead& texture, std::vector<std::byte> head, WriteBytes write);

    Result<void> put(int level, const std::byte* rows, int count) override;
    [[nodiscard]] bool has_work() const override { return true; }
    void wait_beside(const std::string& output) override { waiting_.wait_beside(output); }
    std::shared_ptr<RowWork> take_work() override;
    Result<void> end_work(const std::shared_ptr<RowWork>& work) override;
    Result<void> finish() override;

private:
    struct Level {
        ExrGrid grid;
        int first_block;  // the number of its first block in the file
        int next = 0;     // the band that takes rows
        Pool<ExrBand> bands;
        std::shared_ptr<ExrBand> open;  // that band, if it has any
    };
    void divide(Level& level);
    Result<void> write(const ExrChunks& chunks);

    const WriteBytes write_;
    std::vector<Level> levels_;
    Pool<Zipper> zippers_;
    std::deque<std::shared_ptr<ExrBlock>> blocks_;  // to be run
    ExrWaitingBlocks waiting_;                      // have been run
    int written_ = 0;                               // blocks
    std::vector<std::byte> head_;                   // and the table, as far as chunks have been written
    std::size_t begin_ = 0;                         // of the chunks in the file
    std::uint64_t at_ = 0;                          // the end of the chunks that have been written
};

int blocks_of_band(const ExrGrid& grid) {
    return (grid.chunks_of_band() + grid.chunks_of_block() - 1) / grid.chunks_of_block();
}

ExrRowTarget::ExrRowTarget(const TextureHead& texture, std::vector<std::byte> head, WriteBytes write)
    : write_(std::move(write)), head_(std::move(head)) {
    const FormatInfo format = format_info(texture.format);
    int blocks = 0;
    std::size_t chunks = 0;
    for (int k = 0; k < texture.levels; ++k) {
        const ExrGrid grid{format.channels, static_cast<std::size_t>(format.bits / 8), level_extent(texture.extent, k),
                           k, texture.levels > 1};
        levels_.push_back({grid, blocks, 0, {}, nullptr});
        blocks += grid.bands() * blocks_of_band(grid);
        chunks += static_cast<std::size_t>(grid.bands()) * static_cast<std::size_t>(grid.chunks_of_band());
    }
    begin_ = head_.size() + chunks * sizeof(std::uint64_t);
    head_.reserve(begin_);
    at_ = begin_;
}

Result<void> ExrRowTarget::put(int index, const std::byte* rows, int count) {
    Level& level = levels_[static_cast<std::size_t>(index)];
    while (count > 0) {
        if (!level.open) {
            level.open = level.bands.take([] { return std::make_unique<ExrBand>(); });
            level.open->begin(level.grid, level.next);
        }
        const int taken = level.open->add(level.grid, rows, count);
        rows += level.grid.row_bytes() * static_cast<std::size_t>(taken);
        count -= taken;
        if (level.open->is_full()) divide(level);
    }
    return {};
}

// Makes blocks of a full band.
void ExrRowTarget::divide(Level& level) {
    const ExrGrid& grid = level.grid;
    int number = level.first_block + level.next * blocks_of_band(grid);
    for (int begin = 0; begin < grid.chunks_of_band(); begin += grid.chunks_of_block()) {
        const int end = std::min(begin + grid.chunks_of_block(), grid.chunks_of_band());
        blocks_.push_back(std::make_shared<ExrBlock>(grid, level.open, begin, end, number++, zippers_));
    }
    level.open = nullptr;
    ++level.next;
}

std::shared_ptr<RowWork> ExrRowTarget::take_work() {
    if (blocks_.empty()) return nullptr;
    std::shared_ptr<ExrBlock> block = std::move(blocks_.front());
    blocks_.pop_front();
    return block;
}

Result<void> ExrRowTarget::end_work(const std::shared_ptr<RowWork>& work) {
    const auto ended = std::static_pointer_cast<ExrBlock>(work);
    if (Result<void> added = waiting_.add(ended->number(), ended->take_chunks()); !added) return added;
    while (true) {
        Result<std::optional<ExrChunks>> next = waiting_.take(written_);
        if (!next) return next.error();
        if (!*next) return {};
        if (Result<void> done = write(**next); !done) return done;
        ++written_;
    }
}

Result<void> ExrRowTarget::write(const ExrChunks& chunks) {
    std::uint64_t at = at_;
    for (const std::size_t size : chunks.sizes) {
        const auto* entry = reinterpret_cast<const std::byte*>(&at);
        head_.insert(head_.end(), entry, entry + sizeof at);
        at += size;
    }
    return write_(std::exchange(at_, at), chunks.bytes);
}

Result<void> ExrRowTarget::finish() {
    if (head_.size() == begin_) return write_(0, head_);
    return Error{ErrorCode::unsupported, {}, "rows are missing: this is a bug"};
}

}  // namespace

const char* exr_version() { return OPENEXR_VERSION_STRING; }

Result<std::unique_ptr<RowTarget>> open_exr_target(const TextureHead& head, WriteBytes write) {
    return no_throw([&]() -> Result<std::unique_ptr<RowTarget>> {
        if (format_info(head.format).sample != SampleKind::floating) {
            return Error{ErrorCode::unsupported,
                         {},
                         "EXR holds half and float, not " + std::string(name_of(kFormatNames, head.format))};
        }
        const int complete = level_count(head.extent);
        if (head.levels != 1 && head.levels != complete) {
            return Error{ErrorCode::unsupported,
                         {},
                         "EXR holds the base level or all " + std::to_string(complete) + " mip levels, not " +
                             std::to_string(head.levels)};
        }
        try {
            return std::unique_ptr<RowTarget>(
                std::make_unique<ExrRowTarget>(head, bytes_of(header_of(head)), std::move(write)));
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& thrown) {
            return Error{ErrorCode::unsupported, {}, std::string("EXR cannot be written: ") + thrown.what()};
        }
    });
}

Result<std::vector<std::byte>> encode_exr(const Texture& texture) {
    return no_throw([&] { return encode_rows(open_exr_target, texture, true); });
}

}  // namespace tex::inline v1
