// SPDX-License-Identifier: Apache-2.0
// usable.h: whether what a caller hands over can be worked on. Every verb asks first. Errors: bad_option.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The Error for an option out of its range: "gaussian_sigma: must be above 0 and at most 64".
[[nodiscard]] Error bad_option(std::string_view reason);

// A value of an enumeration that has a row in the table of its names; other numbers can come from bindings.
template <class E, std::size_t N>
[[nodiscard]] Result<void> check_known(std::string_view option, const Named<E> (&table)[N], E value) {
    if (!name_of(table, value).empty()) return {};
    return bad_option(std::string(option) + ": unknown value");
}
template <class E, std::size_t N>
[[nodiscard]] Result<void> check_known(std::string_view option, const Named<E> (&table)[N], std::optional<E> value) {
    return value ? check_known(option, table, *value) : Result<void>();
}

// The first of these that is an error.
template <class... Results>
[[nodiscard]] Result<void> first_error(const Results&... results) {
    for (const Result<void>* result : {&results...}) {
        if (!*result) return *result;
    }
    return {};
}

// An extent of at least 1x1 and at most kMaxExtent, of `what`: "the map".
[[nodiscard]] Result<void> check_usable(Extent extent, std::string_view what);
// Planes of one such extent; a picture has at least one, and a name for each.
[[nodiscard]] Result<void> check_usable(const NormalMap& map);
[[nodiscard]] Result<void> check_usable(const Image& image);
// At least one level; the extents are those of level_extent().
[[nodiscard]] Result<void> check_usable(const MipChain& chain);
// At least one level, of the right extent, and each level has level_bytes() bytes.
[[nodiscard]] Result<void> check_usable(const Texture& texture);

}  // namespace tex::inline v1
