// SPDX-License-Identifier: Apache-2.0
// Which path a file takes, and the path of whole images; pipeline/bake_stream.cpp is the other one.

#include <tex/pipeline.h>

#include <memory>
#include <utility>

#include <tex/image_io.h>

#include "base/guard.h"
#include "base/input_file.h"
#include "containers/row_source.h"
#include "pipeline/bake_stream.h"

namespace tex {
namespace {

bool is_texture(Container container) { return container == Container::dds || container == Container::ktx2; }

bool can_stream(const RowSource* rows, Container container, const BakeFileOptions& options) {
    return rows != nullptr && rows->is_sequential() && is_texture(container) && options.color.space.empty() &&
           !options.heights.fill_invalid;
}

// The part of an execution from a fraction to another.
Execution part_of(const Execution& execution, double from, double to) {
    if (!execution.progress) return execution;
    return {execution.threads,
            [&execution, from, to](double done) { return execution.progress(from + (to - from) * done); }};
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
    if (!can_hold_levels(container)) mip.levels = 1;
    auto chain = build_mip_chain(std::move(*normals), mip, part_of(execution, 0.4, 0.6));
    if (!chain) return chain.error();
    auto texture = pack(*chain, options.pack, part_of(execution, 0.6, 0.95));
    if (!texture) return texture.error();
    chain->levels.clear();
    report.levels = static_cast<int>(texture->levels.size());
    auto bytes = encode_file(*texture, container, options.write);
    if (!bytes) return Error{bytes.error().code, output, bytes.error().reason};
    texture->levels.clear();
    report.bytes = bytes->size();
    if (auto written = write_file(output, *bytes, options.write); !written) return written.error();
    return report;
}

}  // namespace

Result<BakeFileReport> bake_file(const std::string& input, const std::string& output, Container container,
                                 const BakeFileOptions& options, const Execution& execution) {
    return guarded([&]() -> Result<BakeFileReport> {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        Result<std::unique_ptr<RowSource>> rows = open_rows(*file, options.read);
        if (!rows) return rows.error();
        if (can_stream(rows->get(), container, options)) {
            return bake_stream(**rows, input, output, container, options, execution);
        }
        Result<Image> image = *rows ? (*rows)->read_all() : read_image(*file, options.read);
        if (!image) {
            Error error = image.error();
            if (error.file.empty()) error.file = input;
            return error;
        }
        rows->reset();
        return bake_whole(std::move(*image), output, container, options, execution);
    });
}

}  // namespace tex
