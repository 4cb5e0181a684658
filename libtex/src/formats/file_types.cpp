// SPDX-License-Identifier: Apache-2.0

#include "formats/file_types.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>

#include "formats/asc/asc.h"
#include "formats/astc/astc_file.h"
#include "formats/basis/basis_file.h"
#include "formats/bil/bil.h"
#include "formats/bmp/bmp.h"
#include "formats/dds/dds.h"
#include "formats/exr/exr.h"
#include "formats/exr/exr_rows.h"
#include "formats/hgt/hgt.h"
#include "formats/ktx/ktx.h"
#include "formats/ktx2/compress_ktx2.h"
#include "formats/ktx2/ktx2.h"
#include "formats/lfs/lfs_pointer.h"
#include "formats/model/model_file.h"
#include "formats/png/png.h"
#include "formats/raw/raw.h"
#include "formats/reader/reader_rows.h"
#include "formats/tga/tga.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

bool is_written(Format format) { return format_row(format).codec->is_written; }

// DDS has no number for EAC.
bool is_written_in_dds(Format format) {
    if (!is_written(format)) return false;
    const FormatRow& row = format_row(widened(format));
    return row.d3d9 != 0 || row.dxgi.exact != 0;
}

bool is_float(Format format) {
    const FormatInfo info = format_info(format);
    return info.sample == SampleKind::floating && !info.has_blocks();
}

// Grey, RGB or RGBA.
bool is_unorm_picture(Format format) {
    const FormatInfo info = format_info(format);
    return info.sample == SampleKind::unorm && !info.has_blocks() && info.channels != 2;
}

bool is_tiff(Format format) {
    return is_unorm_picture(format) || (is_float(format) && format_info(format).channels != 2);
}

bool is_unorm8_picture(Format format) { return is_unorm_picture(format) && format_info(format).bits == 8; }

bool is_unorm8_without_alpha(Format format) { return is_unorm8_picture(format) && format_info(format).channels != 4; }

// The codecs of the reader process come last, but for those without a magic.
constexpr FileType kFileTypes[] = {
    {.container = Container::dds,
     .magic = kDdsMagic,
     .holds = is_written_in_dds,
     .has_levels = true,
     .default_encoding = Encoding::dxt5nm,
     .parse = parse_dds,
     .has_layers = true,
     .layout = dds_layout},
    {.container = Container::ktx2,
     .magic = kKtx2Magic,
     .holds = is_written,
     .has_levels = true,
     .default_encoding = Encoding::dxt5nm,
     .parse = parse_ktx2,
     .has_layers = true,
     .layout = [](const TextureHead& head, const WriteOptions&) { return ktx2_layout(head); },
     .compress = compress_ktx2},
    {.magic = kLfsMagic, .open_rows = refuse_lfs_pointer},
    {.magic = kBasisMagic, .open_rows = refuse_basis},
    {.claims = may_be_model, .open_rows = refuse_model},
    {.magic = kKtxMagic, .parse = parse_ktx, .has_layers = true},
    {.container = Container::astc,
     .magic = kAstcMagic,
     .holds = holds_astc,
     .default_encoding = Encoding::astc_4x4,
     .parse = parse_astc,
     .layout = astc_layout},
    {.container = Container::png,
     .magic = kPngMagic,
     .holds = is_unorm_picture,
     .open_rows = open_png,
     .open_target = open_png_target},
    {.container = Container::exr,
     .magic = kExrMagic,
     .holds = is_float,
     .has_levels = true,
     .default_encoding = Encoding::half,
     .open_rows = open_exr_rows,
     .open_levels = open_exr_texture_rows,
     .has_layers = true,
     .open_target = open_exr_target},
    {.container = Container::bmp,
     .magic = kBmpMagic,
     .holds = is_unorm8_without_alpha,
     .open_rows = open_bmp,
     .open_target = open_bmp_target},
    {.claims = may_be_asc, .open_rows = open_asc},
    {.container = Container::tga,
     .claims = may_be_tga,
     .holds = is_unorm8_picture,
     .open_rows = open_tga,
     .open_target = open_tga_target},
    {.container = Container::tiff,
     .holds = is_tiff,
     .default_encoding = Encoding::rgb16,
     .open_rows = open_reader_rows,
     .reader_name = "tiff"},
    {.container = Container::jpeg,
     .holds = is_unorm8_without_alpha,
     .open_rows = open_reader_rows,
     .reader_name = "jpeg"},
    {.container = Container::webp,
     .holds = is_unorm8_picture,
     .open_rows = open_reader_rows,
     .reader_name = "webp",
     .longest_side = 16383},
    {.container = Container::r16,
     .is_named = is_raw,
     .holds = [](Format format) { return format == Format::r16_unorm; },
     .open_rows = open_raw,
     .layout = raw_layout},
    {.container = Container::r32,
     .holds = [](Format format) { return format == Format::r32_float; },
     .default_encoding = Encoding::float_,
     .open_rows = open_raw,
     .layout = raw_layout},
    {.is_named = is_hgt, .open_rows = open_hgt},
    {.is_named = is_bil, .open_rows = open_bil},
};

}  // namespace

const FileType& file_type_of(Container container) {
    return *std::find_if(std::begin(kFileTypes), std::end(kFileTypes),
                         [&](const FileType& type) { return type.container == container; });
}

Result<void> check_holds(const FileType& type, Format format, const WriteOptions& options) {
    if (auto valid = validate(options); !valid) return valid;
    if (options.zstd > 0 && type.compress == nullptr) {
        return Error{ErrorCode::unsupported,
                     {},
                     std::string(name_of(kContainerNames, *type.container)) + " is not compressed with Zstandard"};
    }
    if (type.holds(format)) return {};
    if (!is_written(format))
        return Error{
            ErrorCode::unsupported, {}, std::string(name_of(kFormatNames, format)) + " can be read, but not written"};
    return Error{ErrorCode::unsupported,
                 {},
                 std::string(name_of(kContainerNames, *type.container)) + " does not hold " +
                     std::string(name_of(kFormatNames, format))};
}

Result<void> check_layer(const FileType& type, const ReadOptions& options) {
    if (options.layer.empty() || type.has_layers) return {};
    return Error{ErrorCode::bad_option, {}, "a layer can be chosen only in EXR, DDS, KTX and KTX2 files"};
}

const FileType& file_type_for(std::span<const std::byte> head) {
    return *std::find_if(std::begin(kFileTypes), std::end(kFileTypes), [&](const FileType& type) {
        if (type.claims != nullptr) return type.claims(head);
        if (type.magic.empty()) return type.reader_name != nullptr;
        return head.size() >= type.magic.size() && std::memcmp(head.data(), type.magic.data(), type.magic.size()) == 0;
    });
}

const FileType& file_type_for(const InputFile& file, const ReadOptions& options) {
    const FileType& by_head = file_type_for(file.head());
    if (by_head.magic == kLfsMagic) return by_head;  // whatever the name says
    const auto* const named = std::find_if(std::begin(kFileTypes), std::end(kFileTypes), [&](const FileType& type) {
        return type.is_named != nullptr && type.is_named(file, options);
    });
    return named == std::end(kFileTypes) ? by_head : *named;
}

}  // namespace tex::inline v1
