// SPDX-License-Identifier: Apache-2.0

#include "formats/file_values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "rows/channel_names.h"

namespace tex::inline v1 {
namespace {

// The numbers of TIFF.
constexpr std::uint32_t kSigned = 2, kFloating = 3;

// Whether the file says that its samples are quantities. Normals and colours are not, even if they are signed.
bool states_quantities(const RowSource& rows) {
    const StoredSamples& stored = rows.head().samples;
    if (stored.kind == 0) return false;
    const bool is_mixed = rows.head().sample == SampleKind::floating && stored.kind != kFloating;
    if (!is_mixed && !channel_groups(rows.names()).empty()) return false;
    return stored.kind == kSigned || (stored.kind != kFloating && stored.bits == 32) || stored.has_place != 0 ||
           stored.has_scale != 0;
}

// The rows of another source, as numbers.
class NumberRows final : public RowSource {
public:
    explicit NumberRows(std::unique_ptr<RowSource> rows) : rows_(std::move(rows)) {
        const bool has_numbers = rows_->store_numbers();
        head_ = rows_->head();
        if (!has_numbers && head_.sample != SampleKind::floating) {
            const int bits = head_.bits - (head_.sample == SampleKind::snorm ? 1 : 0);
            greatest_ = static_cast<double>((std::uint64_t{1} << bits) - 1);
        }
        if (head_.samples.has_scale != 0) {
            head_.scale = head_.samples.scale;
            head_.offset = head_.samples.offset;
        }
        head_.sample = SampleKind::floating;
        head_.bits = 32;
        head_.stored = true;
        if (head_.no_data) number(&*head_.no_data, 1);
    }

    [[nodiscard]] int rows_together() const override { return rows_->rows_together(); }
    [[nodiscard]] bool is_random() const override { return rows_->is_random(); }
    void choose_planes(const std::vector<bool>& wanted) override { rows_->choose_planes(wanted); }
    void keep_masked() override { rows_->keep_masked(); }
    [[nodiscard]] int block_rows() const override { return rows_->block_rows(); }
    Result<void> decode(int first, int count, std::byte* rows) override { return rows_->decode(first, count, rows); }
    [[nodiscard]] bool can_peek() const override { return rows_->can_peek(); }
    Result<void> peek(int first, int count, std::byte* rows) override { return rows_->peek(first, count, rows); }
    Result<void> finish() override { return rows_->finish(); }
    void store(const std::byte* rows, int first, int end, Image& image) const override {
        rows_->store(rows, first, end, image);
        if (greatest_ == 1.0 && head_.scale == 1.0 && head_.offset == 0.0) return;
        for (Plane<float>& plane : image.planes) {
            for (int j = first; j < end; ++j) number(plane.row(j), extent().width);
        }
    }

private:
    // A fraction of a whole number was rounded to float, so the number is found by rounding. Block formats have values
    // between the codes.
    void number(float* values, int count) const {
        constexpr double kRounding = 0.01;
        for (int i = 0; i < count; ++i) {
            const double value = static_cast<double>(values[i]) * greatest_;
            const double whole = std::floor(value + 0.5);
            const bool is_whole = greatest_ != 1.0 && std::abs(value - whole) < kRounding;
            values[i] = static_cast<float>((is_whole ? whole : value) * head_.scale + head_.offset);
        }
    }

    std::unique_ptr<RowSource> rows_;
    double greatest_ = 1.0;  // the number whose fraction is 1
};

}  // namespace

std::unique_ptr<RowSource> with_values(std::unique_ptr<RowSource> rows, FileValues values) {
    const bool wanted = values == FileValues::stored || (values == FileValues::automatic && states_quantities(*rows));
    const StoredSamples& stored = rows->head().samples;
    if (!wanted || (stored.kind == kFloating && stored.has_scale == 0)) return rows;
    return std::make_unique<NumberRows>(std::move(rows));
}

}  // namespace tex::inline v1
