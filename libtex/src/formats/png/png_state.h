// SPDX-License-Identifier: Apache-2.0
// png_state.h: the common part of reading and writing PNG: libpng's objects, and how they report an error.

#pragma once

#include <png.h>

#include <limits>

namespace tex::inline v1 {

struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    char reason[128] = {};  // why libpng stopped
    bool out_of_memory = false;
    // The most bytes that libpng may ask for at once. It asks for as many as a chunk claims to have.
    png_alloc_size_t most_bytes = std::numeric_limits<png_alloc_size_t>::max();
};

// Callbacks of libpng. The error and memory pointers are the PngState.
[[noreturn]] void on_png_error(png_structp png, png_const_charp message);
void on_png_warning(png_structp png, png_const_charp message);
png_voidp on_png_allocate(png_structp png, png_alloc_size_t size);
void on_png_free(png_structp png, png_voidp memory);

}  // namespace tex::inline v1
