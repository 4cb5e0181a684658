// SPDX-License-Identifier: Apache-2.0

#include "output.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include <tex/format.h>
#include <tex/mip.h>
#include <tex/pack.h>

namespace tex::oiio {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

// Pixels are kept in the type in which they come, if libtex has a format for it; others become floats.
TypeDesc kept_type(const TypeDesc& type) {
    switch (type.basetype) {
        case TypeDesc::UINT8:
        case TypeDesc::UINT16:
        case TypeDesc::HALF: return TypeDesc(static_cast<TypeDesc::BASETYPE>(type.basetype));
        default: return TypeDesc::FLOAT;
    }
}

Format format_of_pixels(const TypeDesc& type, int channels) {
    const bool floating = type.is_floating_point();
    const auto bits = static_cast<int>(type.size() * 8);
    const std::optional<Format> format = format_of(floating ? SampleKind::floating : SampleKind::unorm, bits, channels);
    return format.value_or(Format::rgba32_float);
}

// A value of one of these types, as libtex reads it: OpenImageIO multiplies codes by a rounded 1/255.
float value_of(const TypeDesc& type, const std::byte* from) {
    float value = 0.0f;
    if (type.basetype == TypeDesc::UINT8) return static_cast<float>(std::to_integer<int>(*from)) / 255.0f;
    if (type.basetype == TypeDesc::UINT16) {
        std::uint16_t code = 0;
        std::memcpy(&code, from, sizeof code);
        return static_cast<float>(code) / 65535.0f;
    }
    OIIO::convert_types(type, from, TypeDesc::FLOAT, &value, 1);
    return value;
}

bool is_signed_integer(const TypeDesc& type) {
    return type.basetype == TypeDesc::INT8 || type.basetype == TypeDesc::INT16 || type.basetype == TypeDesc::INT32 ||
           type.basetype == TypeDesc::INT64;
}

bool is_unsigned_integer(const TypeDesc& type) { return !type.is_floating_point() && !is_signed_integer(type); }

Error mistake(const std::string& file, const std::string& reason) { return {ErrorCode::bad_option, file, reason}; }

// Whether a colour is larger than alpha, which no multiplied colour is.
bool exceeds_alpha(const Image& image) {
    const Extent extent = image.extent();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float limit = image.planes[3].at(i, j) + 2.0f / 255.0f;  // they were rounded
            for (std::size_t c = 0; c < 3; ++c) {
                if (image.planes[c].at(i, j) > limit) return true;
            }
        }
    }
    return false;
}

// Makes colours that were multiplied by their alpha what they were.
void divide_by_alpha(const ImageSpec& spec, std::vector<std::byte>& bytes) {
    ImageSpec plain(spec.width, spec.height, 4, spec.format);
    OIIO::ImageBuf buffer(plain, bytes.data());
    OIIO::ImageBufAlgo::unpremult(buffer, buffer);
}

}  // namespace

// A file that was not closed is finished, as OpenImageIO's own writers do. If pixels are missing, there is no file.
Output::~Output() { close(); }

const char* Output::format_name() const { return kFormatName; }

int Output::supports(OIIO::string_view feature) const {
    return feature == "tiles" || feature == "mipmap" || feature == "alpha" || feature == "nchannels" ? 1 : 0;
}

bool Output::report(const Result<void>& done) {
    if (done) return true;
    open_ = false;  // nothing is written
    failed_ = true;
    pixels_ = {};
    errorfmt("{}", done.error().message());
    return false;
}

bool Output::open(const std::string& name, const ImageSpec& spec, OpenMode mode) {
    return no_throw(*this, [&] {
        switch (mode) {
            case Create:
                if (!close()) return false;
                return report(begin(name, spec));
            case AppendMIPLevel: return report(add_level(spec));
            default: return report(mistake(name, "a texture holds one picture, besides its levels"));
        }
    });
}

Result<void> Output::begin(const std::string& name, const ImageSpec& spec) {
    const std::optional<Container> container = container_of(name);
    if (!container || !(can_hold_blocks(*container) || can_hold(*container, Encoding::astc_4x4)))
        return mistake(name, "the name must end in .dds, .ktx2 or .astc");
    if (spec.deep || spec.depth > 1) return mistake(name, "deep pictures and volumes are no normal maps");
    name_ = name;
    if (const Result<void> chosen = choose_channels(spec); !chosen) return chosen;
    const int channels = spec.nchannels - static_cast<int>(extras_.size());
    Result<Wanted> wanted = wanted_of(spec);
    if (!wanted) return mistake(name, wanted.error().reason);
    const Encoding encoding = wanted->format.value_or(default_encoding(*container));
    if (!can_hold(*container, encoding))
        return mistake(name, "a " + std::string(name_of(kContainerNames, *container)) + " file cannot hold " +
                                 std::string(name_of(kEncodingNames, encoding)) +
                                 "; set the attribute tex:format to another encoding");
    for (const Sent& sent : extras_) {
        if (!can_hold(encoding)[sent.extra])
            return mistake(name, std::string(name_of(kEncodingNames, encoding)) + " has no room for the channel " +
                                     channel_name(sent.extra) +
                                     "; leave it out, or set tex:format to another encoding");
    }
    if (!can_hold_levels(*container) && !wanted->keep_levels && wanted->levels != 1)
        return mistake(name, "this file type holds one level; set the attribute tex:mips to 1 or keep");
    const TypeDesc type = spec.format;
    // Signed integers are read as floats are: they are colours, too, if a program has only changed the type.
    if (is_unsigned_integer(type)) wanted->pixels.range = ValueRange::unsigned_;

    pixels_ = {};
    pixels_.format = format_of_pixels(kept_type(type), channels);
    pixels_.swizzle = channels == 2 ? kSwizzleXy : kSwizzleXyz;
    pixels_.normal_encoding = spec.get_string_attribute("normalEncoding");
    container_ = *container;
    wanted_ = std::move(*wanted);
    wanted_.pack.encoding = encoding;
    open_ = true;
    return add_level(spec);
}

