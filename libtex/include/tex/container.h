// SPDX-License-Identifier: Apache-2.0
// container.h: reads and writes textures as files: DDS, KTX2, and pictures.

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/execution.h>
#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// File types that libtex writes, by extension: .dds .ktx2 .astc .png .exr .tif .tiff .tga .bmp .jpg .jpeg .r16 .r32
enum class Container { dds, ktx2, astc, png, exr, tiff, tga, bmp, jpeg, r16, r32 };

inline constexpr Named<Container> kContainerNames[] = {
    {Container::dds, "dds", ".dds"}, {Container::ktx2, "ktx2", ".ktx2"}, {Container::astc, "astc", ".astc"},
    {Container::png, "png", ".png"}, {Container::exr, "exr", ".exr"},    {Container::tiff, "tiff", ".tif, .tiff"},
    {Container::tga, "tga", ".tga"}, {Container::bmp, "bmp", ".bmp"},    {Container::jpeg, "jpeg", ".jpg, .jpeg"},
    {Container::r16, "r16", ".r16"}, {Container::r32, "r32", ".r32"},
};

// The file type that the extension of `path` names (case does not matter); nullopt for any other extension.
[[nodiscard]] std::optional<Container> container_of(std::string_view path);

// What a container can hold. ktx2: every encoding, mip levels. dds: the same without EAC and ASTC. astc: ASTC, one
// level. exr: half, float, rgba16f, rgba32f; mip levels. png: rgb8, rgba8, rgb16, rgba16, ag8. tiff: those of exr and
// png. tga: rgb8, rgba8, ag8. bmp, jpeg: rgb8. (A picture holds one, three or four channels, so only dds and ktx2 can
// hold rg8 and rg16.)
[[nodiscard]] bool can_hold(Container container, Encoding encoding);
[[nodiscard]] bool can_hold(Container container, Format format);
[[nodiscard]] bool can_hold_levels(Container container);

// Whether WriteOptions::zstd compresses this container: ktx2.
[[nodiscard]] bool can_compress(Container container);

// Whether a container can hold BC formats. dds and ktx2 can: they are files for a GPU and hold all mip levels by
// default. The others hold one level by default.
[[nodiscard]] bool can_hold_blocks(Container container);

// The encoding if the user names none: dxt5nm in dds and ktx2, astc_4x4 in astc, rgb8 in png, tga, bmp, jpeg; rgb16 in
// tiff; half in exr.
[[nodiscard]] Encoding default_encoding(Container container);

enum class DdsHeader { legacy, dx10 };

inline constexpr Named<DdsHeader> kDdsHeaderNames[] = {
    {DdsHeader::legacy, "legacy", "FourCC and masks of Direct3D 9; DX10 where it has no form for the format"},
    {DdsHeader::dx10, "dx10", "DXGI formats; legacy for rgb8, which has none"},
};

inline constexpr int kHighestZstdLevel = 22;

struct WriteOptions {
    DdsHeader dds_header = DdsHeader::legacy;
    bool dds_mark = false;     // DDPF_NORMAL, and the swizzle code 'A2D5' for dxt5nm, as NVIDIA's tools write them
    int zstd = 0;              // KTX2: 1 (fast) to 22 (small) compresses each level with Zstandard; 0 does not
    int jpeg_quality = 95;     // JPEG: 1 (small) to 100 (exact), as libjpeg counts
    bool sync = true;          // fdatasync before the rename
    bool no_clobber = false;   // do not replace an existing file; report an error (io)
    bool follow_links = true;  // write the file that a symbolic link leads to; false replaces the link itself, and a
                               // FIFO or device that has the name
    ReadOptions reader;        // the reader process also encodes TIFF and JPEG
    // Called when a file is complete, before it takes its place at `path`. Until the call returns, its bytes can be
    // read from the file `complete`. If this returns an error, the old file stays, and the error is returned. Not
    // called for standard output, FIFOs and devices.
    std::function<Result<void>(const std::string& path, const std::string& complete)> before_replacing = {};
    // Called when a file has taken its place.
    std::function<void(const std::string& path)> replaced = {};
};

