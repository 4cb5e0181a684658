// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "blocks/extent.h"
#include "formats/level_planes.h"
#include "kernels/unpack.h"
#include "rows/channel_names.h"
#include "rows/codecs.h"
#include "rows/decode_rows.h"
#include "rows/extra_rows.h"
#include "rows/stored_rows.h"
#include "rows/unpack_rows.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kChannelNames[] = {"R", "G", "B", "A"};
constexpr int kMostStripRows = 12;  // the greatest height of a block

// The rows of one strip, padded to whole vectors: in each, the channels. Those that are not read are null.
struct StripRows {
    const float* row[kMostStripRows][4] = {};
};

// Provides the rows of a texture's level, decoded to scratch memory.
struct LevelReader {
    Format format;
    const Level& level;
    Sources sources;
    ExtraSet extras;

    [[nodiscard]] Extent extent() const { return level.extent; }
    [[nodiscard]] int strip_rows() const { return strip_rows_of(format); }

    StripRows read(int strip, Plane<float>& scratch) const {
        const std::array<bool, 4> wanted = channels_read(sources, extras);
        ChannelRows rows;
        StripRows out;
        for (int c = 0; c < 4; ++c) {
            if (!wanted[static_cast<std::size_t>(c)]) continue;
            rows.channel[c] = scratch.row(c * strip_rows());
            for (int r = 0; r < strip_rows(); ++r) out.row[r][c] = scratch.row(c * strip_rows() + r);
        }
        decode_strip(format, level, strip, rows, scratch.stride());
        return out;
    }
};

// Provides the rows of planes unchanged.
struct ImageReader {
    const std::array<const Plane<float>*, 4>& planes;  // those that are not there are null
    Sources sources;

    [[nodiscard]] Extent extent() const { return planes[static_cast<std::size_t>(sources.x)]->extent(); }
    [[nodiscard]] int strip_rows() const { return kBlockEdge; }

    StripRows read(int strip, Plane<float>&) const {
        const int first = strip * strip_rows();
        StripRows out;
        for (std::size_t c = 0; c < 4; ++c) {
            for (int r = 0; planes[c] != nullptr && r < strip_rows() && first + r < extent().height; ++r)
                out.row[r][c] = planes[c]->row(first + r);
        }
        return out;
    }
};

Plane<float> make_scratch(Extent extent, int rows) { return Plane<float>({whole_blocks(extent.width), rows}); }

// Whether floats are (n + 1) / 2: see unpack().
template <class Reader>
Result<bool> weigh_range(const Reader& reader, const Execution& execution) {
    const Extent extent = reader.extent();
    std::vector<RangeEvidence> rows(static_cast<std::size_t>(extent.height));
    std::atomic<bool> negative = false;  // one negative value decides
    Execution silent;
    silent.threads = execution.threads;
    const int strip_rows = reader.strip_rows();
    const int strips = blocks_across(extent.height, strip_rows);
    const auto weighed = parallel_for(silent, strips, strips_at_once(extent, strip_rows), [&](int begin, int end) {
        Plane<float> scratch = make_scratch(extent, 4 * strip_rows);
        for (int strip = begin; strip < end && !negative; ++strip) {
            const StripRows held = reader.read(strip, scratch);
            const int first = strip * strip_rows;
            for (int r = 0; r < std::min(strip_rows, extent.height - first); ++r) {
                RangeEvidence& row = rows[static_cast<std::size_t>(first) + static_cast<std::size_t>(r)];
                const VectorRow vectors = vectors_of(held.row[r], reader.sources);
                row = weigh_row(vectors.x, vectors.y, vectors.z, extent.width);
                if (row.negative) negative = true;
            }
        }
    });
    if (!weighed) return weighed.error();
    if (negative) return false;
    RangeEvidence sum;
    for (const RangeEvidence& row : rows) sum.add(row);
    return sum.says_unsigned();
}

template <class Reader>
Result<bool> is_unsigned(const Reader& reader, SampleKind sample, ValueRange range, const Execution& execution) {
    if (const std::optional<bool> known = is_unsigned(sample, range)) return *known;
    return weigh_range(reader, execution);
}

