// SPDX-License-Identifier: Apache-2.0

#include "formats/bottom_up.h"

#include <utility>

namespace tex::inline v1 {
namespace {

class BottomUpTarget final : public RowTarget {
public:
    BottomUpTarget(BottomUpFile file, WriteBytes write) : file_(std::move(file)), write_(std::move(write)) {
        const std::size_t texels = level_bytes(file_.format, {file_.extent.width, 1});
        stride_ = (texels + file_.alignment - 1) / file_.alignment * file_.alignment;
    }

    Result<void> put(int level, const std::byte* rows, int count) override;
    Result<void> finish() override {
        if (Result<void> written = write_(0, file_.head); !written) return written;
        return file_.tail.empty() ? Result<void>() : write_(place_of(file_.extent.height), file_.tail);
    }

private:
    // The offset of a row, counted from the bottom.
    [[nodiscard]] std::uint64_t place_of(int row) const {
        return file_.head.size() + static_cast<std::uint64_t>(row) * stride_;
    }

    const BottomUpFile file_;
    const WriteBytes write_;
    std::size_t stride_ = 0;
    int next_ = 0;  // the row that comes next, counted from the top
};

Result<void> BottomUpTarget::put(int, const std::byte* rows, int count) {
    const auto width = static_cast<std::size_t>(file_.extent.width);
    const std::size_t texel = format_info(file_.format).block_bytes;
    std::vector<std::byte> turned(stride_ * static_cast<std::size_t>(count));
    for (int j = count - 1; j >= 0; --j, rows += width * texel) {
        std::byte* const to = turned.data() + static_cast<std::size_t>(j) * stride_;
        rearrange_texels(file_.format, texel >= 3 ? Rearrange::bgr : Rearrange::none, rows, width, to);
    }
    next_ += count;
    return write_(place_of(file_.extent.height - next_), turned);
}

}  // namespace

std::unique_ptr<RowTarget> open_bottom_up(BottomUpFile file, WriteBytes write) {
    return std::make_unique<BottomUpTarget>(std::move(file), std::move(write));
}

}  // namespace tex::inline v1
