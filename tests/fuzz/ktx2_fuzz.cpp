// SPDX-License-Identifier: Apache-2.0
// A KTX2 file of any bytes is read or refused; what is read is whole, and can be unpacked and written again.

#include <cstdint>
#include <cstdlib>

#include <tex/container.h>
#include <tex/unpack.h>

#include "containers/ktx2.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tex::ReadOptions options;
    options.max_texels = 1 << 20;
    const auto texture = tex::decode_ktx2(reinterpret_cast<const std::byte*>(data), size, "fuzz.ktx2", options);
    if (!texture) return 0;
    for (const tex::Level& level : texture->levels) {
        if (level.bytes.size() != tex::level_bytes(texture->format, level.extent)) std::abort();
    }
    tex::Execution one;
    one.threads = 1;
    if (!tex::decode(*texture, 0, one)) std::abort();
    static_cast<void>(tex::unpack(*texture, {}, one));  // may refuse: a height map has no x
    for (const tex::Container container : {tex::Container::dds, tex::Container::ktx2}) {
        if (!tex::encode_file(*texture, container)) std::abort();
    }
    return 0;
}
