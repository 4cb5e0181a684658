// SPDX-License-Identifier: Apache-2.0
// attributes.h: the attributes of OpenImageIO's ImageSpec that the plug-in knows. tex-oiio(7) is their manual.
//
// The plug-in consists of a reader (input.h) and a writer (output.h). It uses the public headers of libtex alone. No
// exception leaves it: OpenImageIO and its programs catch none.

#pragma once

#include <OpenImageIO/imageio.h>

#include <exception>
#include <optional>
#include <string>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::oiio {

// The name of the format, of the file (tex.imageio.so) and of all attributes (tex:...).
inline constexpr const char* kFormatName = "tex";

// The channel of a picture for an extra channel of its normals. The reader returns them in the order of kExtras.
[[nodiscard]] inline std::string channel_name(Extra extra) {
    return extra == Extra::alpha ? "A" : std::string(name_of(kExtraNames, extra));
}

// What the attributes of a picture ask for when it is written.
struct Wanted {
    UnpackOptions pixels;            // how the pixels hold normals
    std::optional<Encoding> format;  // none: default_encoding() of the file type
    std::optional<YAxis> y;          // of the file; none: as the pixels
    PackOptions pack;                // effort and metric
    WriteOptions write;
    bool keep_levels = true;  // the levels that were sent; otherwise they are built from the base level
    int levels = 0;           // that are built, as in MipOptions
    ExtraKind blue = ExtraKind::mask, alpha = ExtraKind::mask;  // what such levels get
};

// Reads them. An attribute tex:... that does not exist, and a value that is not one of its words, is an error
// (bad_option).
[[nodiscard]] Result<Wanted> wanted_of(const OIIO::ImageSpec& spec);

// How a file is read, as the configuration given to ImageInput::open() asks.
struct Reading {
    bool unpack = true;        // normals as colours; otherwise the channels as they are stored
    bool has_lengths = false;  // the lengths of vectors are data
    std::optional<Swizzle> swizzle;
};
[[nodiscard]] Result<Reading> reading_of(const OIIO::ImageSpec& config);

// Adds what the file states. `pixels` is the layout of the pixels, if they are those of normals, and `extras` the data
// beside them.
void describe(const Texture& texture, const std::optional<Swizzle>& pixels, ExtraSet extras, OIIO::ImageSpec& spec);

// Calls body(), which returns true or has called errorfmt() of `plugin`. An exception becomes an error, too.
template <class Plugin, class Body>
bool no_throw(const Plugin& plugin, Body&& body) noexcept {
    try {
        try {
            return body();
        } catch (const std::bad_alloc&) {
            plugin.errorfmt("{}", "out of memory");
        } catch (const std::exception& e) {
            plugin.errorfmt("{}", e.what());
        }
    } catch (...) {  // no memory for the message either
    }
    return false;
}

}  // namespace tex::oiio
