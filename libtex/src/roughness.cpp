// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads; kernels/roughness.cpp computes, and the filters are those of mip.cpp. Besides its result,
// the chain keeps the averages of two levels.

#include <tex/roughness.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "blocks/extent.h"
#include "kernels/roughness.h"
#include "rows/mip_rows.h"
#include "rows/roughness_rows.h"
#include "rows/usable.h"
#include "stream/own_roughness.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

constexpr std::size_t kAlpha2 = 3;  // after x, y and z

// x, y, z and alpha^2 of a level, not normalised.
using Averages = std::array<Plane<float>, 4>;
using AverageViews = std::array<PlaneView<const float>, 4>;

AverageViews views_of(const Averages& averages) {
    return {averages[0].view(), averages[1].view(), averages[2].view(), averages[3].view()};
}

// Filters rows [begin, end) of a plane of the next level.
void filter_strip(const LevelFilter& filter, PlaneView<const float> from, Plane<float>& to, int begin, int end) {
    MipRows rows(filter);
    std::vector<const float*> window(static_cast<std::size_t>(filter.y.taps));
    for (int j = begin; j < end; ++j) {
        for (int k = 0; k < filter.y.taps; ++k) window[static_cast<std::size_t>(k)] = from.row(filter.source(j, k));
        rows.make(window.data(), j, to.row(j));
    }
}

// Computes the material's own roughness and alpha^2 at the base level.
Result<void> fill_base(const Plane<float>& own, const MipOptions& options, const Execution& execution,
                       ProgressSpan span, Plane<float>& roughness, Plane<float>& alpha2) {
    const Extent extent = roughness.extent();
    const double middle = own.extent() == extent ? span.from : (span.from + span.to) / 2.0;
    const auto rows = OwnRoughness::of(own, extent, options, execution, {span.from, middle});
    if (!rows) return rows.error();
    const auto fill = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) rows->row(j, roughness.row(j), alpha2.row(j));
    };
    return parallel_for(execution, extent.height, rows_per_piece(extent), fill, {middle, span.to});
}

Result<RoughnessChain> build_chain(const NormalMap& base, const Plane<float>& roughness, RoughnessModel model,
                                   const MipOptions& options, const Execution& execution) {
    const Extent extent = base.extent();
    const int first = first_level(options, extent);
    const int count = first + levels_to_build(options, extent);
    double done = count > 1 ? 0.1 : 1.0;
    RoughnessChain chain;
    Plane<float> alpha2(extent);
    const auto filled =
        fill_base(roughness, options, execution, {0.0, done}, chain.levels.emplace_back(extent), alpha2);
    if (!filled) return filled.error();

    AverageViews from = {base.x.view(), base.y.view(), base.z.view(), alpha2.view()};
    Averages held;  // the data that `from` shows, below the base level
    for (int level = 1; level < count; ++level) {
        const Extent smaller = level_extent(extent, level);
        Averages to;
        for (Plane<float>& plane : to) plane = Plane<float>(smaller);
        Plane<float>& rougher = chain.levels.emplace_back(smaller);
        const LevelFilter filter(from[0].extent, options);
        const auto strip = [&](int begin, int end) {
            for (std::size_t plane = 0; plane < to.size(); ++plane)
                filter_strip(filter, from[plane], to[plane], begin, end);
            for (int j = begin; j < end; ++j) {
                roughness_of_averages(model, to[0].row(j), to[1].row(j), to[2].row(j), to[kAlpha2].row(j),
                                      smaller.width, rougher.row(j));
            }
        };
        const double next = level + 1 < count ? done + (1.0 - done) * 0.75 : 1.0;
        const auto made = parallel_for(execution, smaller.height, rows_per_piece(smaller), strip, {done, next});
        if (!made) return made.error();
        held = std::move(to);
        from = views_of(held);
        done = next;
    }
    chain.levels.erase(chain.levels.begin(), chain.levels.begin() + first);
    return chain;
}

Result<Texture> pack_chain(const RoughnessChain& chain, Format format, Effort effort, const Execution& execution) {
    Texture texture;
    texture.format = format;
    texture.swizzle = kRoughnessSwizzle;
    double done = 0.0;
    for (const Plane<float>& plane : chain.levels) {
        Level level{plane.extent(), std::vector<std::byte>(level_bytes(format, plane.extent()))};
        const bool last = &plane == &chain.levels.back();
        const double next = last ? 1.0 : done + (1.0 - done) * 0.75;
        const int grain = whole_blocks(rows_per_piece(plane.extent()));
        const auto packed = parallel_for(execution, plane.extent().height, grain,
                                         [&](int begin, int end) {
                                             pack_roughness_rows(plane, plane.extent().height, format, effort, begin,
                                                                 end, level.bytes.data());
                                         },
                                         {done, next});
        if (!packed) return packed.error();
        texture.levels.push_back(std::move(level));
        done = next;
    }
    return texture;
}

}  // namespace

Result<RoughnessChain> build_roughness_chain(const NormalMap& base, const Plane<float>& roughness, RoughnessModel model,
                                             const MipOptions& options, const Execution& execution) {
    return guarded([&]() -> Result<RoughnessChain> {
        if (auto usable = check_usable(base); !usable) return usable.error();
        if (auto usable = check_usable(roughness.extent(), "the roughness map"); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        return build_chain(base, roughness, model, options, execution);
    });
}

Result<Texture> pack_roughness(const RoughnessChain& chain, Format format, Effort effort, const Execution& execution) {
    constexpr Format kFormats[] = {Format::bc4_unorm, Format::eac_r11_unorm, Format::r8_unorm,
                                   Format::r16_unorm, Format::r16_float,     Format::r32_float};
    return guarded([&]() -> Result<Texture> {
        if (chain.levels.empty()) return bad_option("the chain has no level");
        if (std::find(std::begin(kFormats), std::end(kFormats), format) == std::end(kFormats)) {
            return Error{
                ErrorCode::bad_option,
                {},
                "roughness goes into formats of one channel, not " + std::string(name_of(kFormatNames, format))};
        }
        return pack_chain(chain, format, effort, execution);
    });
}

}  // namespace tex
