// SPDX-License-Identifier: Apache-2.0
// file.h: files are read, probed and written.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- image io ------------------------------------------------------------------------------------------------------
//
// Reads pictures from files.
//
// The first bytes of a file, not its name, decide how it is read. PNG and EXR are decoded in this process, by libpng
// and OpenEXR; DDS, KTX, TGA, BMP and ESRI ASCII grids by libtex. TIFF is decoded by libtiff, JPEG by libjpeg-turbo,
// WebP by libwebp, everything else (HDR, PSD ...) by OpenImageIO (tex-reader-oiio), in a separate process for each
// file, under limits of memory and time. If such a decoder crashes or hangs, the result is an Error.

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
[[nodiscard]] TEX_API Result<void> check_raw(const std::string& layout);

// Reads the base level of a picture with all its channels: raw values (see Image), unassociated alpha, top row first.
// PNG: 1 to 16 bits, grey, RGB, alpha, palette (expanded), transparency (as A), interlaced; colour chunks (gAMA, sRGB,
// iCCP, sBIT) change nothing. EXR: half, float and uint, scanline and tiled, mip-mapped, any channel names (R, G, B, A
// come first, the others by name), or those of one layer; the data window; the first part of a multi-part file. Deep
// data and subsampled channels are unsupported. TIFF and JPEG are turned as their orientation (EXIF) says, PNG is not;
// x and y of a normal in them stay as they are stored. `path` "-" reads standard input.
//
// Errors: io           cannot be opened or read; is a directory; the reader program cannot be started
//         bad_data     empty, truncated, damaged; not a picture at all
//         unsupported  valid, but of a type not handled; more texels than max_texels; a side above kMaxExtent
//         bad_option   there is no such layer (the reason lists those that there are)
//         out_of_memory
// No file content makes this function crash or hang beyond reader_timeout. The memory that it uses stays in proportion
// to the smaller of two sizes: the size that the file claims and the size that its bytes can hold.
[[nodiscard]] TEX_API Result<Image> read_image(const std::string& path, const ReadOptions& options = {});

// Reads the bytes of a file in memory, which messages call `name`.
[[nodiscard]] TEX_API Result<Image> read_image(std::span<const std::byte> bytes, const std::string& name,
                                               const ReadOptions& options = {});

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
[[nodiscard]] TEX_API Result<ReaderInfo> reader_info(const ReadOptions& options = {});

// -- probe ---------------------------------------------------------------------------------------------------------
//
// What the first bytes of a picture or texture state, without decoding it.

// The extent of the base level of a PNG, EXR, DDS or KTX2 file.
//
// Errors: unsupported  any other type: only the reader process knows its extent, and none is started
//         others       those of read_image() that the header reveals
[[nodiscard]] TEX_API Result<Extent> probe(const std::string& path, const ReadOptions& options = {});

// -- container -----------------------------------------------------------------------------------------------------
//
// Reads and writes textures as files: DDS, KTX2, and pictures.

// File types that libtex writes, by extension: .dds .ktx2 .astc .png .exr .tif .tiff .tga .bmp .jpg .jpeg .r16
// .r32 .webp
enum class Container { dds, ktx2, astc, png, exr, tiff, tga, bmp, jpeg, r16, r32, webp };

inline constexpr Named<Container> kContainerNames[] = {
    {Container::dds, "dds", ".dds"}, {Container::ktx2, "ktx2", ".ktx2"}, {Container::astc, "astc", ".astc"},
    {Container::png, "png", ".png"}, {Container::exr, "exr", ".exr"},    {Container::tiff, "tiff", ".tif, .tiff"},
    {Container::tga, "tga", ".tga"}, {Container::bmp, "bmp", ".bmp"},    {Container::jpeg, "jpeg", ".jpg, .jpeg"},
    {Container::r16, "r16", ".r16"}, {Container::r32, "r32", ".r32"},    {Container::webp, "webp", ".webp"},
};

// The file type that the extension of `path` names (case does not matter); nullopt for any other extension.
[[nodiscard]] TEX_API std::optional<Container> container_of(std::string_view path);

// What a container can hold. ktx2: every encoding, mip levels. dds: the same without EAC, ASTC and UASTC. astc: ASTC,
// one level. exr: half, float, rgba16f, rgba32f; mip levels. png: rgb8, rgba8, rgb16, rgba16, ag8. tiff: those of exr
// and png. tga, webp: rgb8, rgba8, ag8. bmp, jpeg: rgb8. (A picture holds one, three or four channels, so only dds and
// ktx2 can hold rg8 and rg16.)
[[nodiscard]] TEX_API bool can_hold(Container container, Encoding encoding);
[[nodiscard]] TEX_API bool can_hold(Container container, Format format);
[[nodiscard]] TEX_API bool can_hold_levels(Container container);