template <class Reader>
Result<void> unpack_rows(const Reader& reader, const UnpackRule& rule, ExtraSet extras, NormalMap& map,
                         const Execution& execution, ProgressSpan span) {
    const Extent extent = reader.extent();
    map = NormalMap(extent);
    add_planes(map, extras);
    const int strip_rows = reader.strip_rows();
    return parallel_for(
        execution, blocks_across(extent.height, strip_rows), strips_at_once(extent, strip_rows),
        [&](int begin, int end) {
            Plane<float> scratch = make_scratch(extent, 4 * strip_rows);
            for (int strip = begin; strip < end; ++strip) {
                const StripRows rows = reader.read(strip, scratch);
                for (int r = 0; r < strip_rows && strip * strip_rows + r < extent.height; ++r) {
                    const int j = strip * strip_rows + r;
                    const VectorRow vectors = vectors_of(rows.row[r], reader.sources);
                    unpack_row(vectors.x, vectors.y, vectors.z, rule, extent.width, map.x.row(j), map.y.row(j),
                               map.z.row(j));
                    unpack_extras(extras, vectors, rule.is_unsigned, rows.row[r], map, j);
                }
            }
        },
        span);
}

// The channels beside the normals that the options want.
ExtraSet extras_wanted(const Sources& sources, int channels, const UnpackOptions& options) {
    return extras_beside(sources, channels) & options.others;
}

bool is_one_everywhere(const Plane<float>& plane) {
    for (int j = 0; j < plane.extent().height; ++j) {
        const float* const row = plane.row(j);
        if (!std::all_of(row, row + plane.extent().width, [](float value) { return value == 1.0f; })) return false;
    }
    return true;
}

// The planes for R, G, B and A; null for planes that do not exist. Errors: as normal_channels().
Result<std::array<const Plane<float>*, 4>> planes_of(const Image& image) {
    std::array<const Plane<float>*, 4> planes = {};
    const Result<NormalChannels> named = normal_channels(image.names);
    if (!named) return named.error();
    if (!named->channels.empty()) {
        for (std::size_t c = 0; c < named->channels.size(); ++c) planes[c] = &image.planes[named->channels[c]];
        return planes;
    }
    const auto plane = [&](const char* name) {
        const int k = image.find(name);
        return k < 0 ? nullptr : &image.planes[static_cast<std::size_t>(k)];
    };
    if (image.find("R") >= 0) {
        for (std::size_t c = 0; c < 4; ++c) planes[c] = plane(kChannelNames[c]);
    } else if (image.find("Y") >= 0) {
        planes = {plane("Y"), plane("Y"), plane("Y"), plane("A")};
    } else {
        for (std::size_t c = 0; c < std::min<std::size_t>(4, image.planes.size()); ++c) planes[c] = &image.planes[c];
    }
    return planes;
}

Result<MipChain> unpack_levels(const Texture& texture, const UnpackOptions& options, const Execution& execution) {
    const FormatInfo info = format_info(texture.format);
    const Result<Sources> sources = sources_of(options.swizzle.value_or(texture.swizzle), (1u << info.channels) - 1);
    if (!sources) {
        Error error = sources.error();
        if (has_basis_blocks(texture.format) && !options.swizzle) error.detail = ErrorDetail::uastc_without_alpha;
        return error;
    }
    UnpackRule rule = rule_of(options, info.sample, info.bits, options.y_axis.value_or(texture.y_axis));
    const ValueRange range = range_of(texture.normal_encoding, options);
    const Result<bool> biased =
        is_unsigned(LevelReader{texture.format, texture.levels.front(), *sources, {}}, info.sample, range, execution);
    if (!biased) return biased.error();
    rule.is_unsigned = *biased;

    const ExtraSet extras = extras_wanted(*sources, info.channels, options);
    double texels = 0.0;
    for (const Level& level : texture.levels) texels += static_cast<double>(level.extent.texels());
    MipChain chain;
    chain.levels.resize(texture.levels.size());
    double done = 0.0;
    for (std::size_t k = 0; k < texture.levels.size(); ++k) {
        const Level& level = texture.levels[k];
        const double next = done + static_cast<double>(level.extent.texels()) / texels;
        NormalMap& map = chain.levels[k];
        const auto unpacked = unpack_rows(LevelReader{texture.format, level, *sources, extras}, rule, extras, map,
                                          execution, {done, std::min(1.0, next)});
        if (!unpacked) return unpacked.error();
        done = next;
    }
    const auto has_ones = [](const NormalMap& map) { return is_one_everywhere(map.alpha); };
    if (extras.alpha && std::all_of(chain.levels.begin(), chain.levels.end(), has_ones)) {
        for (NormalMap& map : chain.levels) map.alpha = {};
    }
    return chain;
}

