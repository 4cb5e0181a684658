// SPDX-License-Identifier: Apache-2.0
// read_descriptor.h: what the data format descriptor of a KTX2 file says, beside its VkFormat (KTX 2.0, 3.10).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/stored_texture.h"

namespace tex::inline v1 {

// The basic block of a descriptor (Khronos Data Format Specification 1.3, section 5).
struct Ktx2Descriptor {
    std::uint32_t model = 0;                               // khr_df_model_e; 0: not stated
    std::uint32_t transfer = 0;                            // khr_df_transfer_e; 0: not stated
    std::array<int, 4> edges = {1, 1, 1, 1};               // of a texel block
    std::uint32_t block_bytes = 0;                         // 0: not stated, as by files with supercompression
    std::array<std::optional<std::uint32_t>, 2> channels;  // of the first samples, without their qualifiers

    [[nodiscard]] bool states_srgb() const { return transfer == 2; }
    [[nodiscard]] bool states_linear() const { return transfer == 1; }
};

// Reads the descriptor, of `bytes` bytes at `offset`. Without one, or if it is damaged, the result is empty and a
// remark says so. Errors: those of `fetch`.
[[nodiscard]] Result<std::optional<Ktx2Descriptor>> read_descriptor(const FetchBytes& fetch, std::size_t size,
                                                                    std::uint32_t offset, std::uint32_t bytes,
                                                                    std::vector<std::string>& remarks);

// Checks that the descriptor describes texels or blocks like those of the format, which the file's VkFormat `vk`
// stands for. What it leaves open, and the bits, the transfer function and the primaries, are not compared: some
// writers get them wrong. Errors: bad_data, without the name of the file.
[[nodiscard]] Result<void> check_descriptor(const Ktx2Descriptor& descriptor, std::uint32_t vk, Format format);

// What a khr_df_model_e is called.
[[nodiscard]] std::string khr_model_text(std::uint32_t model);

}  // namespace tex::inline v1
