// SPDX-License-Identifier: Apache-2.0

#include "input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "attributes.h"

namespace tex::oiio {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

// OpenImageIO chooses a reader by the extension of a name, and .dds belongs to its own. NAME.tex names the file NAME
// for this reader, unless there is a file NAME.tex.
std::string file_of(const std::string& name) {
    constexpr std::string_view kSuffix = ".tex";
    std::error_code ignored;
    const bool has_suffix =
        name.size() > kSuffix.size() && name.compare(name.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0;
    if (!has_suffix || std::filesystem::exists(name, ignored)) return name;
    return name.substr(0, name.size() - kSuffix.size());
}

// OpenImageIO tries all readers on a file that none expects, so most files are refused here. libtex does not see them:
// it would start a process with OpenImageIO for them.
Result<void> check_magic(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) return Error{ErrorCode::io, path, "no such file"};
    // A FIFO can be read only once, and may never be written.
    if (!std::filesystem::is_regular_file(status)) return Error{ErrorCode::io, path, "not a regular file"};
    std::array<char, 12> bytes{};
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{ErrorCode::io, path, "cannot be opened"};
    file.read(bytes.data(), bytes.size());
    const std::string_view start(bytes.data(), static_cast<std::size_t>(file.gcount()));
    for (const std::string_view magic : {std::string_view("DDS "), std::string_view("\xabKTX 20\xbb\r\n\x1a\n"),
                                         std::string_view("\x13\xab\xa1\x5c")}) {
        if (start.substr(0, magic.size()) == magic) return {};
    }
    return Error{ErrorCode::unsupported, path, "not a DDS, KTX2 or ASTC file"};
}

std::size_t bytes_of(const TypeDesc& type, int channels, Extent extent) {
    return type.size() * static_cast<std::size_t>(channels) * static_cast<std::size_t>(extent.texels());
}

// Puts values beside the pixels: codes of 16 bits, or floats.
void add_channels(const NormalMap& map, ExtraSet extras, bool as_floats, std::vector<std::byte>& pixels) {
    std::vector<const Plane<float>*> planes;
    for (const Extra extra : kExtras) {
        if (extras[extra]) planes.push_back(&map[extra]);
    }
    const std::size_t size = as_floats ? sizeof(float) : sizeof(std::uint16_t);
    const Extent extent = map.extent();
    std::vector<std::byte> wider(pixels.size() / 3 * (3 + planes.size()));
    const std::byte* from = pixels.data();
    std::byte* to = wider.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i, from += 3 * size) {
            to = std::copy_n(from, 3 * size, to);
            for (const Plane<float>* plane : planes) {
                const float value = plane->empty() ? 1.0f : plane->row(j)[i];  // in all levels but this one, something
                const auto code = static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535.0f));
                std::memcpy(to, as_floats ? static_cast<const void*>(&value) : &code, size);
                to += size;
            }
        }
    }
    pixels = std::move(wider);
}

bool is_constant(const Plane<float>& plane) {
    for (int j = 0; j < plane.extent().height; ++j) {
        const float* const row = plane.row(j);
        if (std::any_of(row, row + plane.extent().width, [&](float value) { return value != plane.at(0, 0); }))
            return false;
    }
    return true;
}

// oiiotool 2.4 asks supports("procedural") before it opens a name without a file, and crashes if that fails then.
bool can_be_opened(const std::string& name) {
    ImageSpec spec;
    return Input().open(name, spec);
}

// Floats of normals become colours. Programs expect 0 to 1, and clamp what lies outside in most file types.
void to_colours(std::vector<std::byte>& bytes) {
    for (std::size_t at = 0; at + sizeof(float) <= bytes.size(); at += sizeof(float)) {
        float n = 0.0f;
        std::memcpy(&n, &bytes[at], sizeof n);
        n = (n + 1.0f) / 2.0f;
        std::memcpy(&bytes[at], &n, sizeof n);
    }
}

}  // namespace

const char* Input::format_name() const { return kFormatName; }

// OpenImageIO's programs accept a name without a file if its reader makes pictures without files.
int Input::supports(OIIO::string_view feature) const { return feature == "procedural" && named_ ? 1 : 0; }

bool Input::valid_file(const std::string& name) const {
    try {
        const std::string path = file_of(name);
        const bool valid = check_magic(path).has_value();
        named_ = path != name && valid && can_be_opened(name);
        return valid;
    } catch (...) {  // no memory
        return false;
    }
}