Result<NormalMap> unpack_image(const Image& image, const UnpackOptions& options, const Execution& execution) {
    const Result<std::array<const Plane<float>*, 4>> found = planes_of(image);
    if (!found) return found.error();
    const std::array<const Plane<float>*, 4>& planes = *found;
    unsigned available = 0;
    for (unsigned c = 0; c < 4; ++c) available |= (planes[c] != nullptr ? 1u : 0u) << c;
    const Result<Sources> sources =
        sources_of(options.swizzle.value_or(image.planes.size() == 2 ? kSwizzleXy : kSwizzleXyz), available);
    if (!sources) return sources.error();
    const int channels = available >= 8 ? 4 : available >= 4 ? 3 : 2;
    ExtraSet extras = extras_wanted(*sources, channels, options);
    extras.blue = extras.blue && planes[2] != nullptr;
    const ImageReader reader{planes, *sources};

    UnpackRule rule = rule_of(options, image.sample, image.bits, options.y_axis.value_or(YAxis::up));
    const Result<bool> biased = is_unsigned(reader, image.sample, range_of(image.normal_encoding, options), execution);
    if (!biased) return biased.error();
    rule.is_unsigned = *biased;
    NormalMap map;
    if (const auto unpacked = unpack_rows(reader, rule, extras, map, execution, {}); !unpacked) return unpacked.error();
    if (extras.alpha && is_one_everywhere(map.alpha)) map.alpha = {};
    return map;
}

Result<void> check_options(const UnpackOptions& options) {
    return first_error(check_known("y_axis", kYAxisNames, options.y_axis),
                       check_known("range", kValueRangeNames, options.range));
}

}  // namespace

Result<Image> decode(const Texture& texture, int level, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Image> {
        if (level < 0 || static_cast<std::size_t>(level) >= texture.levels.size())
            return bad_option("level: the texture has no level " + std::to_string(level));
        const Level& chosen = texture.levels[static_cast<std::size_t>(level)];
        const auto usable =
            first_error(check_usable(chosen.extent, "the level"), check_known("format", kFormatNames, texture.format));
        if (!usable) return usable.error();
        if (chosen.bytes.size() != level_bytes(texture.format, chosen.extent))
            return bad_option("the level does not have the bytes of its format and extent");
        return decode_planes(texture, chosen, {}, execution);
    });
}

Result<void> decode_blocks(Format format, const std::byte* bytes, std::size_t pitch,
                           const std::array<PlaneView<float>, 4>& channels) {
    float* rows[4];
    const PlaneView<float>* any = nullptr;
    for (std::size_t c = 0; c < 4; ++c) {
        rows[c] = channels[c].data;
        if (rows[c] == nullptr) continue;
        if (static_cast<int>(c) >= format_info(format).channels) return bad_option("channels: the format has fewer");
        if (any != nullptr && (channels[c].extent != any->extent || channels[c].stride != any->stride))
            return bad_option("channels: must have the same extent and stride");
        any = &channels[c];
    }
    if (any == nullptr) return {};
    const Extent extent = any->extent;
    if (extent.width < 1 || extent.height < 1) return bad_option("channels: must have texels");
    if (pitch < level_bytes(format, {extent.width, 1})) return bad_option("pitch: too small for a row");
    const StoredRows from{bytes, pitch, format, format_info(format), extent.width, extent.height};
    for (int j = 0; j < extent.height; j += from.info.block.height) from.decode_exactly(j, rows, any->stride);
    return {};
}

Result<MipChain> unpack(const Texture& texture, const UnpackOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<MipChain> {
        if (auto usable = first_error(check_usable(texture), check_options(options)); !usable) return usable.error();
        return unpack_levels(texture, options, execution);
    });
}

Result<NormalMap> unpack(const Image& image, const UnpackOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<NormalMap> {
        if (auto usable = first_error(check_usable(image), check_options(options)); !usable) return usable.error();
        return unpack_image(image, options, execution);
    });
}

}  // namespace tex::inline v1
