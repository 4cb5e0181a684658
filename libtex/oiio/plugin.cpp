// SPDX-License-Identifier: Apache-2.0
// What OpenImageIO looks for in a plug-in called tex.imageio.so.

#include <OpenImageIO/imageio.h>

#include <tex/tex.h>

#include "input.h"
#include "output.h"

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int tex_imageio_version = OIIO_PLUGIN_VERSION;
OIIO_EXPORT const char* tex_imageio_library_version() {
    static const std::string version = std::string("libtex ") + tex::version();
    return version.c_str();
}

// OpenImageIO's own reader keeps .dds: it is there first. There is no other writer of .dds.
OIIO_EXPORT OIIO::ImageInput* tex_input_imageio_create() { return new tex::oiio::Input; }
OIIO_EXPORT const char* tex_input_extensions[] = {"ktx2", "astc", "dds", nullptr};

OIIO_EXPORT OIIO::ImageOutput* tex_output_imageio_create() { return new tex::oiio::Output; }
OIIO_EXPORT const char* tex_output_extensions[] = {"dds", "ktx2", "astc", nullptr};

OIIO_PLUGIN_EXPORTS_END
