// SPDX-License-Identifier: Apache-2.0

#include "tiff_uneven.h"

#include <tiffio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "open_input.h"

namespace tex::reader {
namespace {

// The numbers of a file whose header libtiff has read, and nothing else.
class Numbers {
public:
    explicit Numbers(TIFF* tiff) : tiff_(tiff) {
        is_big_endian_ = TIFFIsBigEndian(tiff) != 0;
        is_big_ = at(2, 2) == 43;  // BigTIFF
    }

    // 0 beyond the end of the file.
    [[nodiscard]] std::uint64_t at(std::uint64_t offset, std::size_t bytes) const {
        unsigned char read[8] = {};
        if (TIFFGetSeekProc(tiff_)(TIFFClientdata(tiff_), offset, SEEK_SET) != offset ||
            TIFFGetReadProc(tiff_)(TIFFClientdata(tiff_), read, static_cast<tmsize_t>(bytes)) !=
                static_cast<tmsize_t>(bytes))
            return 0;
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < bytes; ++k) value = value << 8 | read[is_big_endian_ ? k : bytes - 1 - k];
        return value;
    }

    [[nodiscard]] bool is_big() const { return is_big_; }

private:
    TIFF* tiff_;
    bool is_big_endian_ = false, is_big_ = false;
};

// Whether an entry of the directory holds a list of 16-bit numbers that are not all the same.
bool is_uneven(const Numbers& file, std::uint64_t entry) {
    constexpr std::uint64_t kMost = 64;  // of more samples, the first ones
    const std::size_t wide = file.is_big() ? 8 : 4;
    if (file.at(entry + 2, 2) != TIFF_SHORT) return false;
    const std::uint64_t count = std::min(file.at(entry + 4, wide), kMost);
    const std::uint64_t inside = entry + 4 + wide;
    const std::uint64_t list = 2 * count <= wide ? inside : file.at(inside, wide);
    for (std::uint64_t k = 1; k < count; ++k) {
        if (file.at(list + 2 * k, 2) != file.at(list, 2)) return true;
    }
    return false;
}

struct Closer {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

}  // namespace

bool has_uneven_samples() {
    const std::unique_ptr<TIFF, Closer> tiff(open_tiff_input("rmh"));  // h: the header alone
    if (!tiff) return false;
    const Numbers file(tiff.get());
    const std::size_t wide = file.is_big() ? 8 : 4;
    const std::uint64_t directory = file.at(file.is_big() ? 8 : 4, wide);
    const std::uint64_t entries = file.at(directory, file.is_big() ? 8 : 2);
    const std::uint64_t first = directory + (file.is_big() ? 8 : 2);
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(entries, 65535); ++k) {
        const std::uint64_t entry = first + k * (4 + 2 * wide);
        const std::uint64_t tag = file.at(entry, 2);
        if ((tag == TIFFTAG_BITSPERSAMPLE || tag == TIFFTAG_SAMPLEFORMAT) && is_uneven(file, entry)) return true;
    }
    return false;
}

}  // namespace tex::reader
