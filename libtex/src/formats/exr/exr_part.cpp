// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_part.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include "formats/size_limits.h"
#include "rows/channel_names.h"

namespace tex::inline v1 {
namespace {

// The greatest number of bytes that one byte of the file can stand for.
double best_ratio(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION: return 1.0;
        case Imf::RLE_COMPRESSION: return 64.0;  // a run of 128 in 2 bytes
        case Imf::PXR24_COMPRESSION: return 4.0 / 3.0 * kDeflateRatio;
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION: return 32.0 / 3.0;  // 16 halves in 3 bytes
        case Imf::DWAA_COMPRESSION:
        case Imf::DWAB_COMPRESSION: return 64.0 * kDeflateRatio;  // a block of 64 without AC terms, deflated
        default: return kDeflateRatio;                            // ZIP, ZIPS; PIZ has runs of 255 halves in 9 bits
    }
}

// Reasons quote names from the file, which may contain anything. Everything except plain text is removed.
void keep_plain_text(std::string& text) {
    std::erase_if(text, [](char c) { return c < 0x20 || c > 0x7e; });
}

// The types whose values have a fixed size, in bytes.
struct FixedType {
    std::string_view name;
    std::uint64_t bytes;
};

constexpr FixedType kFixedTypes[] = {
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
};

// A compression that this OpenEXR does not know.
struct UnknownCompression : Iex::InputExc {
    using InputExc::InputExc;
};

// 10 and 11 came with OpenEXR 3.4.
void check_compression(int code) {
    if (code < Imf::NUM_COMPRESSION_METHODS) return;
    throw UnknownCompression(code == 10 || code == 11 ? "compressed with HTJ2K, which is not supported; exrmetrics of "
                                                        "OpenEXR 3.4 converts it (--convert -z zip)"
                                                      : "an unknown compression, number " + std::to_string(code));
}

// Walks the headers in the same way as OpenEXR. OpenEXR reads most values without using the size that precedes them. A
// size that differs from that of the value would make the two walks diverge; it counts as damage.
class HeaderWalk {
public:
    explicit HeaderWalk(ExrStream& stream) : stream_(stream) {}

    std::int32_t integer() {
        std::int32_t value = 0;
        stream_.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }

    std::string text() {
        constexpr std::size_t kLongest = 255;
        std::string text;
        while (text.size() <= kLongest) {
            char c = 0;
            stream_.read(&c, 1);
            if (c == 0) return text;
            text += c;
        }
        throw Iex::InputExc("a name in the header does not end");
    }

    // The rest of an attribute, after its name.
    void attribute() {
        const std::string type = text();
        const std::int32_t bytes = integer();
        if (bytes < 0 || static_cast<std::uint64_t>(bytes) > stream_.size() - stream_.tellg()) {
            throw Iex::InputExc("an attribute claims " + std::to_string(bytes) + " bytes, more than the file holds");
        }
        const std::uint64_t end = stream_.tellg() + static_cast<std::uint64_t>(bytes);
        value(type, end);
        if (stream_.tellg() != end) throw Iex::InputExc("an attribute of the type " + type + " has a wrong size");
    }

private:
    void value(const std::string& type, std::uint64_t end) {
        for (const FixedType& fixed : kFixedTypes) {
            if (type != fixed.name) continue;
            skip(fixed.bytes);
            if (type == "compression") check_compression(last_byte());
            return;
        }
        if (type == "chlist") {
            constexpr std::uint64_t kChannel = 16;
            while (!text().empty()) skip(kChannel);
        } else if (type == "preview") {
            const auto width = static_cast<std::uint32_t>(integer());
            const auto height = static_cast<std::uint32_t>(integer());
            for (int channel = 0; channel < 4; ++channel) skip(std::uint64_t{width} * height);
        } else if (type == "stringvector") {
            while (stream_.tellg() < end) skip(static_cast<std::uint32_t>(integer()));
        } else if (type == "floatvector") {
            skip((end - stream_.tellg()) / sizeof(float) * sizeof(float));
        } else {
            stream_.seekg(end);
        }
    }
    int last_byte() {
        char byte = 0;
        stream_.seekg(stream_.tellg() - 1);
        stream_.read(&byte, 1);
        return static_cast<unsigned char>(byte);
    }
    void skip(std::uint64_t bytes) {
        if (bytes > stream_.size() - stream_.tellg()) {
            throw Iex::InputExc("an attribute claims " + std::to_string(bytes) + " bytes, more than the file holds");
        }
        stream_.seekg(stream_.tellg() + bytes);
    }

