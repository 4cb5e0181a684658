// SPDX-License-Identifier: Apache-2.0
// key_values.h: the keys and values that KTX and KTX2 files hold.

#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace tex::inline v1 {

// They point into the bytes from which they were read.
struct KeyValue {
    std::string_view key;
    std::string_view value;  // without the final zero of a string
};

// nullopt if the entries are inconsistent. KTX files may be big-endian.
std::optional<std::vector<KeyValue>> parse_key_values(const std::vector<std::byte>& bytes, bool big_endian);

}  // namespace tex::inline v1
