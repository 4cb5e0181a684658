// SPDX-License-Identifier: Apache-2.0
// An OBJ file of any bytes is read or refused; what is read is whole, and tangents can be made.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/whole_mesh.h"
#include "mesh/obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto mesh = tex::parse_obj(text, true);
    if (mesh && tex::is_obj(text)) expect_whole(*mesh);
    return 0;
}
