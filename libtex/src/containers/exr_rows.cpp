// SPDX-License-Identifier: Apache-2.0

#include "containers/exr_rows.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include <ImfFrameBuffer.h>
#include <half.h>

#include "base/guard.h"
#include "base/pool.h"
#include "containers/exr_chunk.h"
#include "containers/exr_part.h"
#include "containers/exr_texture.h"

namespace tex {
namespace {

// The file open once more: OpenEXR's objects are for one thread at a time.
struct ExrReader {
    explicit ExrReader(const InputFile& file) : stream(file) {}

    void open() {
        check_attributes(stream);
        constexpr int kNoThreads = 0;
        constexpr bool kKeepTable = false;  // a table that has to be guessed is damage
        exr.emplace(stream, kNoThreads, kKeepTable);
    }
    // Precondition: the header has proved sound, as this takes memory by it.
    void open_part() { exr->header(0).hasTileDescription() ? void(tiles.emplace(*exr, 0)) : void(lines.emplace(*exr, 0)); }

    ExrStream stream;
    std::optional<Imf::MultiPartInputFile> exr;
    std::optional<Imf::InputPart> lines;
    std::optional<Imf::TiledInputPart> tiles;
};

// A decoded row holds its channels one after the other, each as the file has it.
struct ExrPlane {
    ExrChannel channel;
    std::size_t offset = 0;
};

class ExrRows final : public RowSource {
public:
    ExrRows(const InputFile& file, const ReadOptions& options) : file_(file), options_(options) {}

    // Reads the header; of a texture's rows, where `texture` is not null, also what it says of that.
    Result<void> open(ExrTexture* texture);

    [[nodiscard]] int rows_together() const override { return rows_together_; }
    [[nodiscard]] bool is_random() const override { return true; }
    Result<void> decode(int first, int count, std::byte* rows) override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

    // Runs body(reader), which returns a Result and may throw what OpenEXR throws.
    template <class Body>
    Result<void> with_reader(const Body& body);

private:
    const InputFile& file_;
    const ReadOptions options_;
    Imath::V2i origin_;
    int rows_together_ = 1;
    std::vector<ExrPlane> planes_;
    Pool<ExrReader> readers_;
};

template <class Body>
Result<void> ExrRows::with_reader(const Body& body) {
    std::shared_ptr<ExrReader> reader;
    try {
        reader = readers_.take([this] { return std::make_unique<ExrReader>(file_); });
        if (!reader->exr) reader->open();
        return body(*reader);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {
        if (reader && reader->stream.failure()) return *reader->stream.failure();
        return exr_error(file_.path(), thrown);
    }
}

Result<void> ExrRows::open(ExrTexture* texture) {
    return with_reader([&](ExrReader& reader) -> Result<void> {
        const Imf::Header& header = reader.exr->header(0);
        const Result<Extent> extent = check_header(file_.path(), header, *file_.size(), options_);
        if (!extent) return extent.error();
        origin_ = header.dataWindow().min;
        rows_together_ = header.hasTileDescription() ? static_cast<int>(header.tileDescription().ySize) : chunk_lines(header.compression());
        rows_together_ = std::min(rows_together_, extent->height);
        std::vector<ExrChannel> channels = channels_of(header);
        if (texture != nullptr) {
            Result<ExrTexture> described = exr_texture_of(file_.path(), header, *extent);
            if (!described) return std::move(described).error();
            *texture = std::move(*described);
            channels = texture->channels;
        }
        std::vector<std::string> names;
        std::size_t bytes = 0;
        for (ExrChannel& channel : channels) {
            constexpr std::size_t kAlignment = 16;
            const std::size_t size = static_cast<std::size_t>(extent->width) * (channel.type == Imf::HALF ? 2 : 4);
            names.push_back(channel.name);
            planes_.push_back({std::move(channel), bytes});
            bytes += (size + kAlignment - 1) / kAlignment * kAlignment;
        }
        describe(*extent, std::move(names), bytes);
        return {};
    });
}

Result<void> ExrRows::decode(int first, int count, std::byte* rows) {
    return with_reader([&](ExrReader& reader) -> Result<void> {
        const Imath::V2i top(origin_.x, origin_.y + first);
        Imf::FrameBuffer buffer;
        for (const ExrPlane& plane : planes_) {
            const Imf::PixelType type = plane.channel.type;
            const std::size_t size = type == Imf::HALF ? 2 : 4;
            buffer.insert(plane.channel.name.c_str(), Imf::Slice::Make(type, rows + plane.offset, top, extent().width, count,
                                                                       size, row_bytes()));
        }
        if (!reader.tiles && !reader.lines) reader.open_part();
        if (reader.tiles) {
            const auto height = static_cast<int>(reader.tiles->tileYSize());
            reader.tiles->setFrameBuffer(buffer);
            read_tiles(*reader.tiles, reader.stream, first / height, (first + count - 1) / height, 0);
        } else {
            reader.lines->setFrameBuffer(buffer);
            read_lines(*reader.lines, reader.stream, top.y, top.y + count - 1);
        }
        return {};
    });
}

void ExrRows::store(const std::byte* rows, int first, int end, Image& image) const {
    const auto width = static_cast<std::size_t>(extent().width);
    for (int j = first; j < end; ++j, rows += row_bytes()) {
        for (std::size_t k = 0; k < planes_.size(); ++k) {
            const std::byte* from = rows + planes_[k].offset;
            float* to = image.planes[k].row(j);
            switch (planes_[k].channel.type) {
                case Imf::HALF:
                    for (std::size_t i = 0; i < width; ++i) {
                        Imath::half value;
                        std::memcpy(&value, from + i * sizeof value, sizeof value);
                        to[i] = value;
                    }
                    break;
                case Imf::UINT:
                    for (std::size_t i = 0; i < width; ++i) {
                        std::uint32_t code = 0;
                        std::memcpy(&code, from + i * sizeof code, sizeof code);
                        to[i] = static_cast<float>(static_cast<double>(code) / 4294967295.0);
                    }
                    break;
                default: std::memcpy(to, from, width * sizeof(float)); break;
            }
        }
    }
}

Result<std::unique_ptr<RowSource>> open_part_rows(InputFile& file, const ReadOptions& options, ExrTexture* texture) {
    if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
    auto rows = std::make_unique<ExrRows>(file, options);
    if (const Result<void> opened = rows->open(texture); !opened) return opened.error();
    return std::unique_ptr<RowSource>(std::move(rows));
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_exr_rows(InputFile& file, const ReadOptions& options) {
    return guarded([&] { return open_part_rows(file, options, nullptr); });
}

Result<ExrTextureRows> open_exr_texture_rows(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<ExrTextureRows> {
        ExrTexture texture;
        Result<std::unique_ptr<RowSource>> rows = open_part_rows(file, options, &texture);
        if (!rows) return std::move(rows).error();
        return ExrTextureRows{std::move(*rows), std::move(texture.head), texture.levels};
    });
}

}  // namespace tex