bool Input::open(const std::string& name, ImageSpec& spec) { return open(name, spec, {}); }

bool Input::open(const std::string& name, ImageSpec& spec, const ImageSpec& config) {
    return no_throw(*this, [&] {
        close();
        const Result<void> loaded = load(name, config);
        if (!loaded) {
            errorfmt("{}", loaded.error().message());
            close();
            return false;
        }
        spec = m_spec;
        return true;
    });
}

Result<void> Input::load(const std::string& name, const ImageSpec& config) {
    const std::string path = file_of(name);
    named_ = path != name;
    const Result<Reading> reading = reading_of(config);
    if (!reading) return Error{reading.error().code, path, reading.error().reason};
    if (const Result<void> magic = check_magic(path); !magic) return magic.error();
    Result<Texture> texture = read_texture(path);
    if (!texture) return texture.error();
    texture_ = std::move(*texture);
    path_ = path;

    const Execution execution{threads(), {}};
    if (reading->swizzle) {
        texture_.swizzle = *reading->swizzle;
    } else {
        const Result<Swizzle> swizzle = guess_swizzle(texture_, execution);
        if (!swizzle) return Error{swizzle.error().code, path, swizzle.error().reason};
        texture_.swizzle = *swizzle;
    }
    const FormatInfo info = format_info(texture_.format);
    // One channel is a height, a roughness or another value, but no normal.
    const bool normals = reading->unpack && info.channels > 1;
    if (normals) {
        what_ = info.sample == SampleKind::floating ? Pixels::floats : Pixels::normals;
    } else {
        what_ = info.has_blocks() ? Pixels::channels : Pixels::stored;
    }
    const Extent extent = texture_.extent();
    if (normals) {
        // What cannot be unpacked is described, and fails when its pixels are read.
        static_cast<void>(find_extras(reading->has_lengths));
    }
    m_spec = ImageSpec(extent.width, extent.height, normals ? 3 : info.channels, type());
    if (m_spec.nchannels == 1) m_spec.channelnames = {"Y"};
    for (const Extra extra : kExtras) {
        if (!extras_[extra]) continue;
        if (extra == Extra::alpha) m_spec.alpha_channel = m_spec.nchannels;
        ++m_spec.nchannels;
        m_spec.channelnames.push_back(channel_name(extra));
    }
    if (normals) m_spec.attribute("normalEncoding", "unsigned");
    // What is in A is no opacity: nothing may be divided by it.
    if (m_spec.alpha_channel >= 0) m_spec.attribute("oiio:UnassociatedAlpha", 1);
    std::optional<Swizzle> pixels;
    if (info.channels > 1) pixels = normals ? kSwizzleXyz : texture_.swizzle;
    describe(texture_, pixels, extras_, m_spec);
    return {};
}

// Looks at the base level. Blue that does not vary, or repeats a component, is a part of a layout without z.
Result<void> Input::find_extras(bool has_lengths) {
    const auto is_free = [this](std::size_t channel) {
        const Component held = texture_.swizzle[channel];
        const bool is_part = held == Component::x || held == Component::y || held == Component::z;
        return static_cast<int>(channel) < format_info(texture_.format).channels && !is_part;
    };
    extras_ = {is_free(2) && texture_.swizzle[2] != Component::one, is_free(3), has_lengths};
    if (extras_ == ExtraSet()) return {};
    const Result<NormalMap> base = unpacked(0);
    extras_ = {};
    if (!base) return base.error();
    extras_.alpha = !base->alpha.empty();
    extras_.blue = !base->blue.empty() && !is_constant(base->blue);
    extras_.length = !base->length.empty();
    return {};
}

TypeDesc Input::type() const {
    const FormatInfo info = format_info(texture_.format);
    const bool is_signed = info.sample == SampleKind::snorm;
    if (what_ == Pixels::normals) return TypeDesc::UINT16;
    if (what_ != Pixels::stored) return TypeDesc::FLOAT;
    if (info.sample == SampleKind::floating) return info.bits == 16 ? TypeDesc::HALF : TypeDesc::FLOAT;
    if (info.bits == 16) return is_signed ? TypeDesc::INT16 : TypeDesc::UINT16;
    return is_signed ? TypeDesc::INT8 : TypeDesc::UINT8;
}

