// SPDX-License-Identifier: Apache-2.0

#include "rows/blend_rows.h"

#include <algorithm>
#include <cmath>

#include "kernels/blend.h"
#include "kernels/scale.h"
#include "rows/math.h"

namespace tex::inline v1 {

Rotation rotation_of(float degrees) {
    const double turn = std::fmod(static_cast<double>(degrees), 360.0);
    const double positive = turn < 0.0 ? turn + 360.0 : turn;
    if (positive == 0.0 || positive == 360.0) return {1.0, 0.0};
    if (positive == 90.0) return {0.0, 1.0};
    if (positive == 180.0) return {-1.0, 0.0};
    if (positive == 270.0) return {0.0, -1.0};
    const double radians = positive * (math::kPi / 180.0);
    return {math::cos(radians), math::sin(radians)};
}

UvMap uv_map_of(const Layer& layer, Extent result) {
    const Rotation rotation = rotation_of(layer.rotation);
    return uv_map_of({layer.tiling_x, layer.tiling_y, layer.offset_x, layer.offset_y}, result, rotation.cosine,
                     rotation.sine);
}

double level_wanted(const UvMap& map, Extent source) {
    const double count = texels_per_texel(map, source);
    if (!(count > 1.0)) return 0.0;
    return std::floor(math::log(count) / math::log(2.0) * 256.0 + 0.5) / 256.0;
}

// Samples rows of a map.
class BlendRows::MapSampler {
public:
    MapSampler(const PlacedMap& map, Extent result)
        : map_(map), width_(result.width), near_(sampler(map.level, result)) {
        if (map.mix > 0.0f) {
            far_.emplace(sampler(map.level + 1, result));
            scratch_ = Plane<float>({result.width, 1});
        }
    }

    // Makes unit vectors.
    void row(int j, NormalRow out) {
        near_.place(j);
        if (far_) far_->place(j);
        scale_row(map_.chain == nullptr ? between_rows(out) : between_texels(out), 1.0f, ScaleMode::slope, width_, out);
    }

    // Whether there are texels of an extra channel.
    [[nodiscard]] bool has(Extra extra) const {
        return map_.chain != nullptr && !map_.chain->levels.front()[extra].empty();
    }
    // Samples an extra channel at the row that was made last.
    void extra(Extra extra, float* out) {
        const float* const made = samples(
            [extra](const NormalMap& map) -> auto& { return map[extra]; }, out);
        if (made != out) std::copy_n(made, width_, out);
    }

private:
    [[nodiscard]] Sampler sampler(std::size_t level, Extent result) const {
        const Extent extent = map_.chain == nullptr ? map_.extent : map_.chain->levels[level].extent();
        return {extent, result, map_.map, map_.wrap_x, map_.wrap_y};
    }

    // Returns samples between two rows. They are in `out` unless they equal a row of the map.
    VectorRow between_rows(NormalRow out) {
        const Sampler::Rows rows = near_.rows();
        const VectorRow upper = map_.rows(rows.upper);
        if (near_.is_whole()) return upper;
        const VectorRow lower = map_.rows(rows.lower);
        near_.sample(upper.x, lower.x, out.x);
        near_.sample(upper.y, lower.y, out.y);
        near_.sample(upper.z, lower.z, out.z);
        return {out.x, out.y, out.z};
    }
    VectorRow between_texels(NormalRow out) {
        return {samples(
                    [](const NormalMap& map) -> auto& { return map.x; }, out.x),
                samples(
                    [](const NormalMap& map) -> auto& { return map.y; }, out.y),
                samples(
                    [](const NormalMap& map) -> auto& { return map.z; }, out.z)};
    }
    template <class PlaneOf>
    const float* samples(const PlaneOf& plane_of, float* row) {
        const Plane<float>& texels = plane_of(map_.chain->levels[map_.level]);
        if (!far_ && near_.row_of(texels) != nullptr) return near_.row_of(texels);
        near_.sample(texels, row);
        if (!far_) return row;
        far_->sample(plane_of(map_.chain->levels[map_.level + 1]), scratch_.row(0));
        mix_row(row, scratch_.row(0), map_.mix, width_);
        return row;
    }

    const PlacedMap& map_;
    int width_;
    Sampler near_;
    std::optional<Sampler> far_;
    Plane<float> scratch_;
};

class BlendRows::LayerRows {
public:
    LayerRows(const PlacedLayer& placed, const BlendOptions& options, Extent result)
        : layer_(placed.layer), rotation_(rotation_of(layer_.rotation)), options_(options), width_(result.width),
          detail_(placed.detail, result), rows_({result.width, 5}) {
        const Plane<float>& mask = layer_.mask;
        if (!mask.empty()) mask_.emplace(mask.extent(), result, stretch(result), Wrap::clamp, Wrap::clamp);
    }

    void blend(int j, NormalRow base) {
        const NormalRow detail{rows_.row(0), rows_.row(1), rows_.row(2)};
        detail_.row(j, detail);
        if (layer_.scale != 1.0f) scale_row(detail, layer_.scale, options_.scale_mode, width_, detail);
        if (rotation_.cosine != 1.0) {
            rotate_row(detail, static_cast<float>(rotation_.cosine), static_cast<float>(rotation_.sine), width_);
        }
        blend_row(options_.mode, base, detail, weights(j), width_);
    }

    // Mixes the detail's channel into that of the base, at the row that was blended last.
    void mix_extra(Extra extra, float* base) {
        if (!mask_ || !detail_.has(extra)) return;
        float* const detail = rows_.row(4);
        const float* const weight = rows_.row(3);
        detail_.extra(extra, detail);
        for (int i = 0; i < width_; ++i) base[i] += weight[i] * (detail[i] - base[i]);
    }

private:
    // Returns strength * mask, or null if that is 1 everywhere.
    const float* weights(int j) {
        if (!mask_ && layer_.strength == 1.0f) return nullptr;
        float* weight = rows_.row(3);
        if (mask_) {
            mask_->place(j);
            mask_->sample(layer_.mask, weight);
            for (int i = 0; i < width_; ++i) weight[i] = layer_.strength * std::clamp(weight[i], 0.0f, 1.0f);
        } else {
            std::fill(weight, weight + width_, layer_.strength);
        }
        return weight;
    }

    const Layer& layer_;
    Rotation rotation_;
    const BlendOptions& options_;
    int width_;
    MapSampler detail_;
    std::optional<Sampler> mask_;
    Plane<float> rows_;  // x, y and z of the detail, the weights, and an extra channel of the detail
};

BlendRows::BlendRows(const PlacedMaps& maps) : maps_(maps) {
    base_.emplace_back(maps.base, maps.extent);
    layers_.reserve(maps.layers.size());
    for (const PlacedLayer& layer : maps.layers) layers_.emplace_back(layer, maps.options, maps.extent);
}

BlendRows::~BlendRows() = default;
BlendRows::BlendRows(BlendRows&&) noexcept = default;

void BlendRows::make(int j, NormalRow out) {
    base_.front().row(j, out);
    const BlendOptions& options = maps_.options;
    if (options.base_scale != 1.0f) scale_row(out, options.base_scale, options.scale_mode, maps_.extent.width, out);
    for (LayerRows& layer : layers_) layer.blend(j, out);
}

void BlendRows::make_extra(Extra extra, const float* base, float* out) {
    if (base == nullptr)
        base_.front().extra(extra, out);
    else
        std::copy_n(base, maps_.extent.width, out);
    for (LayerRows& layer : layers_) layer.mix_extra(extra, out);
}

}  // namespace tex::inline v1
