// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_inflater.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "blocks/etc1s.h"
#include "blocks/extent.h"
#include "formats/ktx2/basis_slice.h"

namespace tex::inline v1 {
namespace {

class BasisInflater final : public LevelInflater {
public:
    BasisInflater(const StoredTexture& texture, FetchBytes fetch, const StoredTexture::Level& place)
        : LevelInflater(std::move(fetch), place, place.inflated), books_(texture.codebooks),
          block_bytes_(format_info(texture.head.format).block_bytes), across_(blocks_across(place.extent.width)),
          down_(blocks_across(place.extent.height)), row_(static_cast<std::size_t>(across_) * block_bytes_),
          given_(row_.size()) {
        halves_.push_back({0, place.bytes, {}, {}});
        if (block_bytes_ > kEtc1sBlockBytes)
            halves_.push_back({place.alpha_offset - place.offset, place.alpha_bytes, {}, {}});
    }

protected:
    void restart() override {
        given_ = row_.size();
        for (Half& half : halves_) half.slice.reset();
    }
    Result<void> next(std::span<std::byte> bytes) override;
    Result<void> end() override { return {}; }  // a slice may be padded

private:
    // A slice, which decodes one half of each block.
    struct Half {
        std::uint64_t offset, count;  // from the start of the colours
        std::vector<std::byte> bytes;
        std::optional<BasisSlice> slice;
    };

    Result<void> next_row();

    const std::shared_ptr<const BasisCodebooks> books_;
    const std::size_t block_bytes_;
    const int across_, down_;
    std::vector<Half> halves_;
    std::vector<std::byte> row_;  // of blocks
    std::size_t given_;           // bytes of it
};

Result<void> BasisInflater::next_row() {
    for (std::size_t k = 0; k < halves_.size(); ++k) {
        Half& half = halves_[k];
        if (half.bytes.empty()) {
            Result<std::vector<std::byte>> bytes = fetch(half.offset, static_cast<std::size_t>(half.count));
            if (!bytes) return bytes.error();
            half.bytes = std::move(*bytes);
        }
        if (!half.slice) half.slice.emplace(*books_, half.bytes, across_, down_);
        const Result<void> done = half.slice->next_row(row_.data() + k * kEtc1sBlockBytes, block_bytes_);
        if (!done) return done;
    }
    given_ = 0;
    return {};
}

Result<void> BasisInflater::next(std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        if (given_ == row_.size()) {
            if (Result<void> made = next_row(); !made) return made;
        }
        const std::size_t count = std::min(bytes.size(), row_.size() - given_);
        std::copy_n(row_.begin() + static_cast<std::ptrdiff_t>(given_), count, bytes.begin());
        given_ += count;
        bytes = bytes.subspan(count);
    }
    return {};
}

}  // namespace

std::unique_ptr<LevelInflater> make_basis_inflater(const StoredTexture& texture, FetchBytes fetch,
                                                   const StoredTexture::Level& place) {
    return std::make_unique<BasisInflater>(texture, std::move(fetch), place);
}

}  // namespace tex::inline v1