bool Input::close() {
    texture_ = Texture();
    pixels_ = {};
    extras_ = {};
    level_ = 0;
    made_ = -1;
    return true;
}

bool Input::seek_subimage(int subimage, int level) {
    if (subimage != 0 || level < 0 || level >= static_cast<int>(texture_.levels.size())) return false;
    const Extent extent = texture_.levels[static_cast<std::size_t>(level)].extent;
    level_ = level;
    m_spec.width = m_spec.full_width = extent.width;
    m_spec.height = m_spec.full_height = extent.height;
    return true;
}

bool Input::read_native_scanline(int subimage, int level, int y, int, void* data) {
    const lock_guard lock(*this);
    return no_throw(*this, [&] {
        if (!seek_subimage(subimage, level)) {
            errorfmt("{}: there is no level {}", path_, level);
            return false;
        }
        if (y < 0 || y >= m_spec.height) {
            errorfmt("{}: level {} has no row {}", path_, level, y);
            return false;
        }
        const Result<void> made = make_pixels();
        if (!made) {
            errorfmt("{}: {}", path_, made.error().reason);
            return false;
        }
        const std::vector<std::byte>& pixels =
            what_ == Pixels::stored ? texture_.levels[static_cast<std::size_t>(level)].bytes : pixels_;
        const std::size_t pitch = m_spec.scanline_bytes();
        std::memcpy(data, &pixels[pitch * static_cast<std::size_t>(y)], pitch);
        return true;
    });
}

Result<void> Input::make_pixels() {
    if (what_ == Pixels::stored || made_ == level_) return {};
    made_ = -1;
    pixels_ = {};
    Result<void> made = what_ == Pixels::channels ? make_channels() : make_normals();
    if (made) made_ = level_;
    return made;
}

// Decoded planes, interleaved.
Result<void> Input::make_channels() {
    const Result<Image> image = decode(texture_, level_, {threads(), {}});
    if (!image) return image.error();
    const std::size_t channels = image->planes.size();
    const Extent extent = image->extent();
    pixels_.resize(bytes_of(TypeDesc::FLOAT, static_cast<int>(channels), extent));
    std::byte* at = pixels_.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (std::size_t k = 0; k < channels; ++k, at += sizeof(float))
                std::memcpy(at, &image->planes[k].row(j)[i], sizeof(float));
        }
    }
    return {};
}

// The normals of a level, and the data beside them.
Result<NormalMap> Input::unpacked(int level) const {
    // If nothing states how floats are read, the base level decides; it is unpacked, too.
    const bool needs_base = what_ == Pixels::floats && texture_.normal_encoding.empty();
    const auto first = needs_base ? texture_.levels.begin() : texture_.levels.begin() + level;
    Texture part;
    part.format = texture_.format;
    part.swizzle = texture_.swizzle;
    part.y_axis = texture_.y_axis;
    part.normal_encoding = texture_.normal_encoding;
    part.levels.assign(first, texture_.levels.begin() + level + 1);
    UnpackOptions options;
    options.others = extras_;
    Result<MipChain> chain = unpack(part, options, {threads(), {}});
    if (!chain) return chain.error();
    return std::move(chain->levels.back());
}

// Unpacks this level and packs it as colours, as unpack-normals does.
Result<void> Input::make_normals() {
    Result<NormalMap> map = unpacked(level_);
    if (!map) return map.error();
    NormalMap extras;
    for (const Extra extra : kExtras) extras[extra] = std::exchange((*map)[extra], {});

    const bool as_floats = what_ == Pixels::floats;
    PackOptions options;
    options.encoding = as_floats ? Encoding::float_ : Encoding::rgb16;
    options.y_axis = texture_.y_axis;
    MipChain chain;
    chain.levels.push_back(std::move(*map));
    Result<PackedTexture> colours = pack(chain, options, {threads(), {}});
    if (!colours) return colours.error();
    pixels_ = std::move(colours->levels.front().bytes);
    if (as_floats) to_colours(pixels_);
    if (extras_ == ExtraSet()) return {};
    for (Plane<float> NormalMap::*const plane : {&NormalMap::x, &NormalMap::y, &NormalMap::z})
        extras.*plane = std::move(chain.levels.front().*plane);
    add_channels(extras, extras_, as_floats, pixels_);
    return {};
}

}  // namespace tex::oiio
