// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_state.h"

#include <cstdlib>
#include <cstring>

namespace tex::inline v1 {

void on_png_error(png_structp png, png_const_charp message) {
    auto* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::strncpy(state->reason, message, sizeof state->reason - 1);
    png_longjmp(png, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

png_voidp on_png_allocate(png_structp png, png_alloc_size_t size) {
    auto* state = static_cast<PngState*>(png_get_mem_ptr(png));
    if (size > state->most_bytes) png_error(png, "the file ends too early");
    void* memory = std::malloc(size);
    if (memory == nullptr) state->out_of_memory = true;
    return memory;
}

void on_png_free(png_structp, png_voidp memory) { std::free(memory); }

}  // namespace tex::inline v1
