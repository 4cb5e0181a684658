// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <OpenEXRConfig.h>

#include <tex/mip_chain.h>

#include "formats/exr/exr_part.h"
#include "formats/row_target.h"
#include "threads/guard.h"

namespace tex {
namespace {

static_assert(std::endian::native == std::endian::little,
              "levels hold little-endian values, OpenEXR wants native ones");

constexpr int kTileSize = 64;
constexpr int kNoThreads = 0;

// A file that OpenEXR writes. OpenEXR writes everything once, from beginning to end, except the table of offsets, to
// which it goes back. Bytes written before pixels() is called stay in memory until finish().
class TargetStream final : public Imf::OStream {
public:
    explicit TargetStream(WriteBytes write) : Imf::OStream(""), write_(std::move(write)) {}

    void write(const char data[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        const auto at = static_cast<std::size_t>(at_);
        if (!pixels_) head_.resize(std::max(head_.size(), at + n));
        if (at + n <= head_.size()) {
            std::memcpy(head_.data() + at, data, n);
        } else if (!failure_) {
            const Result<void> written = write_(at_, std::as_bytes(std::span(data, n)));
            if (!written) failure_ = written.error();
        }
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }

    void pixels() { pixels_ = true; }
    Result<void> finish() {
        if (failure_) return *failure_;
        return write_(0, head_);
    }
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

private:
    const WriteBytes write_;
    std::vector<std::byte> head_;
    std::uint64_t at_ = 0;
    bool pixels_ = false;
    std::optional<Error> failure_;
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
    return header;
}

// Describes interleaved texels that begin with row `first`. OpenEXR's slices point to mutable bytes even if it only
// reads them.
Imf::FrameBuffer frame_buffer(const std::byte* texels, Extent extent, int first, const FormatInfo& format) {
    Imf::FrameBuffer buffer;
    const auto channel_bytes = static_cast<std::size_t>(format.bits / 8);
    std::byte* channel = const_cast<std::byte*>(texels);
    for (const std::string& name : channels_for(format)) {
        buffer.insert(name.c_str(),
                      Imf::Slice::Make(format.bits == 16 ? Imf::HALF : Imf::FLOAT, channel, Imath::V2i(0, first),
                                       extent.width, extent.height, format.block_bytes,
                                       format.block_bytes * static_cast<std::size_t>(extent.width)));
        channel += channel_bytes;
    }
    return buffer;
}

// The common part of scanline and tiled files. `File` is OpenEXR's class.
template <class File>
class ExrTargetOf : public RowTarget {
public:
    ExrTargetOf(const TextureHead& head, WriteBytes write)
        : head_(head), format_(format_info(head.format)), stream_(std::move(write)) {}

    Result<void> begin(const Imf::Header& header) {
        return watched([&] {
            file_.emplace(stream_, header, kNoThreads);
            stream_.pixels();
        });
    }
    Result<void> finish() override {
        file_.reset();  // writes the table, and ignores errors
        return stream_.finish();
    }

protected:
    template <class Body>
    Result<void> watched(const Body& body) {
        try {
            body();
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& thrown) {
            return Error{ErrorCode::unsupported, {}, std::string("EXR cannot be written: ") + thrown.what()};
        }
        if (stream_.failure()) return *stream_.failure();
        return {};
    }

    const TextureHead head_;
    const FormatInfo format_;
    TargetStream stream_;
    std::optional<File> file_;
};

class LinesTarget final : public ExrTargetOf<Imf::OutputFile> {
public:
    using ExrTargetOf::ExrTargetOf;
    Result<void> put(int, const std::byte* rows, int count) override {
        return watched([&] {
            file_->setFrameBuffer(frame_buffer(rows, {head_.extent.width, count}, file_->currentScanLine(), format_));
            file_->writePixels(count);
        });
    }
};

// Writes all levels. OpenEXR keeps the compressed tiles of the smaller levels until those of the larger ones are in the
// file. The order of its tiles is therefore always the same, and a third of the tiles that it holds is in memory. (If
// the tiles were stored in the order in which they arrive, the bytes would depend on the path that a texture takes.)
class TilesTarget final : public ExrTargetOf<Imf::TiledOutputFile> {
public:
    TilesTarget(const TextureHead& head, WriteBytes write)
        : ExrTargetOf(head, std::move(write)), levels_(static_cast<std::size_t>(head.levels)) {}

    Result<void> put(int level, const std::byte* rows, int count) override;

private:
    // Rows of a row of tiles that is not complete yet.
    struct Open {
        int next = 0;  // the next row of the level
        std::vector<std::byte> rows;
    };
    // Writes rows [first, first + count) of a level, whole rows of tiles.
    void write(int level, int first, int count, const std::byte* rows) {
        file_->setFrameBuffer(frame_buffer(rows, {level_extent(head_.extent, level).width, count}, first, format_));
        file_->writeTiles(0, file_->numXTiles(level) - 1, first / kTileSize, (first + count - 1) / kTileSize, level);
    }

    std::vector<Open> levels_;
};

Result<void> TilesTarget::put(int level, const std::byte* rows, int count) {
    Open& open = levels_[static_cast<std::size_t>(level)];
    const Extent extent = level_extent(head_.extent, level);
    const std::size_t pitch = level_bytes(head_.format, {extent.width, 1});
    return watched([&] {
        while (count > 0) {
            const int begin = open.next / kTileSize * kTileSize, end = std::min(begin + kTileSize, extent.height);
            const int all =
                open.next + count == extent.height ? count : count / kTileSize * kTileSize;  // whole rows of tiles
            const bool whole = open.next == begin && all > 0;
            const int taken = whole ? all : std::min(count, end - open.next);
            if (whole) {
                write(level, begin, taken, rows);
            } else {
                open.rows.insert(open.rows.end(), rows, rows + static_cast<std::size_t>(taken) * pitch);
            }
            open.next += taken;
            rows += static_cast<std::size_t>(taken) * pitch;
            count -= taken;
            if (whole || open.next < end) continue;
            write(level, begin, end - begin, open.rows.data());
            open.rows.clear();
        }
    });
}

template <class Target>
Result<std::unique_ptr<RowTarget>> open_target(const TextureHead& head, const Imf::Header& header, WriteBytes write) {
    auto target = std::make_unique<Target>(head, std::move(write));
    if (const Result<void> begun = target->begin(header); !begun) return begun.error();
    return std::unique_ptr<RowTarget>(std::move(target));
}

}  // namespace

const char* exr_version() { return OPENEXR_VERSION_STRING; }

Result<std::unique_ptr<RowTarget>> open_exr_target(const TextureHead& head, WriteBytes write) {
    return guarded([&]() -> Result<std::unique_ptr<RowTarget>> {
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
        Imf::Header header = header_of(head);
        if (head.levels == 1) return open_target<LinesTarget>(head, header, std::move(write));
        header.setTileDescription(Imf::TileDescription(kTileSize, kTileSize, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
        return open_target<TilesTarget>(head, header, std::move(write));
    });
}

Result<std::vector<std::byte>> encode_exr(const Texture& texture) {
    return guarded([&] { return encode_rows(open_exr_target, texture, true); });
}

}  // namespace tex
