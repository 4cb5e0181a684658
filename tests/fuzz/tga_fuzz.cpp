// SPDX-License-Identifier: Apache-2.0
// A TGA of any bytes is read or refused; what is read is the same when its rows come in another order.

#include "formats/tga/tga.h"
#include "fuzz/any_order.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
    if (tex::may_be_tga(bytes)) expect_same_in_any_order(bytes, tex::open_tga);
    return 0;
}
