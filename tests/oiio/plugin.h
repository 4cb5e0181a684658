// SPDX-License-Identifier: Apache-2.0
// plugin.h: the plug-in of OpenImageIO, for its tests: in this process, and in OpenImageIO's programs.

#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tex/tex.h>

#include "cli/program.h"

namespace tex::oiio {

// A new reader and writer of the plug-in's format. The first call makes OpenImageIO search the build folder.
std::unique_ptr<OIIO::ImageInput> new_input();
std::unique_ptr<OIIO::ImageOutput> new_output();

// Runs a shell script with OpenImageIO's programs, which find the plug-in, and the commands of the build.
cli::Ran shell(const Scratch& scratch, const std::string& script);

// A bumpy map with all its levels.
MipChain bumpy_chain(Extent extent);

// All pixels of a level as floats, interleaved; empty if the plug-in reports an error.
std::vector<float> pixels_of(OIIO::ImageInput& input, int level);

// The encoding that the plug-in states for files of an encoding: what is in an alpha of 16 bits or floats is not read.
inline std::string read_as(std::string_view encoding) {
    return encoding == "rgba16"    ? "rgb16"
           : encoding == "rgba16f" ? "half"
           : encoding == "rgba32f" ? "float"
                                   : std::string(encoding);
}

}  // namespace tex::oiio
