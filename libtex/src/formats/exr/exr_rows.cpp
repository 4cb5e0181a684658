// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_rows.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ImfChannelList.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_part.h"
#include "formats/exr/exr_reader.h"
#include "formats/exr/exr_texture.h"
#include "formats/reader/reader.h"
#include "kernels/samples.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

class ExrRows final : public RowSource {
public:
    // Rows of a level.
    ExrRows(std::shared_ptr<ExrReader> reader, const std::vector<ExrChannel>& channels, int level,
            const std::string& remark = {});

    [[nodiscard]] int rows_together() const override { return reader_->rows_together(level_); }
    [[nodiscard]] bool is_random() const override { return true; }
    void choose_planes(const std::vector<bool>& wanted) override { wanted_ = wanted; }
    Result<void> decode(int first, int count, std::byte* rows) override {
        return reader_->read(level_, first, count, {planes_, rows, row_bytes()});
    }
    bool store_numbers() override {
        has_whole_numbers_ = true;
        return true;
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    const std::shared_ptr<ExrReader> reader_;  // shared by all levels
    const int level_;
    std::vector<ExrPlane> planes_;
    std::vector<bool> wanted_;
    bool has_whole_numbers_ = false;  // uint stays what it is
};

ExrRows::ExrRows(std::shared_ptr<ExrReader> reader, const std::vector<ExrChannel>& channels, int level,
                 const std::string& remark)
    : reader_(std::move(reader)), level_(level) {
    const Extent extent = reader_->extent(level);
    std::vector<std::string> names;
    std::size_t bytes = 0;
    for (const ExrChannel& channel : channels) {
        constexpr std::size_t kAlignment = 16;
        const std::size_t size = static_cast<std::size_t>(extent.width) * value_bytes(channel.type);
        names.push_back(channel.name);
        planes_.push_back({channel, bytes});
        bytes += (size + kAlignment - 1) / kAlignment * kAlignment;
    }
    wanted_.assign(planes_.size(), true);
    head_.remark = remark;
    const auto all = [&](Imf::PixelType type) {
        return std::all_of(channels.begin(), channels.end(),
                           [type](const ExrChannel& channel) { return channel.type == type; });
    };
    if (std::any_of(channels.begin(), channels.end(), [](const ExrChannel& c) { return c.type == Imf::UINT; }))
        head_.samples = {.kind = 1, .bits = 32};
    if (const auto* bumpiness = reader_->header().findTypedAttribute<Imf::V2fAttribute>(kHeightBumpiness))
        head_.strength = Strength{bumpiness->value().x, bumpiness->value().y};
    const auto* text = reader_->header().findTypedAttribute<Imf::StringAttribute>(kNormalEncoding);
    if (text != nullptr) head_.normal_encoding = text->value();
    describe(extent, std::move(names), bytes, all(Imf::UINT) ? SampleKind::unorm : SampleKind::floating,
             all(Imf::HALF) ? 16 : 32);
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

// A part that is ready to be read, and the channels that are wanted of it.
struct OpenedPart {
    Imf::Header header;  // as the file has it
    std::shared_ptr<ExrReader> reader;
    std::vector<ExrChannel> channels;
    std::vector<std::string> remarks;
};

// Says whether a part holds texels for a piece of its picture only, or beyond it. Programs place such texels
// differently.
std::string window_text(const Imf::Header& header) {
    const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
    if (data == display) return {};
    const auto size = [](const Imath::Box2i& window) {
        return std::to_string(std::int64_t{window.max.x} - window.min.x + 1) + "x" +
               std::to_string(std::int64_t{window.max.y} - window.min.y + 1);
    };
    return "holds " + size(data) + " texels from column " + std::to_string(std::int64_t{data.min.x} - display.min.x) +
           ", row " + std::to_string(std::int64_t{data.min.y} - display.min.y) + " of a picture of " + size(display) +
           " (data window and display window), which are read alone";
}

// Whether a decoded part is what its header announced: it has the same texels and, if any are used, the same levels.
bool is_same_picture(const Imf::Header& decoded, const Imf::Header& announced) {
    if (decoded.dataWindow() != announced.dataWindow() || !(decoded.channels() == announced.channels())) return false;
    const std::optional<Imf::TileDescription> tiles = tiles_of(announced);
    if (!tiles || tiles->mode != Imf::MIPMAP_LEVELS) return true;
    const std::optional<Imf::TileDescription> its_tiles = tiles_of(decoded);
    return its_tiles && *its_tiles == *tiles;
}

Result<std::shared_ptr<ExrReader>> open_part(InputFile& file, const ExrHeaders& headers, int part,
                                             const ReadOptions& options) {
    if (Result<Extent> base = check_header(file.path(), headers[part], *file.size(), options); !base)
        return std::move(base).error();
    if (is_decoded_here(headers[part].compression())) return ExrReader::open(file, headers, part);
    Result<InputFile> decoded = decode_with_reader(file, "exr/" + std::to_string(part), options);
    if (!decoded) return std::move(decoded).error();
    const Result<ExrHeaders> plain = ExrHeaders::read(*decoded);
    if (!plain) return plain.error();
    const Result<Extent> base = check_header(file.path(), (*plain)[0], *decoded->size(), options);
    if (!base) return base.error();
    if (!is_decoded_here((*plain)[0].compression()) || !is_same_picture((*plain)[0], headers[part]))
        return Error{ErrorCode::bad_data, file.path(), "damaged EXR: the decoder returned another picture"};
    return ExrReader::open(std::move(*decoded), *plain);
}

Result<OpenedPart> open_layer(InputFile& file, const ReadOptions& options) {
    if (Result<void> settled = file.settle(largest_file(options)); !settled) return std::move(settled).error();
    const Result<ExrHeaders> headers = ExrHeaders::read(file);
    if (!headers) return headers.error();
    Result<ExrLayer> layer = find_layer(*headers, options.layer);
    if (!layer) return std::move(layer).error();
    Result<std::shared_ptr<ExrReader>> reader = open_part(file, *headers, layer->part, options);
    if (!reader) return std::move(reader).error();
    OpenedPart opened{(*headers)[layer->part], std::move(*reader), std::move(layer->channels), {}};
    for (std::string remark : {std::move(layer->remark), window_text(opened.header)}) {
        if (!remark.empty()) opened.remarks.push_back(std::move(remark));
    }
    return opened;
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_exr_rows(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        Result<OpenedPart> opened = open_layer(file, options);
        if (!opened) return std::move(opened).error();
        std::string remark;
        for (const std::string& each : opened->remarks) remark += (remark.empty() ? "" : "; ") + each;
        return std::unique_ptr<RowSource>(std::make_unique<ExrRows>(opened->reader, opened->channels, 0, remark));
    });
}

Result<TextureRows> open_exr_texture_rows(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<TextureRows> {
        const Result<OpenedPart> opened = open_layer(file, options);
        if (!opened) return opened.error();
        Result<ExrTexture> described =
            exr_texture_of(file.path(), opened->header, opened->reader->extent(0), opened->channels);
        if (!described) return std::move(described).error();
        TextureRows texture;
        texture.head = std::move(described->head);
        for (const std::string& remark : opened->remarks) texture.head.remarks.push_back(remark);
        for (int level = 0; level < described->levels; ++level)
            texture.levels.push_back(std::make_unique<ExrRows>(opened->reader, described->channels, level));
        texture.take_planes_in_order();
        return texture;
    });
}

}  // namespace tex::inline v1