// The bytes of a file that holds `texture`. DDS and KTX2 hold all levels, and so does EXR if there is more than one;
// other pictures hold the base level. If a container lacks a format with three channels, the format is widened with
// A = 1 (rgb16, half and float in DDS and KTX2). The bytes contain no time, host or path: equal textures give equal
// files.
//
// If it is known what the channels hold (swizzle_known), the file states it: layout_name() of the swizzle, and "+y" or
// "-y" if y is known, for example "dxt5nm +y". DDS holds the text in its reserved words 3 to 6, after 'LTEX'; KTX2
// under the key "libtex.normal"; PNG in a tEXt chunk with that keyword; TIFF, TGA and JPEG in their description. EXR
// has the attributes normalEncoding = "signed" and, if y is known, normalYAxis = "up" or "down". read_texture()
// believes them.
//
// Errors: unsupported  the container cannot hold the format (the reason says what it can hold), or zstd
//         bad_option   zstd is not from 0 to 22, or jpeg_quality not from 1 to 100
//         io           the reader process cannot be started
//         bad_data     the reader process crashed or did not end in time
//         out_of_memory, cancelled
// PNG and EXR are compressed on all threads. The same bytes for every number of threads.
[[nodiscard]] Result<std::vector<std::byte>> encode_file(const Texture& texture, Container container,
                                                         const WriteOptions& options = {},
                                                         const Execution& execution = {});

// Calls encode_file() with the container that the extension of `path` names, then write_file(). Errors: bad_option (the
// extension belongs to no container), and those of both functions.
[[nodiscard]] Result<void> write_texture(const std::string& path, const Texture& texture,
                                         const WriteOptions& options = {}, const Execution& execution = {});

// Writes `bytes` to `path`. Whatever happens during the call, the path holds either its complete old content or its
// complete new content. The bytes go to a nameless temporary file (O_TMPFILE) in the same directory, followed by
// fdatasync, link and rename. A symbolic link is followed and stays a link, unless options.follow_links is false. The
// mode of an existing file is kept, as far as this user may. Standard output ("-"), FIFOs and devices are written
// directly.
//
// Errors: io             the directory does not exist or is not writable; the disk is full; the path is a directory; or
//                        another failure of the file system
//         those of options.before_replacing
//         out_of_memory  memory or file descriptors ran out
//         cancelled      the process caught a signal, without SA_RESTART, while a FIFO waited for its reader
[[nodiscard]] Result<void> write_file(const std::string& path, const std::vector<std::byte>& bytes,
                                      const WriteOptions& options = {});

// For the handler of a signal that ends the process at once: removes the temporary names of files that are still being
// written. (Only some file systems need such names from the beginning, see write_file(). Without this call such a file
// stays until the target is written again.) Safe to call in signal handlers. After this call no file can be started or
// get its name: a thread that tries waits forever, and so does a second call. The call leaves all signals blocked in
// this thread. The process must end right after it.
void remove_unfinished_files() noexcept;

// Reads a texture with all its levels.
//
// DDS: legacy and DX10 headers; BC1 to BC7 (DXT1 to DXT5, ATI1, ATI2, BC4U, BC4S, BC5U, BC5S, RXGB), the swizzle codes
// that ATI's and NVIDIA's tools leave in dwRGBBitCount (xGxR, A2XY, A2D5, RxBG ...), uncompressed formats by masks (8,
// 16, 24 and 32 bits) and by FourCC (36, 110 to 116), the DXGI formats of Format in their unorm, snorm, float, typeless
// and sRGB forms. Missing header flags are accepted. Texture::remarks lists the faults that the reader ignored. KTX2:
// the VkFormats of Format, also with levels compressed by Zstandard or ZLIB. BasisLZ and UASTC are unsupported. KTX 1:
// the formats of Format in OpenGL's numbers. Of arrays and cube maps, ReadOptions::layer is read; volumes are
// unsupported.
// ATI2 without a swizzle code holds y first (3Dc, ATI 2005); with 'A2XY' x is first.
// EXR: all levels of a mip-mapped file; the base level only if the extents of the levels are rounded up. Anything else
// is read as a picture: one level.
//
// Every size computed from a header is checked against the file's length before memory is allocated. Errors: as
// read_image().
[[nodiscard]] Result<Texture> read_texture(const std::string& path, const ReadOptions& options = {});

// The same for a DDS or KTX2 file that is in memory. Error messages call it `name`.
[[nodiscard]] Result<Texture> decode_file(const std::byte* data, std::size_t size, const std::string& name,
                                          const ReadOptions& options = {});

}  // namespace tex
#pragma GCC visibility pop
