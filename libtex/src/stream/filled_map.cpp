// SPDX-License-Identifier: Apache-2.0

#include "stream/filled_map.h"

#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <tex/pack.h>

#include "checks/background.h"
#include "formats/row_source.h"
#include "rows/unpack_rows.h"
#include "stream/map_source.h"
#include "stream/source_layout.h"
#include "stream/source_stage.h"
#include "surface/nearest.h"

namespace tex::inline v1 {
namespace {

// Rows of decoded channels in memory, which must outlive them.
class DecodedRows final : public RowSource {
public:
    explicit DecodedRows(const Image& image) : image_(image) {
        const Extent extent = image_.extent();
        plane_bytes_ = static_cast<std::size_t>(extent.width) * sizeof(float);
        describe(extent, image_.names, plane_bytes_ * image_.planes.size(), image_.sample, image_.bits);
        head_.normal_encoding = image_.normal_encoding;
    }

    [[nodiscard]] bool is_random() const override { return true; }
    Result<void> decode(int first, int count, std::byte* rows) override {
        for (int j = first; j < first + count; ++j) {
            for (const Plane<float>& plane : image_.planes) {
                std::memcpy(rows, plane.row(j), plane_bytes_);
                rows += plane_bytes_;
            }
        }
        return {};
    }
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        for (int j = first; j < end; ++j) {
            for (std::size_t c = 0; c < image_.planes.size(); ++c) {
                std::memcpy(image.planes[c].row(j), rows, plane_bytes_);
                rows += plane_bytes_;
            }
        }
    }

private:
    const Image& image_;
    std::size_t plane_bytes_ = 0;
};

Result<void> fill_holes(const Stored& stored, const Background& background, Image& image, const Execution& execution) {
    const Extent extent = image.extent();
    Plane<float> holes(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i)
            holes.at(i, j) = background.holds(i, j) ? std::numeric_limits<float>::quiet_NaN() : 0.0f;
    }
    // A chart at one border is no neighbour of the background at the other.
    return visit_holes(holes.view(), Wrap::clamp, Wrap::clamp, execution, {}, [&](const NearestTexel& hole) {
        for (const Component component : {Component::x, Component::y, Component::z}) {
            const int channel = stored.channel(component);
            if (channel < 0) continue;
            Plane<float>& plane = image.planes[static_cast<std::size_t>(channel)];
            plane.at(hole.i, hole.j) = plane.at(hole.column, hole.row);
        }
    });
}

class FilledMap final : public MapSource {
public:
    FilledMap(MapSource& map, const SourceOptions& options, const Execution& execution)
        : map_(map), options_(options), execution_(execution.quiet()) {}

    [[nodiscard]] const std::string& path() const override { return map_.path(); }
    Result<void> open() override {
        if (rows_) return {};
        Result<Texture> texture = map_.read(true, execution_);
        if (!texture) return texture.error();
        if (Result<void> fit = check_channels(*texture); !fit) return fit;
        const Result<FoundSwizzle> found = find_swizzle(*texture, options_, execution_);
        if (!found) return found.error();
        Result<Image> image = decode_filled(*texture, found->swizzle, options_, execution_);
        if (!image) return image.error();
        image_ = std::move(*image);
        swizzle_ = found->swizzle;
        head_ = std::move(*texture);
        head_.levels.clear();
        rows_.emplace(image_);
        return {};
    }
    [[nodiscard]] const Texture& head() const override { return head_; }
    [[nodiscard]] std::optional<Swizzle> found_swizzle() const override { return swizzle_; }
    [[nodiscard]] int levels() const override { return 1; }
    [[nodiscard]] Extent extent(int) const override { return rows_->extent(); }
    StoredChannels add_to(Flow& flow, int, const std::vector<bool>&) override {
        StoredChannels channels{&add_source(flow, *rows_, path()), {}};
        for (std::size_t c = 0; c < image_.planes.size(); ++c) channels.planes.push_back(c);
        return channels;
    }
    Result<void> look(const TakeChannels& take) override {
        bool goes_on = true;
        for (int j = 0; j < extent(0).height && goes_on; ++j) {
            const float* channels[4] = {};
            for (std::size_t c = 0; c < image_.planes.size(); ++c) channels[c] = image_.planes[c].row(j);
            goes_on = take(channels);
        }
        return {};
    }
    Result<Texture> read(bool, const Execution& execution) override { return map_.read(true, execution); }
    Error after_all_rows(const Error& error) override { return error; }

private:
    MapSource& map_;
    const SourceOptions& options_;
    const Execution execution_;
    Texture head_;
    std::optional<Swizzle> swizzle_;
    Image image_;
    std::optional<DecodedRows> rows_;
};

}  // namespace

Result<Image> decode_filled(Texture& texture, const Swizzle& swizzle, const SourceOptions& options,
                            const Execution& execution) {
    const Execution silent = execution.quiet();
    Result<Image> image = decode(texture, 0, silent);
    if (!image) return image;
    const Stored stored{&*image, swizzle,
                        stores_signed(*image, swizzle, range_of(texture.normal_encoding, options.unpack)),
                        format_info(texture.format).has_blocks()};
    if (stored.channel(Component::x) < 0 || stored.channel(Component::y) < 0) return image;
    const Result<std::optional<Background>> background = find_background(stored, silent);
    if (!background) return background.error();
    if (!*background || (*background)->masked == texture.extent().texels()) {
        texture.remarks.emplace_back("has no background to fill");
        return image;
    }
    if (Result<void> filled = fill_holes(stored, **background, *image, silent); !filled) return filled.error();
    return image;
}

std::unique_ptr<MapSource> filled(MapSource& map, const SourceOptions& options, const Execution& execution) {
    return std::make_unique<FilledMap>(map, options, execution);
}

}  // namespace tex::inline v1
