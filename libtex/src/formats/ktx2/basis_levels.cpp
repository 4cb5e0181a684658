// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_levels.h"

#include <utility>
#include <vector>

#include <tex/format.h>

namespace tex::inline v1 {
namespace {

bool is_within(const ClaimedBytes& range, std::uint64_t size) {
    return range.begin <= size && range.count <= size - range.begin;
}

}  // namespace

Result<std::shared_ptr<const BasisCodebooks>> read_basis_global(const FetchBytes& fetch, std::size_t size,
                                                                const ClaimedBytes& global, std::uint64_t images) {
    if (!is_within(global, size)) return damaged_basis("the global data end beyond the end of the file");
    if (global.count < kBasisHeaderBytes || (global.count - kBasisHeaderBytes) / kBasisImageBytes < images)
        return damaged_basis("the global data end too early");
    const std::uint64_t before = kBasisHeaderBytes + images * kBasisImageBytes;
    const Result<std::vector<std::byte>> head = fetch(global.begin, kBasisHeaderBytes);
    if (!head) return head.error();
    const Result<std::vector<std::byte>> rest =
        fetch(global.begin + before, static_cast<std::size_t>(global.count - before));
    if (!rest) return rest.error();
    Result<BasisCodebooks> books = read_basis_codebooks(*head, *rest);
    if (!books) return books.error();
    return std::shared_ptr<const BasisCodebooks>(std::make_shared<BasisCodebooks>(std::move(*books)));
}

Result<StoredTexture::Level> basis_level(const FetchBytes& fetch, std::size_t size, const ClaimedBytes& global,
                                         std::uint64_t image, const ClaimedBytes& level, Extent extent, Format format) {
    if (!is_within(level, size)) return damaged_basis("a level ends beyond the end of the file");
    const Result<std::vector<std::byte>> bytes =
        fetch(global.begin + kBasisHeaderBytes + image * kBasisImageBytes, kBasisImageBytes);
    if (!bytes) return bytes.error();
    const BasisImage slices = read_basis_image(bytes->data());
    if (slices.follows_another)
        return Error{ErrorCode::unsupported, {}, "animations whose frames follow others are not supported"};
    const bool has_alpha = format == Format::etc1s_rgba_unorm;
    const ClaimedBytes color = {slices.color_offset, slices.color_bytes},
                       alpha = {slices.alpha_offset, slices.alpha_bytes};
    if (color.count == 0 || (has_alpha && alpha.count == 0)) return damaged_basis("a slice is empty");
    if (!is_within(color, level.count) || (has_alpha && !is_within(alpha, level.count)))
        return damaged_basis("a slice ends beyond the end of its level");
    StoredTexture::Level place{extent, level.begin + color.begin, color.count, level_bytes(format, extent), 0};
    if (has_alpha) {
        place.alpha_offset = level.begin + alpha.begin;
        place.alpha_bytes = alpha.count;
    }
    return place;
}

}  // namespace tex::inline v1
