// SPDX-License-Identifier: Apache-2.0

#include "mesh/glb.h"

#include <limits>

namespace tex::inline v1 {
namespace {

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
    constexpr std::size_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
    const auto as_bytes = [&] { return std::as_bytes(std::span(json)); };
    if (file.size() < 4 || file[0] != std::byte{'g'})
        return std::vector<std::byte>(as_bytes().begin(), as_bytes().end());
    json.resize(json.find_last_not_of(' ') + 1);
    std::size_t rest = 20 + chunks.json.size();
    std::vector<std::byte> made(file.begin(), file.begin() + 8);
    put_word(made, 0);
    put_chunk(made, kJson, as_bytes(), std::byte{' '});
    if (binary) {
        put_chunk(made, kBinary, *binary, std::byte{0});
        rest += 8 + chunks.binary.size();
    }
    std::size_t total = 0;
    for (std::size_t k = 4; k-- > 0;) total = total << 8 | std::to_integer<std::size_t>(file[8 + k]);
    total = total - rest + made.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::unsupported, {}, "would have 4 GiB or more, which GLB files cannot have"};
    made.insert(made.end(), file.begin() + static_cast<std::ptrdiff_t>(rest), file.end());
    for (std::size_t k = 0; k < 4; ++k) made[8 + k] = static_cast<std::byte>(total >> (8 * k) & 0xff);
    return made;
}

}  // namespace tex::inline v1
