// SPDX-License-Identifier: Apache-2.0
// color.h: colour spaces of height maps.
//
// Heights are data: libtex reads raw values, whatever a file claims. Where a height map was saved through a transfer
// curve all the same (sRGB painted in an image editor, say), naming its colour space makes the values linear again.
// Normals are never converted.

#pragma once

#include <string>

#include <tex/image.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct ColorOptions {
    std::string space;  // a colour space, role or alias of the configuration; without one "sRGB" or "linear" (any case)
    std::string
        config;  // an OpenColorIO configuration file (or "ocio://..." name); empty: the built-in sRGB curve alone
};

// Converts the planes R, G and B of `image` (of a grey picture its one plane, as R = G = B) from options.space to the
// configuration's scene_linear role, in place. Alpha and other planes stay as they are. With a configuration
// OpenColorIO computes, and the result may differ in the last bits between processors; the built-in curve (IEC
// 61966-2-1:1999) gives the same bytes everywhere.
//
// Errors: bad_option  no such colour space (the reason lists some that there are); the configuration has no
// scene_linear role
//         io          the configuration cannot be read
//         bad_data    the configuration is damaged
//         out_of_memory
[[nodiscard]] Result<void> to_linear(Image& image, const ColorOptions& options);

// "2.1.2": of the library that converts.
[[nodiscard]] const char* opencolorio_version();

}  // namespace tex
#pragma GCC visibility pop
