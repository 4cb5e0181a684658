// SPDX-License-Identifier: Apache-2.0
// Which path a file takes, and the path of whole images; pipeline/bake_stream.cpp and pipeline/pack_stream.cpp are the
// other one.

#include <tex/pipeline.h>

#include <cassert>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <tex/image_io.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/texture_rows.h"
#include "stream/bake_stream.h"
#include "stream/blend_stream.h"
#include "stream/normal_source.h"
#include "stream/pack_stream.h"
#include "stream/strip_writer.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

// One file that holds `texture`.
Result<std::size_t> write_whole(Texture texture, const std::string& output, Container container,
                                const WriteOptions& options) {
    auto bytes = encode_file(texture, container, options);
    if (!bytes) return Error{bytes.error().code, output, bytes.error().reason};
    texture.levels.clear();
    if (auto written = write_file(output, *bytes, options); !written) return written.error();
    return bytes->size();
}

// The same, or a file for each level.
Result<std::size_t> write_whole(Texture texture, const OutputNames& names, Container container,
                                const WriteOptions& options) {
    if (!names.of_level) return write_whole(std::move(texture), names.output, container, options);
    std::size_t bytes = 0;
    std::vector<Level> levels = std::exchange(texture.levels, {});
    for (std::size_t k = 0; k < levels.size(); ++k) {
        Texture one = texture;
        one.levels.push_back(std::move(levels[k]));
        const Result<std::size_t> written =
            write_whole(std::move(one), names.of_level(static_cast<int>(k)), container, options);
        if (!written) return written.error();
        bytes += *written;
    }
    return bytes;
}

Result<BakeFileReport> bake_whole(Image image, const std::string& output, Container container,
                                  const BakeFileOptions& options, const Execution& execution) {
    BakeFileReport report;
    if (!options.color.space.empty()) {
        if (const auto converted = to_linear(image, options.color); !converted) return converted.error();
    }
    auto field = height_field(image, options.heights, part_of(execution, 0.0, 0.3), &report.heights);
    if (!field) return field.error();
    image = {};
    report.extent = field->height.extent();
    const Strength strength = options.strength ? options.strength(report.extent) : Strength();
    field->bumpiness_x = strength.x;
    field->bumpiness_y = strength.y;
    auto normals = bake(*field, options.bake, part_of(execution, 0.3, 0.4));
    if (!normals) return normals.error();
    field->height = {};
    if (options.slopes) report.slopes = slope_range(*normals, execution);
    MipOptions mip = options.mip;
    if (!holds_levels(container, options.level_names)) mip.levels = 1;
    auto chain = build_mip_chain(std::move(*normals), mip, part_of(execution, 0.4, 0.6));
    if (!chain) return chain.error();
    auto texture = pack(*chain, options.pack, part_of(execution, 0.6, 0.95));
    if (!texture) return texture.error();
    chain->levels.clear();
    report.levels = static_cast<int>(texture->levels.size());
    auto bytes = write_whole(std::move(*texture), {output, options.level_names}, container, options.write);
    if (!bytes) return bytes.error();
    report.bytes = *bytes;
    return report;
}

Result<Texture> roughness_whole(const NormalMap& base, const RoughnessFile& file, MipOptions mip,
                                const Execution& execution) {
    const Execution silent{execution.threads, {}};
    Result<Plane<float>> own = file.map ? file.map() : Plane<float>(base.extent(), file.own);
    if (!own) return own.error();
    if (!holds_levels(file.container, file.level_names)) mip.levels = 1;
    const Result<RoughnessChain> chain = build_roughness_chain(base, *own, file.model, mip, silent);
    if (!chain) return chain.error();
    return pack_roughness(*chain, file.format, file.effort, silent);
}

