// SPDX-License-Identifier: Apache-2.0
// Where maps are sampled, memory and threads; kernels/blend.cpp computes.

#include <tex/blend.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include <tex/mip.h>

#include "kernels/blend.h"
#include "kernels/scale.h"
#include "rows/math.h"
#include "rows/sampler.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

struct Rotation {
    double cosine = 1.0;
    double sine = 0.0;
};

// Exact for right angles.
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

// A chain, and which of its levels are sampled: `level` and, where `mix` is above 0, the next one.
struct Source {
    const MipChain& chain;
    UvMap map;
    Wrap wrap_x;
    Wrap wrap_y;
    std::size_t level = 0;
    float mix = 0.0f;
};

// The level at which `count` texels of the base level lie in one of the result, in steps of 1/256.
double level_at(double count) {
    if (!(count > 1.0)) return 0.0;
    return std::floor(math::log(count) / math::log(2.0) * 256.0 + 0.5) / 256.0;
}

// Makes the levels that are needed where the chain has none but its base level.
Result<Source> make_source(MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y, const Execution& execution) {
    const Extent extent = chain.levels.front().extent();
    const double wanted = level_at(texels_per_texel(map, extent));
    const int levels = std::min(level_count(extent), static_cast<int>(std::ceil(wanted)) + 1);
    if (chain.levels.size() == 1 && levels > 1) {
        MipOptions options;
        options.levels = levels;
        options.wrap_x = wrap_x;
        options.wrap_y = wrap_y;
        Execution silent;
        silent.threads = execution.threads;
        Result<MipChain> built = build_mip_chain(std::move(chain.levels.front()), options, silent);
        if (!built) return built.error();
        chain = std::move(*built);
    }
    Source source{chain, map, wrap_x, wrap_y};
    const double last = static_cast<double>(chain.levels.size() - 1);
    const double level = std::min(wanted, last);
    source.level = static_cast<std::size_t>(level);
    source.mix = static_cast<float>(level - std::floor(level));
    return source;
}

// Samples rows of a source, on one thread.
class RowSampler {
public:
    RowSampler(const Source& source, Extent result)
        : source_(source), width_(result.width), near_(sampler(source.level, result)) {
        if (source.mix > 0.0f) {
            far_.emplace(sampler(source.level + 1, result));
            scratch_ = Plane<float>({result.width, 1});
        }
    }

    // Unit vectors.
    void row(int j, NormalRow out) {
        near_.place(j);
        if (far_) far_->place(j);
        const VectorRow in{component(&NormalMap::x, out.x), component(&NormalMap::y, out.y),
                           component(&NormalMap::z, out.z)};
        scale_row(in, 1.0f, ScaleMode::slope, width_, out);
    }

private:
    [[nodiscard]] Sampler sampler(std::size_t level, Extent result) const {
        return {source_.chain.levels[level].extent(), result, source_.map, source_.wrap_x, source_.wrap_y};
    }

    // One component of the samples: where nothing is between texels, those of the map, else in `row`.
    const float* component(Plane<float> NormalMap::*plane, float* row) {
        const Plane<float>& texels = source_.chain.levels[source_.level].*plane;
        if (!far_ && near_.row_of(texels) != nullptr) return near_.row_of(texels);
        near_.sample(texels, row);
        if (!far_) return row;
        far_->sample(source_.chain.levels[source_.level + 1].*plane, scratch_.row(0));
        mix_row(row, scratch_.row(0), source_.mix, width_);
        return row;
    }

    const Source& source_;
    int width_;
    Sampler near_;
    std::optional<Sampler> far_;
    Plane<float> scratch_;
};

// A layer, ready to be sampled.
struct Placed {
    const Layer& layer;
    Rotation rotation;
    Source source;
};

// What one thread needs for one layer.
class LayerRows {
public:
    LayerRows(const Placed& placed, const BlendOptions& options, Extent result)
        : placed_(placed), options_(options), width_(result.width), detail_(placed.source, result),
          rows_({result.width, 4}) {
        const Plane<float>& mask = placed.layer.mask;
        if (!mask.empty()) mask_.emplace(mask.extent(), result, stretch(result), Wrap::clamp, Wrap::clamp);
    }

