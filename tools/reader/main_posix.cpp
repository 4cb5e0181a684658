// SPDX-License-Identifier: Apache-2.0
// tex-reader: decodes and encodes TIFF and JPEG, and decodes EXR, for libtex, which starts it. Do not run it by hand,
// except
//
//     tex-reader --version      prints the versions of the decoders, and whether the kernel supports the restriction of
//                               files and the filter of system calls

#include <tiffvers.h>

#include "decoders.h"

#define TEX_TEXT_OF(number) #number
#define TEX_TEXT(number) TEX_TEXT_OF(number)

int main(int argc, char** argv) {
    return tex::reader::run_program("tex-reader", "libtiff " TEX_TEXT(TIFFLIB_VERSION), argc, argv,
                                    tex::reader::read_or_write);
}