// Channels called blue and length hold data beside the normals; the others are those of the normals.
Result<void> Output::choose_channels(const ImageSpec& spec) {
    extras_.clear();
    for (std::size_t c = 0; c < spec.channelnames.size(); ++c) {
        for (const Extra extra : {Extra::blue, Extra::length}) {
            if (spec.channelnames[c] == channel_name(extra)) extras_.push_back({c, extra, {}});
        }
    }
    const int channels = spec.nchannels - static_cast<int>(extras_.size());
    if (channels >= 2 && channels <= 4) return {};
    return mistake(name_, "a normal map has 2 to 4 channels, not " + std::to_string(channels) +
                              ", besides those called blue and length");
}

Result<void> Output::add_level(const ImageSpec& spec) {
    if (!open_) return mistake(name_, "no file is open");
    const Extent extent{spec.width, spec.height};
    if (extent.width < 1 || extent.height < 1 || extent.width > kMaxExtent || extent.height > kMaxExtent)
        return mistake(name_, "the picture is empty or has a side of more than " + std::to_string(kMaxExtent));
    if (!pixels_.levels.empty()) {
        if (const Result<void> finished = finish_level(); !finished) return finished.error();
        if (!can_hold_levels(container_)) return mistake(name_, "this file type holds one level");
        const auto level = static_cast<int>(pixels_.levels.size());
        const Extent before = pixels_.levels.back().extent;
        if (extent != level_extent(pixels_.extent(), level) || before == Extent{1, 1} ||
            spec.nchannels != m_spec.nchannels) {
            return mistake(name_, "level " + std::to_string(level) +
                                      " must have half the width and height of the level before it, rounded down, and "
                                      "the same channels");
        }
    }
    const TypeDesc type = pixels_.levels.empty() ? kept_type(spec.format) : m_spec.format;
    m_spec = spec;
    m_spec.set_format(type);
    m_spec.channelformats.clear();
    pixels_.levels.push_back({extent, std::vector<std::byte>(level_bytes(pixels_.format, extent))});
    if (!extras_.empty()) sent_.assign(m_spec.image_bytes(), std::byte{0});
    const bool tiled = spec.tile_width > 0 && spec.tile_height > 0;
    next_ = 0;
    end_ = !tiled ? spec.height
                  : std::int64_t{(spec.width + spec.tile_width - 1) / spec.tile_width} *
                        ((spec.height + spec.tile_height - 1) / spec.tile_height);
    return {};
}

// Scanlines and tiles come in their order, so a count shows that none is missing. `part` is -1 if there is no such
// part.
bool Output::next_is(std::int64_t part) {
    if (!open_) {
        errorfmt("{}", "no file is open");
        return false;
    }
    if (part != next_ || part >= end_)
        return report(mistake(name_, "scanlines and tiles must come in their order, each once"));
    ++next_;
    return true;
}

bool Output::write_scanline(int y, int z, TypeDesc format, const void* data, OIIO::stride_t xstride) {
    return no_throw(*this, [&] {
        if (!next_is(z == m_spec.z ? std::int64_t{y} - m_spec.y : -1)) return false;
        return copy_to_image_buffer(m_spec.x, m_spec.x + m_spec.width, y, y + 1, z, z + 1, format, data, xstride,
                                    OIIO::AutoStride, OIIO::AutoStride, sent().data(), TypeDesc::UNKNOWN);
    });
}

bool Output::write_tile(int x, int y, int z, TypeDesc format, const void* data, OIIO::stride_t xstride,
                        OIIO::stride_t ystride, OIIO::stride_t zstride) {
    return no_throw(*this, [&] {
        if (m_spec.tile_width < 1 || m_spec.tile_height < 1)
            return report(mistake(name_, "a tile of a picture without tiles"));
        const std::int64_t across = (m_spec.width + m_spec.tile_width - 1) / m_spec.tile_width;
        const std::int64_t column = (std::int64_t{x} - m_spec.x) / m_spec.tile_width;
        const std::int64_t row = (std::int64_t{y} - m_spec.y) / m_spec.tile_height;
        const bool aligned = m_spec.x + column * m_spec.tile_width == x && m_spec.y + row * m_spec.tile_height == y;
        if (!next_is(aligned && column >= 0 && column < across && z == m_spec.z ? row * across + column : -1))
            return false;
        return copy_tile_to_image_buffer(x, y, z, format, data, xstride, ystride, zstride, sent().data(),
                                         TypeDesc::UNKNOWN);
    });
}

