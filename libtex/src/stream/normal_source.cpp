// SPDX-License-Identifier: Apache-2.0

#include "stream/normal_source.h"

#include <utility>

#include "formats/texture_rows.h"
#include "stream/source_layout.h"
#include "stream/y_witness.h"

namespace tex {
namespace {

Result<Swizzle> find_swizzle(const Texture& texture, const SourceOptions& options, const Execution& execution) {
    if (const std::optional<Swizzle> known = known_swizzle(texture, options)) return *known;
    const Execution silent{execution.threads, {}};
    Result<Swizzle> guess = guess_swizzle(texture, silent);
    if (!guess) return guess;
    return guessed_swizzle(*guess, options);
}

Result<Source> unpack_source(Texture texture, const SourceOptions& options, bool base_only,
                             const Execution& execution) {
    if (base_only) texture.levels.resize(1);
    if (const Result<void> fit = check_channels(texture); !fit) return fit.error();
    const Result<Swizzle> swizzle = find_swizzle(texture, options, execution);
    if (!swizzle) return swizzle.error();
    Source source;
    source.info = source_info(texture, *swizzle, options);
    Result<MipChain> chain = unpack(texture, unpack_options(source.info, options), execution);
    if (!chain) return chain.error();
    source.chain = std::move(*chain);
    if (options.doubt_y && !source.info.y_known) source.info.y_doubtful = contradicts_y(source.chain.levels.front());
    return source;
}

}  // namespace

Result<Source> read_normals(InputFile& file, const SourceOptions& options, bool base_only, const Execution& execution) {
    Result<Texture> texture = read_texture(file, options.read);
    if (!texture) return texture.error();
    Result<Source> source = unpack_source(std::move(*texture), options, base_only, execution);
    if (!source) return source.error().of(file.path());
    return source;
}

Result<Source> read_normals(MapSource& map, const SourceOptions& options, bool base_only, const Execution& execution) {
    Result<Texture> texture = read_all(map.open());
    if (!texture) return texture.error().of(map.path());
    Result<Source> source = unpack_source(std::move(*texture), options, base_only, execution);
    if (!source) return source.error().of(map.path());
    return source;
}

}  // namespace tex
