// SPDX-License-Identifier: Apache-2.0

#include "stream/gathering_writer.h"

#include <utility>

#include <tex/mip_chain.h>

#include "threads/guard.h"

namespace tex {

GatheringWriter::GatheringWriter(const OutputNames& names, Container container, StripPacking packing,
                                 const WriteOptions& options)
    : names_(names), container_(container), packing_(std::move(packing)), options_(options) {
    for (int k = 0; k < packing_.head.levels; ++k) {
        const Extent extent = level_extent(packing_.head.extent, k);
        levels_.push_back({extent, std::vector<std::byte>(level_bytes(packing_.head.format, extent))});
    }
}

Result<void> GatheringWriter::write(Strip& strip) {
    Level& level = levels_[static_cast<std::size_t>(strip.level)];
    const std::size_t before = level_bytes(packing_.head.format, {level.extent.width, strip.first});
    return guarded([&]() -> Result<void> {
        packing_.pack(strip, level.bytes.data() + before);
        return {};
    });
}

// One file after the other: those after one that fails do not appear.
Result<void> GatheringWriter::commit() {
    return guarded([&]() -> Result<void> {
        for (std::size_t k = 0; k < levels_.size(); ++k) {
            Texture texture;
            texture.format = packing_.head.format;
            texture.swizzle = packing_.head.swizzle;
            texture.swizzle_known = packing_.head.swizzle_known;
            texture.y_axis = packing_.head.y_axis;
            texture.y_known = packing_.head.y_known;
            texture.levels.push_back(std::move(levels_[k]));
            const std::string path = names_.of_level ? names_.of_level(static_cast<int>(k)) : names_.output;
            const Result<std::vector<std::byte>> file = encode_file(texture, container_, options_);
            if (!file) return file.error().of(path);
            if (Result<void> written = write_file(path, *file, options_); !written) return written;
            bytes_ += file->size();
        }
        return {};
    });
}

}  // namespace tex
