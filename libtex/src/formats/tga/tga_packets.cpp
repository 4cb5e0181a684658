// SPDX-License-Identifier: Apache-2.0

#include "formats/tga/tga_packets.h"

#include <algorithm>
#include <cstring>

namespace tex::inline v1 {

bool TgaPackets::take_run() {
    run_place_ = bytes_.position();
    const std::byte* const texel = bytes_.take(texel_bytes_);
    if (texel == nullptr) return false;
    std::memcpy(run_, texel, texel_bytes_);
    return true;
}

bool TgaPackets::take_packet() {
    const std::byte* const packet = bytes_.take(1);
    if (packet == nullptr) return false;
    left_ = 1 + std::to_integer<int>(*packet & std::byte{0x7f});
    is_run_ = (*packet & std::byte{0x80}) != std::byte{0};
    return !is_run_ || take_run();
}

bool TgaPackets::read(int texels, std::byte* out) {
    while (is_sound_ && texels > 0) {
        if (left_ == 0 && !(is_sound_ = take_packet())) break;
        const int count = std::min(left_, texels);
        const std::size_t bytes = static_cast<std::size_t>(count) * texel_bytes_;
        if (!is_run_) {
            const std::byte* const from = bytes_.take(bytes);
            is_sound_ = from != nullptr;
            if (is_sound_ && out != nullptr) std::memcpy(out, from, bytes);
        } else if (out != nullptr) {
            for (std::size_t at = 0; at < bytes; at += texel_bytes_) std::memcpy(out + at, run_, texel_bytes_);
        }
        if (out != nullptr) out += bytes;
        left_ -= count;
        texels -= count;
    }
    return is_sound_;
}

}  // namespace tex::inline v1