    void blend(int j, NormalRow base) {
        const NormalRow detail{rows_.row(0), rows_.row(1), rows_.row(2)};
        const Layer& layer = placed_.layer;
        detail_.row(j, detail);
        if (layer.scale != 1.0f) scale_row(detail, layer.scale, options_.scale_mode, width_, detail);
        if (placed_.rotation.cosine != 1.0) {
            rotate_row(detail, static_cast<float>(placed_.rotation.cosine), static_cast<float>(placed_.rotation.sine),
                       width_);
        }
        blend_row(options_.mode, base, detail, weights(j), width_);
    }

private:
    // strength mask; null where that is 1 everywhere.
    const float* weights(int j) {
        const Layer& layer = placed_.layer;
        if (!mask_ && layer.strength == 1.0f) return nullptr;
        float* weight = rows_.row(3);
        if (mask_) {
            mask_->place(j);
            mask_->sample(layer.mask, weight);
            for (int i = 0; i < width_; ++i) weight[i] = layer.strength * std::clamp(weight[i], 0.0f, 1.0f);
        } else {
            std::fill(weight, weight + width_, layer.strength);
        }
        return weight;
    }

    const Placed& placed_;
    const BlendOptions& options_;
    int width_;
    RowSampler detail_;
    std::optional<Sampler> mask_;
    Plane<float> rows_;  // x, y and z of the detail, and the weights
};

[[maybe_unused]] bool in_range(const Layer& layer) {
    const auto tiling = [](float t) { return t > 0.0f && t <= kMaxTiling; };
    const auto offset = [](float o) { return std::abs(o) <= kMaxTiling; };
    return !layer.detail.levels.empty() && std::abs(layer.scale) <= kMaxScale && tiling(layer.tiling_x) &&
           tiling(layer.tiling_y) && offset(layer.offset_x) && offset(layer.offset_y) &&
           std::isfinite(layer.rotation) && layer.strength >= 0.0f && layer.strength <= 1.0f;
}

Result<NormalMap> blend_layers(MipChain& base, std::vector<Layer>& layers, const BlendOptions& options,
                               const Execution& execution) {
    const Extent extent = options.extent == Extent{} ? base.levels.front().extent() : options.extent;
    const Result<Source> base_source = make_source(base, stretch(extent), options.wrap_x, options.wrap_y, execution);
    if (!base_source) return base_source.error();
    std::vector<Placed> placed;
    placed.reserve(layers.size());
    for (Layer& layer : layers) {
        const Rotation rotation = rotation_of(layer.rotation);
        const UvMap map = uv_map_of({layer.tiling_x, layer.tiling_y, layer.offset_x, layer.offset_y}, extent,
                                    rotation.cosine, rotation.sine);
        const Result<Source> source = make_source(layer.detail, map, layer.wrap_x, layer.wrap_y, execution);
        if (!source) return source.error();
        placed.push_back({layer, rotation, *source});
    }

    NormalMap result(extent);
    const int grain = std::max(1, (1 << 15) / extent.width);
    const auto blended = parallel_for(execution, extent.height, grain, [&](int begin, int end) {
        RowSampler base_rows(*base_source, extent);
        std::vector<LayerRows> layer_rows;
        layer_rows.reserve(placed.size());
        for (const Placed& one : placed) layer_rows.emplace_back(one, options, extent);
        for (int j = begin; j < end; ++j) {
            const NormalRow row{result.x.row(j), result.y.row(j), result.z.row(j)};
            base_rows.row(j, row);
            if (options.base_scale != 1.0f) {
                scale_row(row, options.base_scale, options.scale_mode, extent.width, row);
            }
            for (LayerRows& rows : layer_rows) rows.blend(j, row);
        }
    });
    if (!blended) return blended.error();
    return result;
}

}  // namespace

Result<NormalMap> blend(MipChain base, std::vector<Layer> layers, const BlendOptions& options,
                        const Execution& execution) {
    assert(!base.levels.empty() && std::abs(options.base_scale) <= kMaxScale);
    assert(std::all_of(layers.begin(), layers.end(), in_range));
    return guarded([&] { return blend_layers(base, layers, options, execution); });
}

}  // namespace tex
