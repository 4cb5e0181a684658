// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_input.h"

#include <algorithm>
#include <cstring>

#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;

}  // namespace

PngInput::PngInput(InputFile& file) : file_(file), buffer_(new std::uint8_t[kBuffer]) {}

bool PngInput::fill() {
    begin_ = 0;
    end_ = 0;
    const Result<std::size_t> got =
        no_throw([&] { return file_.read(reinterpret_cast<std::byte*>(buffer_.get()), kBuffer); });
    if (!got) error_ = got.error();
    if (!got || *got == 0) return false;
    end_ = *got;
    return true;
}

bool PngInput::take(std::uint8_t* to, std::size_t count) {
    while (count > 0) {
        const std::span<const std::uint8_t> bytes = some(count);
        if (bytes.empty()) return false;
        std::memcpy(to, bytes.data(), bytes.size());
        to += bytes.size();
        count -= bytes.size();
    }
    return true;
}

std::span<const std::uint8_t> PngInput::some(std::size_t most) {
    if (begin_ == end_ && !fill()) return {};
    const std::span<const std::uint8_t> bytes(buffer_.get() + begin_, std::min(most, end_ - begin_));
    begin_ += bytes.size();
    return bytes;
}

}  // namespace tex::inline v1
