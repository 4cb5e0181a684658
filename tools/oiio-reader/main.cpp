// SPDX-License-Identifier: Apache-2.0
// tex-reader-oiio: decodes pictures with OpenImageIO for libtex, which starts it. Do not run it by hand,
// except
//
//     tex-reader-oiio --version  prints OpenImageIO's version, and whether the kernel supports the restriction of files
//                                and the filter of system calls

#include <OpenImageIO/imageio.h>

#include <cstring>
#include <string_view>

#include "oiio.h"

namespace tex::reader {
namespace {

// Turns off what a decoder could use besides its input file: threads and plug-ins. (The process has no environment.)
void calm_openimageio() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("plugin_searchpath", "");
    OIIO::attribute("limits:channels", kMaxReaderChannels);
}

bool decode_or_describe(const Task& task, ReaderHeader& header) {
    calm_openimageio();
    if (task.verb == "decode") return decode_picture(task, header);
    std::strncpy(header.reason, OIIO_VERSION_STRING, sizeof header.reason - 1);
    return true;
}

// Landlock restricts a thread, and those that it starts later; and some of the 260 libraries start threads while they
// are initialised. All of them are loaded when the functions of this section run, and none is initialised.
#ifndef TEX_READER_SHADOW
void restrict_early(int argc, char** /*argv*/, char** /*environment*/) {
    if (argc == kReaderArguments) restrict_files();
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const kRestrictEarly)(int, char**, char**) = restrict_early;
#endif

}  // namespace
}  // namespace tex::reader

int main(int argc, char** argv) {
    return tex::reader::run_program("tex-reader-oiio", "OpenImageIO " OIIO_VERSION_STRING, argc, argv,
                                    tex::reader::decode_or_describe);
}
