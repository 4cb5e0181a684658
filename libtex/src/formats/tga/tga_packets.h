// SPDX-License-Identifier: Apache-2.0
// tga_packets.h: the RLE packets of a TGA. A packet is a byte with a count, then one texel that is repeated, or that
// many texels. Old files have packets that cross the ends of rows.

#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/byte_range.h"

namespace tex::inline v1 {

// Where a row begins: at a packet, or in one, of which `left` texels are left. They begin at `place`; the one texel of
// a run is there.
struct TgaRowStart {
    std::int64_t place = 0;
    std::uint8_t left = 0;
    bool is_run = false;
};

class TgaPackets {
public:
    // Continues a row that begins in these bytes.
    TgaPackets(ByteRange& bytes, std::size_t texel_bytes, TgaRowStart start)
        : bytes_(bytes), texel_bytes_(texel_bytes), left_(start.left), is_run_(start.is_run) {
        is_sound_ = left_ == 0 || !is_run_ || take_run();
    }

    // Moves over the next texels, and copies them if `out` is not null. False if the bytes end: see ByteRange::error().
    bool read(int texels, std::byte* out);

    // Where the next row begins.
    [[nodiscard]] TgaRowStart next() const {
        return {left_ > 0 && is_run_ ? run_place_ : bytes_.position(), static_cast<std::uint8_t>(left_), is_run_};
    }

private:
    bool take_run();
    bool take_packet();

    ByteRange& bytes_;
    const std::size_t texel_bytes_;
    int left_;
    bool is_run_;
    bool is_sound_ = true;
    std::byte run_[4] = {};
    std::int64_t run_place_ = 0;
};

}  // namespace tex::inline v1
