// SPDX-License-Identifier: Apache-2.0
// image_io.h: reads pictures from files.
//
// The first bytes of a file, not its name, decide how it is read. PNG and EXR are decoded in this process, by libpng
// and OpenEXR; DDS, KTX, TGA, BMP and ESRI ASCII grids by libtex. TIFF is decoded by libtiff, JPEG by libjpeg-turbo,
// everything else (HDR, PSD ...) by OpenImageIO (tex-reader-oiio), in a separate process for each file, under limits of
// memory and time. If such a decoder crashes or hangs, the result is an Error.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// What integers in a file become.
enum class FileValues { automatic, stored, unit };

inline constexpr Named<FileValues> kFileValuesNames[] = {
    {FileValues::automatic, "auto", "as the file says"},
    {FileValues::stored, "stored", "the numbers that the file stores, with GDAL's scale and offset"},
    {FileValues::unit, "unit", "0 to 1 (signed: -1 to 1) for the whole range of the type"},
};

struct ReadOptions {
    // Files that claim more texels than this are refused (unsupported) before memory is allocated.
    std::int64_t max_texels = std::int64_t{1} << 30;

    // The layer of an EXR file whose channels are read, by its name or the end of it: "Normal" for "ViewLayer.Normal".
    // Empty: all channels. The number of a layer of a texture array in DDS, KTX or KTX2, or of a face of a cube map
    // (6 n + 0 to 5 for +X, -X, +Y, -Y, +Z, -Z of cube n); empty: the only one. Other files have no layers: an error
    // (bad_option).
    std::string layer;

    // What integers become in read_image() and bake_file(). read_texture() always takes `unit`. By itself, a picture
    // without colours and vectors has the numbers that the file stores if they are quantities: TIFF with signed
    // samples, samples of 32 bits, a place on the Earth (GeoTIFF) or GDAL's scale and offset; EXR with uint; signed raw
    // heights; HGT and BIL.
    FileValues values = FileValues::automatic;

    // The layout of a file without a header, "[WxH,]TYPE[,SKIP]": TYPE is u8, or u16, s16 or f32 with le or be (u16le);
    // SKIP is a number of bytes before the first texel. Without an extent, the picture is square. Empty: files called
    // .r16 hold u16le, .r32 f32le, and .hgt, .bil, .bip, .bsq and .flt elevation models; all others have a header.
    std::string raw;

    // The bytes of the file, if they are in memory already, as those of an image in a model are. Nothing is opened
    // then: the path is the name of the file in messages. Null: the file is at the path.
    std::shared_ptr<const std::vector<std::byte>> bytes;

    // The reader program, started for each file. Empty: the program that was installed (libexec/libtex/tex-reader) or
    // built beside libtex. tex-reader-oiio is in the same folder.
    std::string reader;
    std::int64_t reader_memory = std::int64_t{4} << 30;  // bytes: its address space, with its result
    int reader_timeout = 120;                            // seconds of wall-clock time

    friend bool operator==(const ReadOptions&, const ReadOptions&) = default;
};

// Checks ReadOptions::raw. Errors: bad_option.
[[nodiscard]] Result<void> check_raw(const std::string& layout);

// Reads the base level of a picture with all its channels: raw values (see Image), unassociated alpha, top row first.
// PNG: 1 to 16 bits, grey, RGB, alpha, palette (expanded), transparency (as A), interlaced; colour chunks (gAMA, sRGB,
// iCCP, sBIT) change nothing. EXR: half, float and uint, scanline and tiled, mip-mapped, any channel names (R, G, B, A
// come first, the others by name), or those of one layer; the data window; the first part of a multi-part file. Deep
// data and subsampled channels are unsupported. TIFF and JPEG are turned as their orientation (EXIF) says; x and y of a
// normal in them stay as they are stored. `path` "-" reads standard input.
//
// Errors: io           cannot be opened or read; is a directory; the reader program cannot be started
//         bad_data     empty, truncated, damaged; not a picture at all
//         unsupported  valid, but of a type not handled; more texels than max_texels; a side above kMaxExtent
//         bad_option   there is no such layer (the reason lists those that there are)
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