// Takes the channels of a level apart.
void Output::split_level() {
    if (extras_.empty()) return;
    const auto channels = static_cast<std::size_t>(m_spec.nchannels);
    const std::size_t size = m_spec.format.size();
    const Extent extent = pixels_.levels.back().extent;
    std::vector<int> other_of(channels, -1);
    for (std::size_t k = 0; k < extras_.size(); ++k) {
        other_of[extras_[k].channel] = static_cast<int>(k);
        extras_[k].levels.emplace_back(extent);
    }
    const std::byte* from = sent_.data();
    std::byte* to = pixels_.levels.back().bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (std::size_t c = 0; c < channels; ++c, from += size) {
                if (other_of[c] < 0) {
                    to = std::copy_n(from, size, to);
                } else {
                    extras_[static_cast<std::size_t>(other_of[c])].levels.back().at(i, j) =
                        value_of(m_spec.format, from);
                }
            }
        }
    }
}

// Whether colours may be multiplied by an alpha after them.
bool Output::has_alpha() const {
    const auto is_before = [this](const Sent& sent) { return static_cast<int>(sent.channel) < m_spec.alpha_channel; };
    const auto before = std::count_if(extras_.begin(), extras_.end(), is_before);
    return format_info(pixels_.format).channels == 4 && m_spec.alpha_channel - before == 3 &&
           m_spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

// Stored channels, as those of DXT5nm that OpenImageIO's own reader of DDS returns, look like a picture with alpha, but
// what is in A is x, and nothing was multiplied by it.
Result<bool> Output::is_multiplied_by_alpha() const {
    if (!has_alpha()) return false;
    const Execution execution{threads(), {}};
    const Result<Swizzle> swizzle = guess_swizzle(pixels_, execution);
    if (!swizzle) return swizzle.error();
    if (*swizzle == kSwizzleXyz) return true;
    const Result<Image> channels = decode(pixels_, 0, execution);
    if (!channels) return channels.error();
    return !exceeds_alpha(*channels);
}

Result<void> Output::finish_level() {
    if (next_ != end_)
        return mistake(name_, "level " + std::to_string(pixels_.levels.size() - 1) + " has " + std::to_string(next_) +
                                  " of " + std::to_string(end_) + " scanlines or tiles; no file is written");
    split_level();
    if (pixels_.levels.size() == 1) {
        const Result<bool> is_multiplied = is_multiplied_by_alpha();
        if (!is_multiplied) return is_multiplied.error();
        multiplied_ = *is_multiplied;
    }
    if (multiplied_) divide_by_alpha(m_spec, pixels_.levels.back().bytes);
    return {};
}

bool Output::close() {
    return no_throw(*this, [&] {
        if (open_) report(finish());
        open_ = false;
        pixels_ = {};
        extras_.clear();
        sent_ = {};
        return !std::exchange(failed_, false);  // programs may look at nothing else
    });
}

Result<MipChain> Output::levels() {
    const Execution execution{threads(), {}};
    UnpackOptions how = wanted_.pixels;
    if (!how.swizzle && format_info(pixels_.format).channels == 4) {
        const Result<Swizzle> swizzle = guess_swizzle(pixels_, execution);
        if (!swizzle) return swizzle.error();
        how.swizzle = *swizzle;
    }
    Result<MipChain> sent = unpack(pixels_, how, execution);
    if (!sent) return sent;
    for (Sent& extra : extras_) {
        for (std::size_t k = 0; k < sent->levels.size(); ++k) sent->levels[k][extra.extra] = std::move(extra.levels[k]);
    }
    if (wanted_.keep_levels) return sent;
    MipOptions options;
    options.levels = wanted_.levels;
    options.blue = wanted_.blue;
    options.alpha = wanted_.alpha;
    return build_mip_chain(std::move(sent->levels.front()), options, execution);
}

Result<void> Output::finish() {
    if (const Result<void> finished = finish_level(); !finished) return finished.error();
    Result<MipChain> chain = levels();
    if (!chain) return Error{chain.error().code, name_, chain.error().reason};
    pixels_ = {};
    PackOptions pack_options = wanted_.pack;
    pack_options.y_axis = wanted_.y.value_or(wanted_.pixels.y_axis.value_or(YAxis::up));
    pack_options.y_known = wanted_.y || wanted_.pixels.y_axis;
    const Execution execution{threads(), {}};
    Result<PackedTexture> texture = pack(*chain, pack_options, execution);
    if (!texture) return Error{texture.error().code, name_, texture.error().reason};
    return write_texture(name_, *texture, wanted_.write, execution);
}

}  // namespace tex::oiio
