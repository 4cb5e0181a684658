// SPDX-License-Identifier: Apache-2.0
// reader_protocol.h: the protocol between libtex and its reader process.
//
// libtex starts one of
//
//     tex-reader       decode|encode|describe FORMAT MAX_TEXELS MEMORY SECONDS PARENT
//     tex-reader-oiio  decode|encode|describe FORMAT MAX_TEXELS MEMORY SECONDS PARENT
//     tex-mesh-reader  mesh EXTENSION MAX_TEXELS MEMORY SECONDS PARENT
//     tex-mesh-reader  draco - MAX_TEXELS MEMORY SECONDS PARENT
//
// for one file (FORMAT is a name of reader_rows.cpp, or exr/PART with the number of a part, EXTENSION of the mesh's
// file or -, MEMORY in bytes, PARENT the process id of the caller) with these descriptors and no others:
//
//     kResultDescriptor    a file in memory, empty, which nobody can shorten: ReaderHeader at 0, the data at
//                          kReaderDataOffset
//     kInputDescriptor     decode: the picture file
//                          encode: a file in memory, ReaderHeader at 0 (extent, channels, type), the texels at
//                          kReaderDataOffset
//                          mesh: the file, in memory
//                          draco: the request that mesh/gltf_draco.h describes, in memory
//                          describe: an empty file in memory; the answer is in `sandboxed`, `landlock` and, as the
//                          version of the decoders, `reason`
//     kProgressDescriptor  a socket: one byte for each strip of rows that is in place; it ends when the process is gone
//
// Texels are interleaved, in native byte order, with rows from the top without padding: row j is at kReaderDataOffset +
// j * row_bytes(). rows_done in the header grows as rows arrive, so that a consumer may follow. An encoded file,
// the GLB file that stands for a mesh, or the uncompressed file that stands for a part of an EXR file is `bytes` long.
//
// MEMORY limits the address space of the process. It reserves as much of that as its result is long, so that the limit
// holds for both together. MEMORY also limits the result, in case a process that was taken over reserves nothing.
//
// The process writes the header, with state `working`, when it is ready. A process that ends before that has not seen
// its input. It ends with status kNoRoom if even the header cannot be written.
//
// The reader is not trusted: everything that it hands over is checked as if it came from the file itself.

#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "formats/stored_samples.h"

namespace tex::inline v1 {

inline constexpr int kFirstDescriptor = 3;  // after the standard streams, which are /dev/null
inline constexpr int kResultDescriptor = 3;
inline constexpr int kInputDescriptor = 4;
inline constexpr int kProgressDescriptor = 5;
inline constexpr int kReaderArguments = 7;  // with the name of the program

inline constexpr std::uint32_t kReaderMagic = 0x37786574;  // "tex7": changes with the layout below
inline constexpr int kMaxReaderChannels = 64;
inline constexpr std::size_t kReaderDataOffset = 8192;

// Bits of ReaderHeader::sandboxed.
inline constexpr std::uint32_t kCallsFiltered = 1;
inline constexpr std::uint32_t kFilesRestricted = 2;

inline constexpr int kNoRoom = 3;

enum class ReaderState : std::uint32_t { working, done, refused };

enum class ReaderType : std::uint32_t { u8, s8, u16, s16, u32, s32, f16, f32 };

inline constexpr std::size_t reader_type_bytes(ReaderType type) {
    switch (type) {
        case ReaderType::u8:
        case ReaderType::s8: return 1;
        case ReaderType::u16:
        case ReaderType::s16:
        case ReaderType::f16: return 2;
        case ReaderType::u32:
        case ReaderType::s32:
        case ReaderType::f32: return 4;
    }
    return 0;
}

// Where a picture says which texels hold no data.
enum class ReaderMask : std::uint32_t {
    none,
    own,    // the last channel, which is no channel of the picture: all of its bits are 0 where there are no data
    alpha,  // the last channel, which is alpha, is 0 there
};

struct ReaderHeader {
    std::uint32_t magic = kReaderMagic;
    ReaderState state = ReaderState::working;
    std::uint32_t error = 0;      // an ErrorCode, if the state is `refused`
    std::uint32_t sandboxed = 0;  // what the kernel granted: kCallsFiltered, kFilesRestricted
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::int32_t channels = 0;
    ReaderType type = ReaderType::u8;
    std::uint32_t bits = 0;      // significant bits of a sample in the file
    std::uint32_t landlock = 0;  // the kernel's version of Landlock
    std::uint64_t rows_done = 0;
    std::uint64_t bytes = 0;  // of an encoded file
    std::uint32_t has_no_data = 0;
    std::uint32_t quality = 0;        // encode: of a JPEG, 1 to 100
    double no_data = 0;               // samples of this value hold no data, as the file says
    std::uint32_t orientation = 1;    // 1 to 8, as in TIFF and EXIF; the rows have been turned accordingly
    std::uint32_t is_multiplied = 0;  // colours by alpha, as the file says
    ReaderMask mask = ReaderMask::none;
    std::uint32_t has_alpha = 0;  // the last channel is alpha, as the file says
    // The strips or tiles of the file, and how many of them were never written. Their texels are no_data, or else 0.
    std::uint32_t chunks = 0, absent_chunks = 0, has_tiles = 0;
    StoredSamples stored;
    char reason[1024] = {};
    char description[1024] = {};  // of the picture: text, cut off at this length
    char names[kMaxReaderChannels][64] = {};
};

static_assert(std::is_trivially_copyable_v<ReaderHeader> && sizeof(ReaderHeader) <= kReaderDataOffset);

inline constexpr std::uint64_t row_bytes(const ReaderHeader& header) {
    return static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.channels) *
           reader_type_bytes(header.type);
}

}  // namespace tex::inline v1