// Whether WriteOptions::zstd compresses this container: ktx2.
[[nodiscard]] TEX_API bool can_compress(Container container);

// Whether a container can hold BC formats. dds and ktx2 can: they are files for a GPU and hold all mip levels by
// default. The others hold one level by default.
[[nodiscard]] TEX_API bool can_hold_blocks(Container container);

// The encoding if the user names none: dxt5nm in dds and ktx2, astc_4x4 in astc, rgb8 in png, tga, bmp, jpeg, webp;
// rgb16 in tiff; half in exr.
[[nodiscard]] TEX_API Encoding default_encoding(Container container);

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
    ReadOptions reader;        // the reader process also encodes TIFF, JPEG and WebP
    // Called when a file is complete, before it takes its place at `path`. Until the call returns, its bytes can be
    // read from the file `complete`. If this returns an error, the old file stays, and the error is returned. Not
    // called for standard output, FIFOs and devices.
    std::function<Result<void>(const std::string& path, const std::string& complete)> before_replacing = {};
    // Called when a file has taken its place.
    std::function<void(const std::string& path)> replaced = {};
    // If set, the bytes of the file go here, and nothing is written: the path is the name of the file in messages. The
    // output must be one file; neither function above is called.
    std::shared_ptr<std::vector<std::byte>> into = {};
};

// Whether every option is in its range. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const WriteOptions& options);

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
//         bad_option   as validate(options); the texture has no level, or one
//                      without the extent of level_extent() or level_bytes() bytes
//         io           the reader process cannot be started
//         bad_data     the reader process crashed or did not end in time
//         out_of_memory, cancelled
// PNG and EXR are compressed on all threads, and call Execution::progress from row to row; the others call it once, at
// the start. The same bytes for every number of threads.
[[nodiscard]] TEX_API Result<std::vector<std::byte>> encode_file(const Texture& texture, Container container,
                                                                 const WriteOptions& options = {},
                                                                 const Execution& execution = {});