    ExrStream& stream_;
};

// Walks the attributes of all headers, then goes back to the beginning. Without this check, OpenEXR would allocate as
// much memory as an attribute claims before it finds that the file does not hold it. Returns where the headers end.
// Throws Iex::InputExc.
std::uint64_t check_attributes(ExrStream& stream) {
    constexpr std::int32_t kManyParts = 0x1000;
    HeaderWalk walk(stream);
    walk.integer();  // the magic number
    const bool many_parts = (walk.integer() & kManyParts) != 0;
    do {
        int attributes = 0;
        for (; !walk.text().empty(); ++attributes) walk.attribute();
        if (attributes == 0) break;
    } while (many_parts);
    const std::uint64_t end = stream.tellg();
    stream.seekg(0);
    return end;
}

}  // namespace

// OpenEXR puts its own introduction ('Cannot read image file "NAME". ') before every reason, sometimes twice. It is
// removed.
Error exr_error(const std::string& path, const std::exception& thrown) {
    std::string reason = thrown.what();
    constexpr std::string_view kOpening = "image file \"\". ";
    if (const auto at = reason.rfind(kOpening); at != std::string::npos) reason.erase(0, at + kOpening.size());
    keep_plain_text(reason);
    while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
    return {ErrorCode::bad_data, path, "damaged EXR: " + reason};
}

ExrStream::ExrStream(const InputFile& file)
    : Imf::IStream(""), file_(file), size_(static_cast<std::uint64_t>(*file.size())), buffer_(std::size_t{1} << 16) {}

bool ExrStream::read(char data[], int count) {
    const auto n = static_cast<std::size_t>(count);
    if (count < 0 || n > size_ || at_ > size_ - n) throw Iex::InputExc("the file ends too early");
    if (at_ >= buffered_from_ && at_ + n <= buffered_from_ + buffered_) {
        std::memcpy(data, buffer_.data() + (at_ - buffered_from_), n);
    } else if (n >= buffer_.size()) {
        fetch(reinterpret_cast<std::byte*>(data), at_, n);
    } else {
        buffered_ = 0;
        buffered_from_ = at_;
        const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size(), size_ - at_));
        fetch(buffer_.data(), at_, most);
        buffered_ = most;
        std::memcpy(data, buffer_.data(), n);
    }
    at_ += n;
    return at_ < size_;
}

void ExrStream::fetch(std::byte* to, std::uint64_t at, std::size_t n) {
    const Result<std::size_t> got = file_.read_at(static_cast<std::int64_t>(at), to, n);
    if (!got) failure_ = got.error();
    if (!got || *got < n) throw Iex::InputExc("the file ends too early");
}

Result<ExrHeaders> ExrHeaders::read(const InputFile& file) {
    ExrStream stream(file);
    try {
        ExrHeaders headers;
        std::uint64_t table = check_attributes(stream);
        constexpr int kNoThreads = 0;
        constexpr bool kKeepTable = false;  // a file whose table would have to be guessed is damaged
        const Imf::MultiPartInputFile exr(stream, kNoThreads, kKeepTable);
        for (int part = 0; part < exr.parts(); ++part) {
            headers.headers_.push_back(exr.header(part));
            headers.tables_.push_back(table);
            if (exr.header(part).hasChunkCount())
                table += sizeof table * static_cast<std::uint64_t>(std::max(0, exr.header(part).chunkCount()));
        }
        return headers;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const UnknownCompression& thrown) {
        return Error{ErrorCode::unsupported, file.path(), thrown.what()};
    } catch (const std::exception& thrown) {
        if (stream.failure()) return *stream.failure();
        return exr_error(file.path(), thrown);
    }
}

std::size_t value_bytes(Imf::PixelType type) {
    return type == Imf::HALF ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
}

