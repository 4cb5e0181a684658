// SPDX-License-Identifier: Apache-2.0

#include "stream/made_rows.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "blocks/extent.h"
#include "formats/channels.h"
#include "formats/claims.h"
#include "rows/pack_rows.h"

namespace tex {
namespace {

constexpr std::size_t kTexelBytes = 3 * sizeof(float);

}  // namespace

MadeRows::MadeRows(RowSource& rows, const std::string& input, Extent extent, YAxis y, const MakeStage& make,
                   Convert convert)
    : rows_(rows), input_(input), y_(y), convert_(std::move(convert)), row_(Extent{extent.width, 1}) {
    describe(extent, {"R", "G", "B"}, static_cast<std::size_t>(extent.width) * kTexelBytes);
    describe_samples(SampleKind::floating, 32, "signed");
    const int held = rows.held_rows(rows.rows_together());
    image_ = make_image({rows.extent().width, held}, rows.names());
    decoded_.resize(rows.row_bytes() * static_cast<std::size_t>(held));
    stage_ = make(sink());
}

NormalSink MadeRows::sink() {
    return {[this](int) {
                return NormalRow{row_.x.row(0), row_.y.row(0), row_.z.row(0)};
            },
            [this](int j) {
                std::vector<std::byte>& bytes = made_[j];
                bytes.resize(row_bytes());
                PackOptions pack;
                pack.encoding = Encoding::float_;
                pack.y_axis = y_;
                pack_rows(row_, 1, pack, 0, 1, bytes.data(), kBlockEdge);
            }};
}

Result<void> MadeRows::pull() {
    const int height = rows_.extent().height;
    const int count = std::min(rows_.rows_together(), height - next_);
    if (count <= 0) return Error{ErrorCode::unsupported, input_, "rows are missing: this is a bug"};
    if (const Result<void> decoded = rows_.decode(next_, count, decoded_.data()); !decoded)
        return decoded.error().of(input_);
    rows_.store(decoded_.data(), 0, count, image_);
    if (convert_) {
        if (Result<void> converted = convert_(image_, count); !converted) return converted;
    }
    stage_->put(image_, count);
    next_ += count;
    if (next_ < height) return {};
    is_finished_ = true;
    if (const Result<void> ended = rows_.finish(); !ended) return ended.error().of(input_);
    return stage_->check();
}

Result<void> MadeRows::decode(int first, int count, std::byte* rows) {
    for (int j = first; j < first + count; ++j, rows += row_bytes()) {
        auto made = made_.find(j);
        while (made == made_.end()) {
            // A stage that has found an invalid value makes no more rows.
            if (is_finished_) return Error{ErrorCode::unsupported, input_, "rows are missing: this is a bug"};
            if (Result<void> pulled = pull(); !pulled) return pulled;
            made = made_.find(j);
        }
        std::memcpy(rows, made->second.data(), row_bytes());
        made_.erase(made);
    }
    return {};
}

Result<void> MadeRows::finish() {
    while (!is_finished_) {
        if (Result<void> pulled = pull(); !pulled) return pulled;
    }
    return {};
}

void MadeRows::store(const std::byte* rows, int first, int end, Image& image) const {
    for (int j = first; j < end; ++j, rows += row_bytes()) {
        float* const planes[3] = {image.planes[0].row(j), image.planes[1].row(j), image.planes[2].row(j)};
        for (int i = 0; i < extent().width; ++i) {
            float texel[3];
            std::memcpy(texel, rows + static_cast<std::size_t>(i) * kTexelBytes, kTexelBytes);
            for (int c = 0; c < 3; ++c) planes[c][i] = texel[c];
        }
    }
}

TextureRows made_texture(YAxis y, bool y_known) {
    TextureRows texture;
    texture.head.format = Format::rgb32_float;
    texture.head.swizzle = likely_swizzle(Format::rgb32_float);
    texture.head.swizzle_known = true;
    texture.head.y_axis = y;
    texture.head.y_known = y_known;
    texture.head.normal_encoding = "signed";
    texture.planes = {0, 1, 2};
    return texture;
}

}  // namespace tex
