// SPDX-License-Identifier: Apache-2.0
// tex-pictures.so: the program that tex-reader loads and runs (main.cpp). It decodes and encodes pictures with
// OpenImageIO for libtex, which starts it. Do not run tex-reader by hand, except
//
//     tex-reader --version      prints OpenImageIO's version, and whether the kernel supports the restriction of files
//                               and the filter of system calls

#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <string_view>

#include "reader.h"

namespace tex::reader {
namespace {

int version() {
    const bool restricted = restrict_files();
    const bool filtered = filter_calls();
    std::printf("OpenImageIO %s, files %s, system calls %s\n", OIIO_VERSION_STRING,
                restricted ? "restricted" : "not restricted", filtered ? "filtered" : "not filtered");
    return std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tex::reader

extern "C" [[gnu::visibility("default")]] int tex_read_pictures(int argc, char** argv) {
    using namespace tex::reader;
    const std::string_view verb = argc > 1 ? argv[1] : "";
    // The process always ends without running destructors: those of OpenImageIO's libraries take a tenth of a second,
    // and the sandbox makes no allowance for them.
    if (argc == 2 && verb == "--version") _exit(version());
    int parent = 0;
    if (argc == 3 && verb == "zygote" && parse_number(argv[2], parent)) _exit(serve(parent));
    Task task;
    if (!parse_task(argc, argv, task) || (verb != "decode" && verb != "encode" && verb != "describe")) {
        static_cast<void>(std::fputs("tex-reader: started by libtex, not by hand\n", stderr));
        return 2;
    }
    _exit(run(task, kPictures));
}