std::vector<ExrChannel> channels_of(const Imf::Header& header) {
    std::vector<ExrChannel> channels;
    const Imf::ChannelList& list = header.channels();
    for (const char* name : {"R", "G", "B", "A"}) {
        if (const Imf::Channel* channel = list.findChannel(name)) channels.push_back({name, channel->type});
    }
    for (auto it = list.begin(); it != list.end(); ++it) {
        const std::string name = it.name();
        if (name != "R" && name != "G" && name != "B" && name != "A") channels.push_back({name, it.channel().type});
    }
    return channels;
}

namespace {

ExrLayer first_part(const ExrHeaders& headers) {
    ExrLayer layer{0, channels_of(headers[0])};
    const auto could_hold_normals = [&](int part) {
        return !channel_groups(names_of(channels_of(headers[part]))).empty();
    };
    for (int part = 1; part < headers.count() && layer.remark.empty(); ++part) {
        if (!could_hold_normals(part)) continue;
        const std::string name = headers[0].hasName() ? " " + list_of_names({headers[0].name()}) : std::string();
        layer.remark = "the first part" + name + " is read, of several that could hold normals";
    }
    return layer;
}

}  // namespace

Result<ExrLayer> find_layer(const ExrHeaders& headers, const std::string& name) {
    if (name.empty()) return first_part(headers);
    std::vector<std::string> names;  // of the channels of all parts
    std::vector<std::pair<int, ExrChannel>> channels;
    for (int part = 0; part < headers.count(); ++part) {
        const std::string part_name = headers[part].hasName() ? headers[part].name() + "." : std::string();
        for (const ExrChannel& channel : channels_of(headers[part])) {
            const bool is_complete = headers.count() == 1 || channel.name.starts_with(part_name);
            names.push_back(is_complete ? channel.name : part_name + channel.name);
            channels.emplace_back(part, channel);
        }
    }
    const Result<std::vector<std::size_t>> chosen = layer_channels(names, name);
    if (!chosen) return chosen.error();
    ExrLayer layer;
    layer.part = channels[chosen->front()].first;
    for (const std::size_t k : *chosen) {
        if (channels[k].first == layer.part) layer.channels.push_back(channels[k].second);
    }
    return layer;
}

std::vector<std::string> names_of(const std::vector<ExrChannel>& channels) {
    std::vector<std::string> names;
    names.reserve(channels.size());
    for (const ExrChannel& channel : channels) names.push_back(channel.name);
    return names;
}

std::optional<Imf::TileDescription> tiles_of(const Imf::Header& header) {
    // For a file of one part, OpenEXR sets the type from the version field.
    if (!header.hasType() || !Imf::isTiled(header.type()) || !header.hasTileDescription()) return std::nullopt;
    return header.tileDescription();
}

Result<Extent> check_header(const std::string& path, const Imf::Header& header, std::int64_t file_size,
                            const ReadOptions& options) {
    if (header.hasType() && !Imf::isImage(header.type())) {
        return Error{ErrorCode::unsupported, path,
                     "deep data have no single value for a texel; OpenImageIO flattens them: oiiotool FILE --flatten "
                     "-o FLAT.exr"};
    }
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    Result<Extent> extent = claimed_extent(path, width, height, options);
    if (!extent) return extent;

    std::int64_t texel_bytes = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.xSampling != 1 || channel.ySampling != 1) {
            std::string name = it.name();
            keep_plain_text(name);
            return Error{ErrorCode::unsupported, path, "the channel " + name + " is subsampled"};
        }
        texel_bytes += static_cast<std::int64_t>(value_bytes(channel.type));
    }
    const double decoded = static_cast<double>(extent->texels()) * static_cast<double>(texel_bytes);
    const Result<void> claim = check_claim(path, *extent, decoded, file_size, best_ratio(header.compression()));
    if (!claim) return claim.error();
    if (const auto tiles = tiles_of(header)) {  // OpenEXR allocates whole tiles, even for small pictures
        const std::uint64_t tile = std::uint64_t{tiles->xSize} * tiles->ySize;
        constexpr std::int64_t kSmall = std::int64_t{1} << 20;
        if (tile > static_cast<std::uint64_t>(std::max(kSmall, 4 * extent->texels()))) {
            return Error{ErrorCode::bad_data, path, "damaged EXR: the tiles are much larger than the picture"};
        }
    }
    return extent;
}

}  // namespace tex::inline v1
