// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads; kernels/roughness.cpp computes, and the filters are those of mip.cpp.

#include <tex/mip.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "blocks/extent.h"
#include "rows/mip_rows.h"
#include "rows/roughness_rows.h"
#include "rows/usable.h"
#include "stream/extra_levels.h"
#include "stream/material_roughness.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Computes the material's own roughness and alpha^2 at the base level.
Result<void> fill_base(const Plane<float>& own, const MipOptions& options, const Execution& execution,
                       ProgressSpan span, Plane<float>& roughness, Plane<float>& alpha2) {
    const Extent extent = roughness.extent();
    const double middle = own.extent() == extent ? span.from : (span.from + span.to) / 2.0;
    const auto rows = MaterialRoughness::of(own, extent, options, execution, {span.from, middle});
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
    const double done = count > 1 ? 0.1 : 1.0;
    RoughnessChain chain;
    Plane<float> alpha2(extent);
    const auto filled =
        fill_base(roughness, options, execution, {0.0, done}, chain.levels.emplace_back(extent), alpha2);
    if (!filled) return filled.error();

    auto smaller =
        smaller_levels(base, std::move(alpha2), ExtraKind::roughness, model, options, count, execution, {done, 1.0});
    if (!smaller) return smaller.error();
    for (Plane<float>& level : *smaller) chain.levels.push_back(std::move(level));
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
        const int grain = whole_blocks(rows_per_piece(plane.extent()), format_info(format).block.height);
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
    return no_throw(execution, [&]() -> Result<RoughnessChain> {
        if (auto usable = check_usable(base); !usable) return usable.error();
        if (auto usable = check_usable(roughness.extent(), "the roughness map"); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        return build_chain(base, roughness, model, options, execution);
    });
}

Result<Texture> pack_roughness(const RoughnessChain& chain, Format format, Effort effort, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Texture> {
        if (chain.levels.empty()) return bad_option("the chain has no level");
        if (!is_single_roughness(format)) {
            return Error{
                ErrorCode::bad_option,
                {},
                "roughness goes into formats of one channel, not " + std::string(name_of(kFormatNames, format))};
        }
        return pack_chain(chain, format, effort, execution);
    });
}

}  // namespace tex::inline v1
