// SPDX-License-Identifier: Apache-2.0
// code_rows.h: rows of unsigned integers, the channels of a texel side by side, which come from known places of a file.

#pragma once

#include <string>
#include <vector>

#include "formats/row_source.h"

namespace tex::inline v1 {

class CodeRows : public RowSource {
public:
    [[nodiscard]] bool is_random() const override { return true; }
    void store(const std::byte* rows, int first, int end, Image& image) const override;

protected:
    // Codes of 1 to 8 bits take a byte, those of up to 16 bits two. The value of the largest code is 1.
    void describe_codes(Extent extent, std::vector<std::string> names, int bits);
};

}  // namespace tex::inline v1
