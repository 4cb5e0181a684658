// SPDX-License-Identifier: Apache-2.0
// exr_part.h: the headers of an EXR file, which are checked before they are used.

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

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

// libtex's own attributes.
inline constexpr const char* kNormalEncoding = "normalEncoding";
inline constexpr const char* kNormalYAxis = "normalYAxis";
inline constexpr const char* kHeightBumpiness = "heightBumpiness";  // of heights: Texture::bumpiness_x and y

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
    std::optional<Error> failure_;
};

// The headers of all parts. A file that is not in several parts has one.
class ExrHeaders {
public:
    // Throws std::bad_alloc. Errors: bad_data, io.
    static Result<ExrHeaders> read(const InputFile& file);

    [[nodiscard]] int count() const { return static_cast<int>(headers_.size()); }
    [[nodiscard]] const Imf::Header& operator[](int part) const { return headers_[static_cast<std::size_t>(part)]; }
    // Where the part's table of chunks begins.
    [[nodiscard]] std::uint64_t table(int part) const { return tables_[static_cast<std::size_t>(part)]; }

private:
    std::vector<Imf::Header> headers_;
    std::vector<std::uint64_t> tables_;
};

struct ExrChannel {
    std::string name;
    Imf::PixelType type = Imf::HALF;
};

// Bytes of a value: 2 or 4.
std::size_t value_bytes(Imf::PixelType type);

// The channels of a part: R, G, B, A first, then the others by name.
std::vector<ExrChannel> channels_of(const Imf::Header& header);

std::vector<std::string> names_of(const std::vector<ExrChannel>& channels);

// What is read of a file: some or all channels of a part.
struct ExrLayer {
    int part = 0;
    std::vector<ExrChannel> channels;
    std::string remark = {};  // if it is the first part, and others could hold normals, too
};

// The channels of the layer with this name, or, without a name, all of the first part. A part's name counts as the
// beginning of its layers' names. Errors: bad_option (there is no such layer, or several).
Result<ExrLayer> find_layer(const ExrHeaders& headers, const std::string& name);

// The tiles of a part that is stored in tiles. A part stored in scan lines may have the attribute `tiles` too. It then
// means nothing, and OpenEXR does not check it: its sizes may be 0.
std::optional<Imf::TileDescription> tiles_of(const Imf::Header& header);

// Checks a part and returns its extent. Refuses unsupported parts and impossible claims before a pixel is read.
// Errors: unsupported (deep data, subsampled channels, too large), bad_data.
Result<Extent> check_header(const std::string& path, const Imf::Header& header, std::int64_t file_size,
                            const ReadOptions& options);

}  // namespace tex::inline v1
