// SPDX-License-Identifier: Apache-2.0
// png_state.h: what reading and writing PNG have in common: libpng's objects, and how they stop.

#pragma once

#include <png.h>

namespace tex {

struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    char reason[128] = {};  // why they stopped
    bool out_of_memory = false;
};

// libpng's callbacks; the error and memory pointers are the PngState.
[[noreturn]] void on_png_error(png_structp png, png_const_charp message);
void on_png_warning(png_structp png, png_const_charp message);
png_voidp on_png_allocate(png_structp png, png_alloc_size_t size);
void on_png_free(png_structp png, png_voidp memory);

}  // namespace tex
