// SPDX-License-Identifier: Apache-2.0
// png_texels.h: inflates what the IDAT chunks of a PNG hold, faster than libpng and zlib do.
//
// This knows plain files only: every check value is right, and nothing is missing, superfluous or out of place. It
// refuses all others without saying why. libpng has the last word on those: it tolerates some, and names the fault of
// the rest. So both accept the same files, with one exception: a Huffman code with unused bit patterns (RFC 1951,
// section 3.2.7, does not allow for them; no encoder makes them) is accepted here if none of these patterns occurs.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <tex/types.h>

#include "formats/png/png_input.h"

struct inflate_state;

namespace tex::inline v1 {

// The name and the version of the library that inflates.
std::string png_inflater_version();

class PngTexels {
public:
    // Begins after the header of the first IDAT chunk, which has `length` bytes. All IDAT chunks together inflate to
    // `decoded` bytes. Throws std::bad_alloc. The input must outlive this object.
    PngTexels(PngInput& input, std::uint32_t length, double decoded);
    ~PngTexels();
    PngTexels(const PngTexels&) = delete;
    PngTexels& operator=(const PngTexels&) = delete;

    // Inflates the next `count` bytes, less than 2^32. False if the file is not plain. Errors: io.
    [[nodiscard]] Result<bool> read(std::uint8_t* to, std::size_t count);
    // Checks what follows the last byte, up to the end chunk. False if the file is not plain. Errors: io.
    [[nodiscard]] Result<bool> finish();

private:
    [[nodiscard]] bool inflate_all(std::uint8_t* to, std::size_t count);
    [[nodiscard]] bool inflate_end();
    [[nodiscard]] bool begin_stream();
    [[nodiscard]] bool feed();
    [[nodiscard]] bool begin_chunk();
    [[nodiscard]] bool end_chunk();
    [[nodiscard]] bool skip_to_end();
    [[nodiscard]] Result<bool> outcome(bool plain) const;

    PngInput& input_;
    const std::unique_ptr<inflate_state> stream_;
    const double decoded_;
    bool begun_ = false;
    std::uint8_t type_[4] = {'I', 'D', 'A', 'T'};  // of the chunk
    std::uint32_t left_;                           // of the bytes of the chunk
    std::uint32_t crc_;
};

}  // namespace tex::inline v1
