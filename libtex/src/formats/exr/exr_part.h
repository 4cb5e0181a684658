// SPDX-License-Identifier: Apache-2.0
// exr_part.h: the first part of an EXR file, as its header tells: checked before it is believed.

#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfPixelType.h>
#include <ImfTileDescription.h>

#include <tex/image.h>
#include <tex/image_io.h>
#include <tex/result.h>

#include "files/input_file.h"

namespace tex {

// Attributes of ours.
inline constexpr const char* kNormalEncoding = "normalEncoding";
inline constexpr const char* kNormalYAxis = "normalYAxis";

// What OpenEXR threw, as bad_data.
Error exr_error(const std::string& path, const std::exception& thrown);

// A file as OpenEXR reads it. OpenEXR asks for single bytes of the header: a buffer stands between. Precondition: the
// file's size is known.
class ExrStream final : public Imf::IStream {
public:
    explicit ExrStream(const InputFile& file);
    bool read(char data[], int count) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    // Where the last read() put its bytes, and where in the file it began.
    [[nodiscard]] std::span<const std::byte> last_read() const { return last_; }
    [[nodiscard]] std::uint64_t last_place() const { return last_place_; }

    // What the system said, where it was not the format that failed.
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

private:
    void fetch(std::byte* to, std::uint64_t at, std::size_t n);

    const InputFile& file_;
    const std::uint64_t size_;
    std::uint64_t at_ = 0;
    std::vector<std::byte> buffer_;
    std::uint64_t buffered_from_ = 0;
    std::size_t buffered_ = 0;
    std::span<const std::byte> last_;
    std::uint64_t last_place_ = 0;
    std::optional<Error> failure_;
};

// Walks the attributes of all headers, then goes back to the beginning: OpenEXR takes whatever memory an attribute
// claims, before it finds that the file does not hold it. Returns where the table of chunks begins, in a file of one
// part. Throws Iex::InputExc.
std::optional<std::uint64_t> check_attributes(ExrStream& stream);

struct ExrChannel {
    std::string name;
    Imf::PixelType type = Imf::HALF;
};

// The channels of a part: R, G, B, A first, then the others by name, as the header lists them.
std::vector<ExrChannel> channels_of(const Imf::Header& header);

// The tiles of a part that is stored in tiles. A part stored in scan lines may carry the attribute `tiles` too, which
// then means nothing (and is not checked by OpenEXR: its sizes may be 0).
std::optional<Imf::TileDescription> tiles_of(const Imf::Header& header);

// The extent of a part. Refuses, before a pixel is read, what is not handled and what cannot be true. Errors:
// unsupported (deep data, subsampled channels, too large), bad_data.
Result<Extent> check_header(const std::string& path, const Imf::Header& header, std::int64_t file_size,
                            const ReadOptions& options);

}  // namespace tex