// Calls encode_file() with the container that the extension of `path` names, then write_file(). Errors: bad_option (the
// extension belongs to no container), and those of both functions.
[[nodiscard]] TEX_API Result<void> write_texture(const std::string& path, const Texture& texture,
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
[[nodiscard]] TEX_API Result<void> write_file(const std::string& path, const std::vector<std::byte>& bytes,
                                              const WriteOptions& options = {});

// For the handler of a signal that ends the process at once: removes the temporary names of files that are still being
// written. (Only some file systems need such names from the beginning, see write_file(). Without this call such a file
// stays until the target is written again.) Safe to call in signal handlers. After this call no file can be started or
// get its name: a thread that tries waits forever, and so does a second call. The call leaves all signals blocked in
// this thread. The process must end right after it.
TEX_API void remove_unfinished_files() noexcept;

// Reads a texture with all its levels.
//
// DDS: legacy and DX10 headers; BC1 to BC7 (DXT1 to DXT5, ATI1, ATI2, BC4U, BC4S, BC5U, BC5S, RXGB), the swizzle codes
// that ATI's and NVIDIA's tools leave in dwRGBBitCount (xGxR, A2XY, A2D5, RxBG ...), uncompressed formats by masks (8,
// 16, 24 and 32 bits) and by FourCC (36, 110 to 116), the DXGI formats of Format in their unorm, snorm, float, typeless
// and sRGB forms. Missing header flags are accepted. Texture::remarks lists the faults that the reader ignored. KTX2:
// the VkFormats of Format, also with levels compressed by Zstandard or ZLIB; UASTC of low dynamic range, and ETC1S with
// BasisLZ (without frames that follow others: animations are unsupported). Data format descriptors that contradict the
// VkFormat are bad_data. KTX 1: the formats of Format in OpenGL's numbers. Of arrays and cube maps, ReadOptions::layer
// is read; volumes are unsupported. ATI2 with the code 'A2XY' holds x first, and so it does if the signature of GIMP or
// of NVIDIA's texture tools is in the header. Without either, the file leaves the order open (Texture::order_open): 3Dc
// has y first (ATI 2005), nearly all other writers x. EXR: all levels of a mip-mapped file; the base level only if the
// extents of the levels are rounded up. Anything else is read as a picture: one level.
//
// Every size computed from a header is checked against the file's length before memory is allocated. Errors: as
// read_image().
[[nodiscard]] TEX_API Result<Texture> read_texture(const std::string& path, const ReadOptions& options = {});

// Reads the bytes of a file in memory, which messages call `name`.
[[nodiscard]] TEX_API Result<Texture> read_texture(std::span<const std::byte> bytes, const std::string& name,
                                                   const ReadOptions& options = {});

// -- source --------------------------------------------------------------------------------------------------------
//
// Normals from files. The layout comes from the caller, from the file, or from the texels.

struct SourceOptions {
    ReadOptions read;

    // Options of unpack(). Without a swizzle the file's own is used, or guess_swizzle() if the file has none.
    UnpackOptions unpack;

    std::optional<Swizzle> bc5_swizzle;  // of BC5 files, instead of their own; unpack.swizzle takes precedence
    bool r_or_a = false;           // y is in G, and x in A if guess_swizzle() finds it there, else in R; unpack.swizzle
                                   // takes precedence
    bool doubt_y = false;          // if the file does not state y, measure it: SourceInfo::y_doubtful
    bool inspect = false;          // look for signs that the texels hold something else: object_space, background,
                                   // others
    bool drop_others = false;      // channels that hold no part of the normals are not carried along: see SourceInfo
    bool fill_background = false;  // black, grey or white around charts takes the nearest normals; smaller levels are
                                   // left out, and the base level is held in memory
    bool measure_y = false;     // the texels of the base level decide about y, whatever the file or unpack.y_axis state
    bool file_y_first = false;  // the direction that a file states takes precedence over unpack.y_axis
    std::optional<YAxis> y_otherwise;  // what y is if it is to be measured, and does not show clearly; none: an error

    friend bool operator==(const SourceOptions&, const SourceOptions&) = default;
};

// A channel of a file that holds other data beside the normals: heights, gloss, a mask.
struct ExtraChannel {
    char name = 'A';                      // R, G, B, A, or L: the lengths of vectors
    float least = 0.0f, greatest = 0.0f;  // as decode() gives its values

    // Whether it is one of these: its name is the first letter of theirs.
    [[nodiscard]] constexpr bool is_in(const ExtraSet& extras) const {
        for (const Named<Extra>& row : kExtraNames) {
            if (name == row.name[0] - 'a' + 'A') return extras[row.value];
        }
        return false;
    }
    friend bool operator==(const ExtraChannel&, const ExtraChannel&) = default;
};

// What a file holds.
struct SourceInfo {
    Format format = Format::rgba8_unorm;
    Swizzle swizzle = {};      // with which it was read
    bool guessed = false;      // the swizzle comes from the texels, and is not merely rgb in a file that looks like rgb
    YAxis y_axis = YAxis::up;  // with which it was read: the direction of y in the file
    bool order_assumed = false;   // neither the file nor its texels say whether x or y is first: it was taken to be x
    bool y_known = false;         // y_axis comes from the file, the caller or the texels; otherwise it is assumed
    bool y_doubtful = false;      // it is assumed, or the caller states it, and the texels clearly show the other one
    bool object_space = false;    // more than 5 % of the texels that were inspected point away from the surface
    bool z01 = false;             // z was read as ValueRange::z01, which the texels show
    bool z_doubtful = false;      // z is stored, but does not follow x and y: other data may be in its place
    std::int64_t not_finite = 0;  // texels of the base level with a component that is NaN or infinite; they become flat
    double background = 0.0;      // the share of those that are black, grey or white, if it is 1 % or more
    // Channels of the base level, whose values differ by more than 1.5 of 255 and repeat none of x, y and z. After
    // pack_file() and blend_file(): those of them that are not in every output. Encodings with four channels take alpha
    // along (can_hold()).
    std::vector<ExtraChannel> others;
    bool srgb = false;  // this and remarks: as in Texture
    std::vector<std::string> remarks;
};

struct Source {
    MipChain chain;  // y up, as always
    SourceInfo info;
};

// Reads the normals in a file by read_texture(), guess_swizzle() if it is needed, and unpack(). With `base_only` the
// smaller levels are left out.
//
// Errors, all of which name the file: those of the three functions; unsupported if there is only one channel; bad_data
// if y is to be measured and the texels do not show it clearly, or if red, blue and alpha are 1 everywhere and green
// varies: DXT5nm without the alpha that held x.
[[nodiscard]] TEX_API Result<Source> read_normals(const std::string& path, const SourceOptions& options = {},
                                                  bool base_only = false, const Execution& execution = {});

}  // namespace tex::inline v1
