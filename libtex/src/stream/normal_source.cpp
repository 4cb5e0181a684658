// SPDX-License-Identifier: Apache-2.0

#include "stream/normal_source.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "formats/texture_rows.h"
#include "rows/decode_rows.h"
#include "rows/unpack_rows.h"
#include "stream/extra_inspector.h"
#include "stream/filled_map.h"
#include "stream/map_inspector.h"
#include "stream/source_layout.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Turns normals that were unpacked with y up, whatever it is, so that their y points up.
Result<void> turn_up(Source& source, const SourceOptions& options) {
    const Result<YAxis> shown = measured_y(source.chain.levels.front(), options);
    if (!shown) return shown.error();
    source.info.y_axis = *shown;
    source.info.y_known = true;
    if (*shown == YAxis::up) return {};
    for (NormalMap& level : source.chain.levels) {
        for (int j = 0; j < level.extent().height; ++j) {
            float* const y = level.y.row(j);
            for (int i = 0; i < level.extent().width; ++i) y[i] = -y[i];
        }
    }
    return {};
}

// Sets SourceInfo::others, z_doubtful and not_finite.
Result<void> look_at_extras(const Texture& texture, const SourceOptions& options, Source& source,
                            const Execution& execution) {
    const int channels = format_info(texture.format).channels;
    const Result<Sources> sources = sources_of(source.info.swizzle, (1u << channels) - 1);
    if (!sources) return sources.error();
    ExtraInspector inspector(texture, texture.extent(), *sources, options);
    if (inspector.empty()) return {};
    const Level& base = texture.levels.front();
    const NormalMap& map = source.chain.levels.front();
    const int width = base.extent.width, height = base.extent.height, together = strip_rows_of(texture.format);
    const auto look = [&](int begin, int end) {
        Plane<float> strip({width, together * channels});
        const std::ptrdiff_t stride = strip.stride();
        ChannelRows rows;
        for (int c = 0; c < channels; ++c) rows.channel[c] = strip.row(c * together);
        for (int k = begin; k < end; ++k) {
            bool is_decoded = false;
            for (int j = k * together; j < std::min(height, (k + 1) * together); ++j) {
                if (!inspector.wants_row(j)) continue;
                if (!is_decoded) decode_strip(texture.format, base, k, rows, stride);
                is_decoded = true;
                const float* row[4] = {};
                for (int c = 0; c < channels; ++c) row[c] = rows.channel[c] + (j - k * together) * stride;
                inspector.add_row(j, row, {map.x.row(j), map.y.row(j), map.z.row(j)}, width);
            }
        }
    };
    const Result<void> looked = parallel_for(execution.quiet(), (height + together - 1) / together,
                                             strips_at_once(base.extent, together), look);
    if (!looked) return looked.error();
    source.info.others = inspector.report(source.info);
    return {};
}

// Looks at the base level for how z is stored. Errors: as settle_blue().
Result<void> look_at_blue(const Texture& texture, const Swizzle& swizzle, SourceOptions& options) {
    const int channels = format_info(texture.format).channels;
    const Result<Sources> sources = sources_of(swizzle, (1u << channels) - 1);
    if (!sources) return sources.error();
    const Level& base = texture.levels.front();
    const int width = base.extent.width, height = base.extent.height, together = strip_rows_of(texture.format);
    Plane<float> strip({width, together * channels});
    ChannelRows rows;
    for (int c = 0; c < channels; ++c) rows.channel[c] = strip.row(c * together);
    BlueEvidence blue;
    for (int j = 0; j < height && !blue.is_certain(); ++j) {
        if (j % together == 0) decode_strip(texture.format, base, j / together, rows, strip.stride());
        const float* row[4] = {};
        for (int c = 0; c < channels; ++c) row[c] = rows.channel[c] + j % together * strip.stride();
        blue.add_row(row, width);
    }
    return settle_blue(blue, *sources, options);
}

Result<Source> unpack_source(Texture texture, SourceOptions options, bool base_only, const Execution& execution) {
    if (base_only) texture.levels.resize(1);
    if (const Result<void> fit = check_channels(texture); !fit) return fit.error();
    Result<FoundSwizzle> found = find_swizzle(texture, options, execution);
    if (!found) return found.error();
    if (leaves_blue_open(texture, options)) {
        if (const Result<void> settled = look_at_blue(texture, found->swizzle, options); !settled)
            return settled.error();
        found->z01 = options.unpack.range == ValueRange::z01;
    }
    std::optional<Image> filled;
    if (options.fill_background) {
        Result<Image> image = decode_filled(texture, found->swizzle, options, execution);
        if (!image) return image.error();
        filled = std::move(*image);
    }
    Source source;
    source.info = source_info(texture, *found, options);
    UnpackOptions unpacking = unpack_options(source.info, options);
    if (options.drop_others) unpacking.others = {};
    if (options.measure_y) unpacking.y_axis = YAxis::up;
    if (filled) {
        unpacking.range = range_of(texture.normal_encoding, unpacking);
        Result<NormalMap> map = unpack(*filled, unpacking, execution);
        if (!map) return map.error();
        source.chain.levels.push_back(std::move(*map));
    } else {
        Result<MipChain> chain = unpack(texture, unpacking, execution);
        if (!chain) return chain.error();
        source.chain = std::move(*chain);
    }
    if (options.measure_y) {
        if (const Result<void> turned = turn_up(source, options); !turned) return turned.error();
    }
    inspect(source.chain.levels.front(), options, source.info);
    if (options.inspect) {
        const Result<void> looked = look_at_extras(texture, options, source, execution);
        if (!looked) return looked.error();
    }
    return source;
}

}  // namespace

Result<Source> read_normals(MapSource& map, const SourceOptions& options, bool base_only, const Execution& execution) {
    Result<Texture> texture = map.read(base_only, execution);
    if (!texture) return texture.error().of(map.path());
    Result<Source> source = unpack_source(std::move(*texture), options, base_only, execution);
    if (!source) return source.error().of(map.path());
    return source;
}

}  // namespace tex::inline v1
