// SPDX-License-Identifier: Apache-2.0

#include "mesh/glb.h"

#include <cstdint>
#include <limits>

namespace tex::inline v1 {
namespace {

constexpr std::size_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

Error too_long_glb() { return {ErrorCode::unsupported, {}, "would have 4 GiB or more, which GLB files cannot have"}; }

// Chunks have a multiple of 4 bytes.
std::size_t padded(std::size_t bytes) { return bytes + (4 - bytes % 4) % 4; }

void put_word(std::vector<std::byte>& bytes, std::size_t word) {
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<std::byte>(word >> (8 * k) & 0xff));
}

void put_chunk(std::vector<std::byte>& bytes, std::size_t type, std::span<const std::byte> content, std::byte filler) {
    put_word(bytes, padded(content.size()));
    put_word(bytes, type);
    bytes.insert(bytes.end(), content.begin(), content.end());
    bytes.resize(padded(bytes.size()), filler);
}

}  // namespace

Result<std::vector<std::byte>> with_chunks(std::span<const std::byte> file, const GltfChunks& chunks, std::string json,
                                           const std::optional<std::vector<std::byte>>& binary) {
    const auto as_bytes = [&] { return std::as_bytes(std::span(json)); };
    if (file.size() < 4 || file[0] != std::byte{'g'})
        return std::vector<std::byte>(as_bytes().begin(), as_bytes().end());
    json.resize(json.find_last_not_of(' ') + 1);
    std::size_t rest = 20 + chunks.json.size();
    std::vector<std::byte> made(file.begin(), file.begin() + 8);
    put_word(made, 0);
    put_chunk(made, kJsonChunk, as_bytes(), std::byte{' '});
    if (binary) {
        put_chunk(made, kBinaryChunk, *binary, std::byte{0});
        rest += 8 + chunks.binary.size();
    }
    std::size_t total = 0;
    for (std::size_t k = 4; k-- > 0;) total = total << 8 | std::to_integer<std::size_t>(file[8 + k]);
    total = total - rest + made.size();
    if (total > kMostBytes) return too_long_glb();
    made.insert(made.end(), file.begin() + static_cast<std::ptrdiff_t>(rest), file.end());
    for (std::size_t k = 0; k < 4; ++k) made[8 + k] = static_cast<std::byte>(total >> (8 * k) & 0xff);
    return made;
}

Result<std::vector<std::byte>> glb_of(std::string json, const std::vector<std::byte>& binary) {
    json.resize(json.find_last_not_of(' ') + 1);
    const std::size_t total = 20 + padded(json.size()) + (binary.empty() ? std::size_t{0} : 8 + padded(binary.size()));
    if (total > kMostBytes) return too_long_glb();
    std::vector<std::byte> made;
    put_word(made, kGlbMagic);
    put_word(made, 2);
    put_word(made, total);
    put_chunk(made, kJsonChunk, std::as_bytes(std::span(json)), std::byte{' '});
    if (!binary.empty()) put_chunk(made, kBinaryChunk, binary, std::byte{0});
    return made;
}

}  // namespace tex::inline v1
