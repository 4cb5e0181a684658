// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_rows.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <ImfStringAttribute.h>

#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_part.h"
#include "formats/exr/exr_reader.h"
#include "formats/exr/exr_texture.h"
#include "kernels/samples.h"
#include "threads/guard.h"
#include "threads/pool.h"

namespace tex {
namespace {

// Runs body(), which returns a Result and may throw what OpenEXR throws. body() reads with `reader`.
template <class Body>
auto with_reader(const InputFile& file, const ExrReader& reader, const Body& body) -> decltype(body()) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {
        if (reader.failure()) return *reader.failure();
        return exr_error(file.path(), thrown);
    }
}

class ExrRows final : public RowSource {
public:
    // Rows of a level. `reader`, one of `readers`, describes the level. Throws what OpenEXR throws. Precondition: the
    // header has been checked.
    ExrRows(const InputFile& file, Pool<ExrReader> readers, ExrReader& reader, const std::vector<ExrChannel>& channels,
            int level);

    [[nodiscard]] int rows_together() const override { return rows_together_; }
    [[nodiscard]] bool is_random() const override { return true; }
    void choose_planes(const std::vector<bool>& wanted) override { wanted_ = wanted; }
    Result<void> decode(int first, int count, std::byte* rows) override;
    bool store_numbers() override {
        has_whole_numbers_ = true;
        return true;
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    const InputFile& file_;
    const int level_;
    int rows_together_ = 1;
    std::vector<ExrPlane> planes_;
    std::vector<bool> wanted_;
    bool has_whole_numbers_ = false;  // uint stays what it is
    Pool<ExrReader> readers_;         // shared by all levels
};

std::shared_ptr<ExrReader> take_reader(Pool<ExrReader>& readers, const InputFile& file) {
    return readers.take([&file] { return std::make_unique<ExrReader>(file); });
}

ExrRows::ExrRows(const InputFile& file, Pool<ExrReader> readers, ExrReader& reader,
                 const std::vector<ExrChannel>& channels, int level)
    : file_(file), level_(level), readers_(std::move(readers)) {
    const Imf::Header& header = reader.header();
    const Imath::Box2i window = reader.window(level);
    const Extent extent{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
    const std::optional<Imf::TileDescription> tiles = tiles_of(header);
    rows_together_ = tiles ? static_cast<int>(tiles->ySize) : chunk_lines(header.compression());
    rows_together_ = std::min(rows_together_, extent.height);
    std::vector<std::string> names;
    std::size_t bytes = 0;
    for (const ExrChannel& channel : channels) {
        constexpr std::size_t kAlignment = 16;
        const std::size_t size = static_cast<std::size_t>(extent.width) * (channel.type == Imf::HALF ? 2 : 4);
        names.push_back(channel.name);
        planes_.push_back({channel, bytes});
        bytes += (size + kAlignment - 1) / kAlignment * kAlignment;
    }
    wanted_.assign(planes_.size(), true);
    describe(extent, std::move(names), bytes);
    const auto all = [&](Imf::PixelType type) {
        return std::all_of(channels.begin(), channels.end(),
                           [type](const ExrChannel& channel) { return channel.type == type; });
    };
    if (std::any_of(channels.begin(), channels.end(), [](const ExrChannel& c) { return c.type == Imf::UINT; }))
        describe_stored({.kind = 1, .bits = 32});
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(kNormalEncoding);
    describe_samples(all(Imf::UINT) ? SampleKind::unorm : SampleKind::floating, all(Imf::HALF) ? 16 : 32,
                     text == nullptr ? "" : text->value());
}

Result<void> ExrRows::decode(int first, int count, std::byte* rows) {
    const std::shared_ptr<ExrReader> reader = take_reader(readers_, file_);
    return with_reader(file_, *reader, [&]() -> Result<void> {
        reader->read(level_, first, count, {planes_, rows, row_bytes()});
        return {};
    });
}

void ExrRows::store(const std::byte* rows, int first, int end, Image& image) const {
    const int width = extent().width;
    for (int j = first; j < end; ++j, rows += row_bytes()) {
        for (std::size_t k = 0; k < planes_.size(); ++k) {
            if (!wanted_[k]) continue;
            const std::byte* from = rows + planes_[k].offset;
            const Imf::PixelType type = planes_[k].channel.type;
            float* to = image.planes[k].row(j);
            if (type != Imf::UINT) {
                decode_samples(SampleKind::floating, type == Imf::HALF ? 16 : 32, from, type == Imf::HALF ? 2 : 4,
                               width, to);
                continue;
            }
            for (int i = 0; i < width; ++i) {
                std::uint32_t code = 0;
                std::memcpy(&code, from + sizeof code * static_cast<std::size_t>(i), sizeof code);
                to[i] = static_cast<float>(static_cast<double>(code) / (has_whole_numbers_ ? 1.0 : 4294967295.0));
            }
        }
    }
}

// Opens the first part and runs body(readers, reader, base). The reader has read the header, and is the first to
// decode.
template <class Body>
auto with_part(InputFile& file, const ReadOptions& options, const Body& body) {
    using Opened = decltype(body(std::declval<Pool<ExrReader>&>(), std::declval<ExrReader&>(), Extent()));
    return guarded([&]() -> Opened {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        Pool<ExrReader> readers;
        const std::shared_ptr<ExrReader> reader = take_reader(readers, file);
        return with_reader(file, *reader, [&]() -> Opened {
            const Result<Extent> base = check_header(file.path(), reader->header(), *file.size(), options);
            if (!base) return base.error();
            return body(readers, *reader, *base);
        });
    });
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_exr_rows(InputFile& file, const ReadOptions& options) {
    return with_part(
        file, options, [&](Pool<ExrReader>& readers, ExrReader& reader, Extent) -> Result<std::unique_ptr<RowSource>> {
            const auto channels = channels_of(reader.header(), options.layer);
            if (!channels) return channels.error();
            return std::unique_ptr<RowSource>(std::make_unique<ExrRows>(file, readers, reader, *channels, 0));
        });
}

Result<TextureRows> open_exr_texture_rows(InputFile& file, const ReadOptions& options) {
    return with_part(
        file, options, [&](Pool<ExrReader>& readers, ExrReader& reader, Extent base) -> Result<TextureRows> {
            Result<ExrTexture> described = exr_texture_of(file.path(), reader.header(), base, options.layer);
            if (!described) return std::move(described).error();
            TextureRows texture;
            texture.head = std::move(described->head);
            for (int level = 0; level < described->levels; ++level) {
                texture.levels.push_back(std::make_unique<ExrRows>(file, readers, reader, described->channels, level));
            }
            texture.take_planes_in_order();
            return texture;
        });
}

}  // namespace tex
