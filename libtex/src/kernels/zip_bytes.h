// SPDX-License-Identifier: Apache-2.0
// zip_bytes.h: the bytes of a ZIP chunk of OpenEXR before they are deflated (OpenEXR File Layout, "ZIP compression";
// ImfZip.cpp). Bytes at even places come first, then those at odd places. Each byte except the first is stored as its
// difference from the previous one, plus 128.

#pragma once

#include <cstddef>

namespace tex::inline v1 {

// Writes the differences of `count` bytes to `out`, which does not overlap `bytes`.
void predict_zip_bytes(const std::byte* bytes, std::size_t count, std::byte* out);

// Writes the bytes with these differences to `out`, which does not overlap `differences`.
void restore_zip_bytes(const std::byte* differences, std::size_t count, std::byte* out);

}  // namespace tex::inline v1
