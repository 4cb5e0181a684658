// SPDX-License-Identifier: Apache-2.0
// A KTX2 file of any bytes is read or refused; what is read is whole, and can be unpacked and written again.

#include <cstdint>

#include "formats/ktx2/ktx2.h"
#include "fuzz/whole_texture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tex::ReadOptions options = fuzz_options();
    for (const char* layer : {"", "1"}) {
        options.layer = layer;
        const auto texture =
            tex::load_texture(tex::parse_ktx2, reinterpret_cast<const std::byte*>(data), size, "fuzz.ktx2", options);
        if (texture) expect_whole(*texture);
    }
    return 0;
}
