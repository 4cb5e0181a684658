// SPDX-License-Identifier: Apache-2.0

#include "formats/byte_range.h"

#include <cstring>

namespace tex::inline v1 {

// Keeps what has not been given and reads on.
bool ByteRange::fill(std::size_t count) {
    constexpr std::int64_t kPiece = std::int64_t{1} << 16;
    const std::size_t kept = held_ - given_;
    const std::int64_t left = std::min(kPiece, end_ - next_);
    if (static_cast<std::int64_t>(count - kept) > left) return false;
    const auto wanted = static_cast<std::size_t>(left);
    if (piece_.size() < kept + wanted) piece_.resize(kept + wanted);
    std::memmove(piece_.data(), piece_.data() + given_, kept);
    const Result<std::size_t> got = file_.read_at(next_, piece_.data() + kept, wanted);
    if (!got) failure_ = got.error();
    const std::size_t read = got ? *got : 0;
    next_ += static_cast<std::int64_t>(read);
    given_ = 0;
    held_ = kept + read;
    return held_ >= count;
}

Error ByteRange::error() const { return failure_ ? *failure_ : ends_early(file_); }

Error ends_early(const InputFile& file) {
    return {ErrorCode::bad_data, file.path(), "damaged: the file ends before its last row"};
}

}  // namespace tex::inline v1
