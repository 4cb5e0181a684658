// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_texels.h"

#include <isa-l.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>

namespace tex::inline v1 {
namespace {

constexpr std::uint32_t kMostBytes = 0x7fffffff;  // of a chunk

std::uint32_t number(const std::uint8_t* bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

bool is_letter(std::uint8_t c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

bool is_type(const std::uint8_t (&type)[4], const char (&name)[5]) { return std::memcmp(type, name, 4) == 0; }

}  // namespace

std::string png_inflater_version() {
    return std::to_string(ISAL_MAJOR_VERSION) + "." + std::to_string(ISAL_MINOR_VERSION) + "." +
           std::to_string(ISAL_PATCH_VERSION);
}

PngTexels::PngTexels(PngInput& input, std::uint32_t length, double decoded)
    : input_(input), stream_(new inflate_state), decoded_(decoded), left_(length),
      crc_(libdeflate_crc32(0, type_, sizeof type_)) {
    isal_inflate_init(stream_.get());
    stream_->crc_flag = ISAL_ZLIB_NO_HDR_VER;  // begin_stream() reads the header
}

PngTexels::~PngTexels() = default;

Result<bool> PngTexels::outcome(bool plain) const {
    if (input_.error()) return *input_.error();
    return plain;
}

Result<bool> PngTexels::read(std::uint8_t* to, std::size_t count) { return outcome(inflate_all(to, count)); }

Result<bool> PngTexels::finish() { return outcome(inflate_end() && end_chunk() && skip_to_end()); }

// The two bytes before the compressed data (RFC 1950). A window smaller than the largest must hold all bytes: otherwise
// it depends on the decoder how far a distance may reach.
bool PngTexels::begin_stream() {
    std::uint8_t header[2];
    for (std::uint8_t& byte : header) {
        while (left_ == 0) {
            if (!end_chunk() || !begin_chunk() || !is_type(type_, "IDAT")) return false;
        }
        if (!input_.take(&byte, 1)) return false;
        crc_ = libdeflate_crc32(crc_, &byte, 1);
        --left_;
    }
    constexpr unsigned kDeflate = 8, kDictionary = 0x20;
    const unsigned method = header[0] & 15u, window = header[0] >> 4;
    if (method != kDeflate || (header[0] << 8 | header[1]) % 31 != 0 || (header[1] & kDictionary) != 0) return false;
    begun_ = true;
    return window == 7 || (window < 7 && decoded_ <= static_cast<double>(256u << window));
}

// Gives the next bytes of the IDAT chunks to the inflater.
bool PngTexels::feed() {
    while (left_ == 0) {
        if (!end_chunk() || !begin_chunk() || !is_type(type_, "IDAT")) return false;
    }
    const std::span<const std::uint8_t> bytes = input_.some(left_);
    if (bytes.empty()) return false;
    crc_ = libdeflate_crc32(crc_, bytes.data(), bytes.size());
    left_ -= static_cast<std::uint32_t>(bytes.size());
    stream_->next_in = const_cast<std::uint8_t*>(bytes.data());
    stream_->avail_in = static_cast<std::uint32_t>(bytes.size());
    return true;
}

bool PngTexels::inflate_all(std::uint8_t* to, std::size_t count) {
    if (!begun_ && !begin_stream()) return false;
    inflate_state& stream = *stream_;
    stream.next_out = to;
    stream.avail_out = static_cast<std::uint32_t>(count);
    for (;;) {
        const std::uint32_t in = stream.avail_in, out = stream.avail_out;
        if (isal_inflate(&stream) != ISAL_DECOMP_OK) return false;
        if (stream.avail_out == 0) return true;
        if (stream.block_state == ISAL_BLOCK_FINISH) return false;  // too few bytes
        if (stream.avail_in == 0) {
            if (!feed()) return false;
        } else if (stream.avail_in == in && stream.avail_out == out) {
            return false;  // it would never end
        }
    }
}

// Reads the end of the compressed stream and its check value. They must be the last bytes of the chunk.
bool PngTexels::inflate_end() {
    inflate_state& stream = *stream_;
    std::uint8_t beyond = 0;
    stream.next_out = &beyond;
    stream.avail_out = 1;
    for (;;) {
        const std::uint32_t in = stream.avail_in;
        const bool fed = in != 0;
        if (isal_inflate(&stream) != ISAL_DECOMP_OK || stream.avail_out == 0) return false;
        if (stream.block_state == ISAL_BLOCK_FINISH) break;
        if (stream.avail_in == 0) {
            if (!feed()) return false;
        } else if (fed && stream.avail_in == in) {
            return false;
        }
    }
    return stream.avail_in == 0 && stream.read_in_length < 8 && left_ == 0;
}

bool PngTexels::begin_chunk() {
    std::uint8_t header[8];
    if (!input_.take(header, sizeof header)) return false;
    left_ = number(header);
    std::copy_n(header + 4, 4, type_);
    crc_ = libdeflate_crc32(0, type_, sizeof type_);
    return left_ <= kMostBytes && std::all_of(type_, type_ + 4, is_letter);
}

bool PngTexels::end_chunk() {
    std::uint8_t stored[4];
    return input_.take(stored, sizeof stored) && number(stored) == crc_;
}

// The chunks after the texels have no effect, but their check values must be right.
bool PngTexels::skip_to_end() {
    for (;;) {
        if (!begin_chunk()) return false;
        if (is_type(type_, "IEND")) return left_ == 0 && end_chunk();
        constexpr unsigned kAncillary = 0x20;
        if ((type_[0] & kAncillary) == 0) return false;
        while (left_ > 0) {
            const std::span<const std::uint8_t> bytes = input_.some(left_);
            if (bytes.empty()) return false;
            crc_ = libdeflate_crc32(crc_, bytes.data(), bytes.size());
            left_ -= static_cast<std::uint32_t>(bytes.size());
        }
        if (!end_chunk()) return false;
    }
}

}  // namespace tex::inline v1
