// SPDX-License-Identifier: Apache-2.0
// color.h: colour spaces of height maps.
//
// Heights are data: libtex reads raw values, whatever a file claims. If a height map was saved with a transfer curve
// nevertheless (painted as sRGB in an image editor, for example), to_linear() makes its values linear again. Normals
// are never converted.

#pragma once

#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct ColorOptions {
    // A colour space, role or alias of the configuration; without one, "sRGB" or "linear" (any case).
    std::string space;
    // An OpenColorIO configuration file (or "ocio://..." name); empty: only the built-in sRGB curve.
    std::string config;
};

// Converts the planes R, G and B of `image` (in a grey picture its one plane, as R = G = B) from options.space to the
// configuration's scene_linear role, in place. Alpha and other planes are unchanged. With a configuration, OpenColorIO
// computes the result, which may differ in the last bits between processors; the built-in curve (IEC 61966-2-1:1999)
// gives the same bytes everywhere.
//
// Errors: bad_option  no such colour space (the reason lists some that exist); the configuration has no
//                     scene_linear role
//         io          the configuration cannot be read
//         bad_data    the configuration is damaged
//         out_of_memory
[[nodiscard]] Result<void> to_linear(Image& image, const ColorOptions& options);

// The files on which to_linear() depends: the configuration, if it is a file, and the tables (LUTs) that it uses for
// options.space. Empty without a configuration. OpenColorIO keeps tables in memory; after this call, to_linear() reads
// them again. Errors: those of to_linear() that concern the configuration.
[[nodiscard]] Result<std::vector<std::string>> color_files(const ColorOptions& options);

// The version of OpenColorIO: "2.1.2".
[[nodiscard]] const char* opencolorio_version();

}  // namespace tex
#pragma GCC visibility pop
