// SPDX-License-Identifier: Apache-2.0

#include "stream/filled_map.h"

#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <tex/unpack.h>

#include "checks/background.h"
#include "formats/row_source.h"
#include "rows/unpack_rows.h"
#include "stream/source_layout.h"
#include "surface/nearest.h"

namespace tex {
namespace {

// Rows of decoded channels in memory.
class ChannelRows final : public RowSource {
public:
    explicit ChannelRows(Image image) : image_(std::move(image)) {
        const Extent extent = image_.extent();
        plane_bytes_ = static_cast<std::size_t>(extent.width) * sizeof(float);
        describe(extent, image_.names, plane_bytes_ * image_.planes.size());
        describe_samples(image_.sample, image_.bits, image_.normal_encoding);
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
    const Image image_;
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

}  // namespace

Result<Image> decode_filled(Texture& texture, const Swizzle& swizzle, const SourceOptions& options,
                            const Execution& execution) {
    const Execution silent{execution.threads, {}};
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

Result<TextureRows> fill_background(Result<TextureRows> map, const SourceOptions& options, const Execution& execution) {
    if (!map) return map;
    map->levels.resize(1);
    Result<Texture> texture = read_all(std::move(map));
    if (!texture) return texture.error();
    if (const Result<void> fit = check_channels(*texture); !fit) return fit.error();
    const Result<Swizzle> swizzle = find_swizzle(*texture, options, execution);
    if (!swizzle) return swizzle.error();
    Result<Image> image = decode_filled(*texture, *swizzle, options, execution);
    if (!image) return image.error();
    TextureRows rows;
    texture->levels.clear();
    rows.head = std::move(*texture);
    rows.levels.push_back(std::make_unique<ChannelRows>(std::move(*image)));
    rows.take_planes_in_order();
    return rows;
}

}  // namespace tex