Result<PackFileReport> pack_whole(InputFile& file, const std::string& output, Container container,
                                  const PackFileOptions& options, const Execution& execution) {
    const bool base_only = options.level ? *options.level == 0 : options.mip.has_value();
    auto source = read_normals(file, options.source, base_only, part_of(execution, 0.0, 0.4));
    if (!source) return source.error();
    PackFileReport report;
    report.source = std::move(source->info);
    report.pack = pack_options(options, container, report.source);
    MipChain chain = std::move(source->chain);
    const auto first = static_cast<std::size_t>(options.level.value_or(0));
    if (first >= chain.levels.size()) return no_such_level(file.path(), *options.level, chain.levels.size());
    std::swap(chain.levels.front(), chain.levels[first]);
    if (options.level || options.mip || !holds_levels(container, options.level_names)) chain.levels.resize(1);
    if (options.scale) {
        auto scaled = scale(std::move(chain), options.scale->scale, options.scale->mode, part_of(execution, 0.4, 0.5));
        if (!scaled) return scaled.error();
        chain = std::move(*scaled);
    }
    std::optional<Texture> roughness;
    if (options.roughness) {
        MipOptions mip = *options.mip;
        if (!holds_levels(container, options.level_names)) mip.levels = 1;
        auto made = roughness_whole(chain.levels.front(), *options.roughness, mip, execution);
        if (!made) return made.error();
        roughness = std::move(*made);
    }
    if (options.mip && holds_levels(container, options.level_names)) {
        auto built = build_mip_chain(std::move(chain.levels.front()), *options.mip, part_of(execution, 0.5, 0.6));
        if (!built) return built.error();
        chain = std::move(*built);
    }
    auto texture = pack(chain, report.pack, part_of(execution, 0.6, 0.95));
    if (!texture) return texture.error();
    chain.levels.clear();
    report.extent = texture->extent();
    report.levels = static_cast<int>(texture->levels.size());
    auto bytes = write_whole(std::move(*texture), {output, options.level_names}, container, options.write);
    if (!bytes) return bytes.error();
    report.bytes = *bytes;
    if (roughness) {
        const RoughnessFile& rough = *options.roughness;
        auto beside =
            write_whole(std::move(*roughness), {rough.output, rough.level_names}, rough.container, options.write);
        if (!beside) return beside.error();
        report.roughness_bytes = *beside;
    }
    return report;
}

// Whether the roughness, where there is any, streams.
bool roughness_streams(const PackFileOptions& options) {
    return !options.roughness || (!options.roughness->map && takes_strips(options.roughness->container));
}

}  // namespace

Result<BakeFileReport> bake_file(const std::string& input, const std::string& output, Container container,
                                 const BakeFileOptions& options, const Execution& execution) {
    return guarded([&]() -> Result<BakeFileReport> {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        Result<std::unique_ptr<RowSource>> rows = open_rows(*file, options.read);
        if (!rows) return rows.error();
        if (*rows && can_stream(*file, **rows, container, options)) {
            return bake_stream(*file, std::move(*rows), output, container, options, execution);
        }
        Result<Image> image = *rows ? (*rows)->read_all() : read_image(*file, options.read);
        if (!image) return image.error().of(input);
        rows->reset();
        return bake_whole(std::move(*image), output, container, options, execution);
    });
}

Result<PackFileReport> pack_file(const std::string& input, const std::string& output, Container container,
                                 const PackFileOptions& options, const Execution& execution) {
    assert(!options.level || *options.level >= 0);
    assert(!options.roughness || options.mip);
    return guarded([&]() -> Result<PackFileReport> {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        if (takes_strips(container) && roughness_streams(options)) {
            Result<std::optional<TextureRows>> texture = open_texture_rows(*file, options.source.read);
            if (!texture) return texture.error();
            if (*texture) {
                return pack_stream(*file, std::move(**texture), output, container, options, execution);
            }
        }
        return pack_whole(*file, output, container, options, execution);
    });
}

Layer LayerFile::layer() const {
    return {{}, scale, tiling_x, tiling_y, offset_x, offset_y, rotation, wrap_x, wrap_y, strength, {}};
}

Result<BlendFileReport> blend_file(const std::string& input, const std::string& output, Container container,
                                   const BlendFileOptions& options, const Execution& execution) {
    return guarded([&] { return blend_stream(input, output, container, options, execution); });
}

}  // namespace tex
