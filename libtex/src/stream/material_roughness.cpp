// SPDX-License-Identifier: Apache-2.0

#include "stream/material_roughness.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <tex/pack.h>
#include <tex/types.h>

#include "kernels/roughness.h"
#include "rows/mip_rows.h"
#include "rows/sampler.h"

namespace tex::inline v1 {
namespace {

int strip_rows(Extent extent) { return std::max(1, (1 << 15) / extent.width); }

Result<Plane<float>> alpha2_of(const Plane<float>& roughness, const Execution& execution, ProgressSpan span) {
    const Extent extent = roughness.extent();
    Plane<float> alpha2(extent);
    const auto clean = [&](int begin, int end) {
        Plane<float> unused(Extent{extent.width, 1});
        for (int j = begin; j < end; ++j) clean_roughness(roughness.row(j), extent.width, unused.row(0), alpha2.row(j));
    };
    if (auto done = parallel_for(execution, extent.height, strip_rows(extent), clean, span); !done) return done.error();
    return alpha2;
}

Result<Plane<float>> halved(const Plane<float>& from, const MipOptions& options, const Execution& execution,
                            ProgressSpan span) {
    const LevelFilter filter(from.extent(), options);
    Plane<float> to(filter.to);
    const auto halve = [&](int begin, int end) {
        MipRows made(filter);
        std::vector<const float*> rows(static_cast<std::size_t>(filter.y.taps));
        for (int j = begin; j < end; ++j) {
            for (int k = 0; k < filter.y.taps; ++k) rows[static_cast<std::size_t>(k)] = from.row(filter.source(j, k));
            made.make(rows.data(), j, to.row(j));
        }
    };
    const auto done = parallel_for(execution, to.extent().height, strip_rows(to.extent()), halve, span);
    if (!done) return done.error();
    return to;
}

Result<Plane<float>> stretched(Plane<float> alpha2, Extent extent, const MipOptions& options,
                               const Execution& execution, ProgressSpan span) {
    while (alpha2.extent().width >= 2 * extent.width && alpha2.extent().height >= 2 * extent.height) {
        auto half = halved(alpha2, options, execution, {span.from, span.from});
        if (!half) return half.error();
        alpha2 = std::move(*half);
    }
    Plane<float> result(extent);
    const auto sample = [&](int begin, int end) {
        Sampler sampler(alpha2.extent(), extent, stretch(extent), options.wrap_x, options.wrap_y);
        for (int j = begin; j < end; ++j) {
            sampler.place(j);
            sampler.sample(alpha2, result.row(j));
        }
    };
    auto sampled = parallel_for(execution, extent.height, strip_rows(extent), sample, span);
    if (!sampled) return sampled.error();
    return result;
}

}  // namespace

MaterialRoughness::MaterialRoughness(float value, int width) : width_(width), everywhere_(Extent{width, 1}, value) {}

Result<MaterialRoughness> MaterialRoughness::of(const Plane<float>& map, Extent base, const MipOptions& options,
                                                const Execution& execution, ProgressSpan span) {
    MaterialRoughness own;
    own.width_ = base.width;
    if (map.extent() == base) {
        own.map_ = &map;
        return own;
    }
    const double middle = (span.from + span.to) / 2.0;
    auto alpha2 = alpha2_of(map, execution, {span.from, middle});
    if (!alpha2) return alpha2.error();
    auto sampled = stretched(std::move(*alpha2), base, options, execution, {middle, span.to});
    if (!sampled) return sampled.error();
    own.alpha2_ = std::move(*sampled);
    return own;
}

Result<KeptChannels> kept_channels(const Texture& texture, Extent base, int first, int levels,
                                   const MipOptions& options, const Execution& execution) {
    if (texture.extent() != base) {
        const auto text = [](Extent extent) {
            return std::to_string(extent.width) + "x" + std::to_string(extent.height);
        };
        return Error{ErrorCode::bad_data,
                     {},
                     "the texture for roughness is " + text(texture.extent()) + ", the normal map " + text(base) +
                         "; both must have the same size"};
    }
    KeptChannels kept;
    for (int k = 0; k < first + levels; ++k) {
        ChannelPlanes& planes = kept.levels.emplace_back();
        if (static_cast<std::size_t>(k) < texture.levels.size()) {
            Result<Image> image = decode(texture, k, execution);
            if (!image) return image.error();
            for (std::size_t c = 0; c < std::min(planes.size(), image->planes.size()); ++c)
                planes[c] = std::move(image->planes[c]);
            continue;
        }
        const ChannelPlanes& larger = kept.levels[static_cast<std::size_t>(k) - 1];
        for (std::size_t c = 0; c < planes.size(); ++c) {
            if (larger[c].empty()) continue;
            Result<Plane<float>> half = halved(larger[c], options, execution, {0.0, 0.0});
            if (!half) return half.error();
            planes[c] = std::move(*half);
        }
    }
    kept.levels.erase(kept.levels.begin(), kept.levels.begin() + first);
    return kept;
}

void MaterialRoughness::row(int j, float* roughness, float* alpha2) const {
    if (alpha2_.empty()) {
        clean_roughness(map_ == nullptr ? everywhere_.row(0) : map_->row(j), width_, roughness, alpha2);
        return;
    }
    std::copy_n(alpha2_.row(j), width_, alpha2);
    roughness_of_alpha2(alpha2, width_, roughness);
}

}  // namespace tex::inline v1
