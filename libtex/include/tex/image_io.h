// SPDX-License-Identifier: Apache-2.0
// image_io.h: reads pictures from files.
//
// The first bytes of a file, not its name, decide how it is read. PNG and EXR are decoded in this process, by libpng
// and OpenEXR; DDS and KTX2 by libtex. TIFF is decoded by libtiff and JPEG by libjpeg-turbo (tex-reader), everything
// else (TGA, BMP, HDR, PSD ...) by OpenImageIO (tex-reader-oiio), in a separate process for each file, under limits of
// memory and time. If such a decoder crashes or hangs, the result is an Error.

#pragma once

#include <cstdint>
#include <string>

#include <tex/image.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct ReadOptions {
    // Files that claim more texels than this are refused (unsupported) before memory is allocated.
    std::int64_t max_texels = std::int64_t{1} << 30;

    // The reader program, started for each file. Empty: the program that was installed (libexec/libtex/tex-reader) or
    // built beside libtex. tex-reader-oiio is in the same folder.
    std::string reader;
    std::int64_t reader_memory = std::int64_t{4} << 30;  // bytes: its address space, with its result
    int reader_timeout = 120;                            // seconds of wall-clock time
};

// Reads the base level of a picture with all its channels: raw values (see Image), unassociated alpha, top row first.
// PNG: 1 to 16 bits, grey, RGB, alpha, palette (expanded), transparency (as A), interlaced; colour chunks (gAMA, sRGB,
// iCCP, sBIT) change nothing. EXR: half, float and uint, scanline and tiled, mip-mapped, any channel names (R, G, B, A
// come first, the others by name); the data window; the first part of a multi-part file. Deep data and subsampled
// channels are unsupported. TIFF and JPEG are turned as their orientation (EXIF) says; x and y of a normal in them stay
// as they are stored. `path` "-" reads standard input.
//
// Errors: io           cannot be opened or read; is a directory; the reader program cannot be started
//         bad_data     empty, truncated, damaged; not a picture at all
//         unsupported  valid, but of a type not handled; more texels than max_texels; a side above kMaxExtent
//         out_of_memory
// No file content makes this function crash or hang beyond reader_timeout. The memory that it uses stays in proportion
// to the smaller of two sizes: the size that the file claims and the size that its bytes can hold.
[[nodiscard]] Result<Image> read_image(const std::string& path, const ReadOptions& options = {});

// The reader process, and the access rights that it gives up before it opens a file.
struct ReaderInfo {
    std::string program;
    std::string openimageio;        // its version; empty if tex-reader-oiio is not installed
    int landlock = 0;               // the kernel's version of Landlock; 0: none
    bool files_restricted = false;  // by Landlock: it can open no file except the input
    bool calls_filtered = false;    // by seccomp: no network, no writing, no other programs
};

// Starts both reader programs once to query them, which takes a fifth of a second. Errors: as read_image(), if
// tex-reader does not run.
[[nodiscard]] Result<ReaderInfo> reader_info(const ReadOptions& options = {});

}  // namespace tex
#pragma GCC visibility pop
