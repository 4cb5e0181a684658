// SPDX-License-Identifier: Apache-2.0

#include "formats/row_target.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tex {

Result<std::vector<std::byte>> encode_rows(OpenTarget open, const Texture& texture, bool all_levels) {
    if (texture.levels.empty()) return Error{ErrorCode::unsupported, {}, "a texture without levels"};
    std::vector<std::byte> file;
    const WriteBytes write = [&file](std::uint64_t offset, std::span<const std::byte> bytes) -> Result<void> {
        const auto at = static_cast<std::size_t>(offset);
        file.resize(std::max(file.size(), at + bytes.size()));
        std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(at));
        return {};
    };
    const Result<std::unique_ptr<RowTarget>> target = open(head_of(texture), write);
    if (!target) return target.error();
    const std::size_t levels = all_levels ? texture.levels.size() : 1;
    for (std::size_t k = 0; k < levels; ++k) {
        const Level& level = texture.levels[k];
        if (const Result<void> put = (*target)->put(static_cast<int>(k), level.bytes.data(), level.extent.height); !put)
            return put.error();
    }
    if (const Result<void> done = (*target)->finish(); !done) return done.error();
    return file;
}

}  // namespace tex
