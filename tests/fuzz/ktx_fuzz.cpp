// SPDX-License-Identifier: Apache-2.0
// A KTX file of any bytes is read or refused, any of its layers; what is read is whole, and can be unpacked and written
// again.

#include <cstdint>

#include "formats/ktx/ktx.h"
#include "fuzz/whole_texture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tex::ReadOptions options = fuzz_options();
    for (const char* layer : {"", "0", "1", "5"}) {
        options.layer = layer;
        const auto texture =
            tex::load_texture(tex::parse_ktx, reinterpret_cast<const std::byte*>(data), size, "fuzz.ktx", options);
        if (texture) expect_whole(*texture);
    }
    return 0;
}
