// SPDX-License-Identifier: Apache-2.0
// A BMP of any bytes is read or refused; what is read is the same when its rows come in another order.

#include "formats/bmp/bmp.h"
#include "fuzz/any_order.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    expect_same_in_any_order({reinterpret_cast<const std::byte*>(data), size}, tex::open_bmp);
    return 0;
}
