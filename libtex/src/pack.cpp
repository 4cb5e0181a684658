// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

#include "fields/field_check.h"
#include "fields/pack_fields.h"
#include "kernels/encode.h"
#include "rows/codecs.h"
#include "rows/extra_rows.h"
#include "rows/pack_rows.h"
#include "rows/rdo_rows.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// The number of texels in a piece of work: enough to be worth passing to a thread, few enough to stay in its cache.

Result<Texture> pack_chain(const MipChain& chain, const PackOptions& options, const Execution& execution,
                           RdoTally* tally) {
    const EncodingInfo encoding = encoding_info(options.encoding);
    Texture texture;
    texture.format = encoding.format;
    const ExtraSet extras = extras_of(chain.levels[0]);
    texture.swizzle = swizzle_with(options.encoding, extras);
    texture.swizzle_known = true;
    texture.y_axis = options.y_axis;
    texture.y_known = options.y_known;

    const int band_rows = rdo_band_rows(options, chain.levels[0].extent().width);
    std::int64_t total = 0;
    for (const NormalMap& map : chain.levels) total += map.extent().texels();
    std::int64_t done = 0;
    for (std::size_t level = 0; level < chain.levels.size(); ++level) {
        const NormalMap& map = chain.levels[level];
        const Extent extent = map.extent();
        Level packed;
        packed.extent = extent;
        packed.bytes.resize(level_bytes(texture.format, extent));
        const int block = format_info(texture.format).block.height;
        const int together = is_optimised(options) ? band_rows : block;
        const RdoBands bands{band_rows, extent};
        const int grain = std::max(1, kPieceTexels / extent.width / together) * together;
        const auto fraction = [&] { return static_cast<double>(done) / static_cast<double>(total); };
        ProgressSpan span;
        span.from = fraction();
        done += extent.texels();
        span.to = fraction();
        const Result<void> result = parallel_for(
            execution, extent.height, grain,
            [&](int begin, int end) {
                pack_rows(map, extras, extent.height, options, begin, end, packed.bytes.data(), bands, tally);
            },
            span);
        if (!result) return result.error();
        texture.levels.push_back(std::move(packed));
    }
    return texture;
}

}  // namespace

Result<void> validate(const PackOptions& options) { return check_fields(options); }

Result<PackedTexture> pack(const MipChain& chain, const PackOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<PackedTexture> {
        if (auto usable = check_usable(chain); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        if (auto fit = check_together(extras_of(chain.levels.front())); !fit) return fit.error();
        RdoTally tally;
        Result<Texture> texture = pack_chain(chain, options, execution, &tally);
        if (!texture) return texture.error();
        return PackedTexture{std::move(*texture), is_optimised(options) ? report_of(tally.sum()) : RdoReport()};
    });
}

Result<void> encode_blocks(PlaneView<const float> x, PlaneView<const float> y, const PackOptions& options,
                           std::byte* blocks, std::size_t pitch) {
    const Extent extent = x.extent;
    if (extent != y.extent || extent.width < 1 || extent.height < 1)
        return bad_option("x, y: must have the same extent, at least 1x1");
    if (codec_of(options.encoding).encode_halves == nullptr)
        return bad_option("encoding: must be of blocks with x and y in a half each");
    if (pitch < level_bytes(encoding_info(options.encoding).format, {extent.width, 1}))
        return bad_option("pitch: too small for a row of blocks");
    for (int j = 0; j < extent.height; j += kBlockEdge, blocks += pitch)
        encode_blocks(block_row(x, y, extent, j, options.y_axis == YAxis::down), options, blocks);
    return {};
}

}  // namespace tex::inline v1
