// SPDX-License-Identifier: Apache-2.0
// exr_part.h: the header of the first part of an EXR file, which is checked before it is used.

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

// libtex's own attributes.
inline constexpr const char* kNormalEncoding = "normalEncoding";
inline constexpr const char* kNormalYAxis = "normalYAxis";

// An exception of OpenEXR, as bad_data.
Error exr_error(const std::string& path, const std::exception& thrown);

// The stream from which OpenEXR reads a file. It is buffered, because OpenEXR reads the header in single bytes.
// Precondition: the file's size is known.
class ExrStream final : public Imf::IStream {
public:
    explicit ExrStream(const InputFile& file);
    bool read(char data[], int count) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    // Where the last read() put its bytes, and where in the file they began.
    [[nodiscard]] std::span<const std::byte> last_read() const { return last_; }
    [[nodiscard]] std::uint64_t last_place() const { return last_place_; }

    // The system's error, if reading failed for another reason than the format.
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

// Walks the attributes of all headers, then goes back to the beginning. Without this check, OpenEXR would allocate as
// much memory as an attribute claims before it finds that the file does not hold it. Returns where the table of chunks
// begins, if the file has one part. Throws Iex::InputExc.
std::optional<std::uint64_t> check_attributes(ExrStream& stream);

struct ExrChannel {
    std::string name;
    Imf::PixelType type = Imf::HALF;
};

// The channels of a part, or of one of its layers: R, G, B, A first, then the others by name. Errors: bad_option (the
// part has no such layer).
Result<std::vector<ExrChannel>> channels_of(const Imf::Header& header, const std::string& layer = {});

std::vector<std::string> names_of(const std::vector<ExrChannel>& channels);

// The tiles of a part that is stored in tiles. A part stored in scan lines may have the attribute `tiles` too. It then
// means nothing, and OpenEXR does not check it: its sizes may be 0.
std::optional<Imf::TileDescription> tiles_of(const Imf::Header& header);

// Checks a part and returns its extent. Refuses unsupported parts and impossible claims before a pixel is read.
// Errors: unsupported (deep data, subsampled channels, too large), bad_data.
Result<Extent> check_header(const std::string& path, const Imf::Header& header, std::int64_t file_size,
                            const ReadOptions& options);

}  // namespace tex
