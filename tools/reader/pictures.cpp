// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/imageio.h>

#include <cstring>

#include "reader.h"

namespace tex::reader {

void calm_openimageio() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("plugin_searchpath", "");
    OIIO::attribute("tiff:half", 1);
    OIIO::attribute("limits:channels", kMaxReaderChannels);
}

namespace {

bool read_or_write(const Task& task, ReaderHeader& header) {
    if (task.verb == "decode") return decode(task, header);
    if (task.verb == "encode") return encode(task, header);
    std::strncpy(header.reason, OIIO_VERSION_STRING, sizeof header.reason - 1);
    return true;
}

}  // namespace

const Work kPictures = {calm_openimageio, read_or_write};

}  // namespace tex::reader
