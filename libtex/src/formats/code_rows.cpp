// SPDX-License-Identifier: Apache-2.0

#include "formats/code_rows.h"

#include <cstdint>
#include <cstring>
#include <utility>

#include "kernels/samples.h"

namespace tex::inline v1 {
namespace {

template <class Code>
void store_codes(const std::byte* from, std::size_t step, int count, float greatest, float* to) {
    for (int i = 0; i < count; ++i, from += step) {
        Code code;
        std::memcpy(&code, from, sizeof code);
        to[i] = static_cast<float>(code) / greatest;
    }
}

}  // namespace

void CodeRows::describe_codes(Extent extent, std::vector<std::string> names, int bits) {
    const std::size_t texel = names.size() * (bits > 8 ? 2 : 1);
    describe(extent, std::move(names), static_cast<std::size_t>(extent.width) * texel, SampleKind::unorm, bits);
}

void CodeRows::store(const std::byte* rows, int first, int end, Image& image) const {
    const int bits = head_.bits;
    const std::size_t channels = names().size(), code = bits > 8 ? 2 : 1;
    const auto greatest = static_cast<float>((1 << bits) - 1);
    for (int j = first; j < end; ++j, rows += row_bytes()) {
        for (std::size_t c = 0; c < channels; ++c) {
            const std::byte* const from = rows + c * code;
            float* const to = image.planes[c].row(j);
            if (bits == 8 || bits == 16)
                decode_samples(SampleKind::unorm, bits, from, channels * code, extent().width, to);
            else if (code == 1)
                store_codes<std::uint8_t>(from, channels, extent().width, greatest, to);
            else
                store_codes<std::uint16_t>(from, channels * code, extent().width, greatest, to);
        }
    }
}

}  // namespace tex::inline v1
