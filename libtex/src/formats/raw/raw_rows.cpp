// SPDX-License-Identifier: Apache-2.0

#include "formats/raw/raw_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "kernels/samples.h"

namespace tex::inline v1 {
namespace {

std::uint32_t tiff_kind(SampleKind kind) {
    if (kind == SampleKind::floating) return 3;
    return kind == SampleKind::snorm ? 2 : 1;
}

// The value of the largest code, as a number.
double greatest_of(const RawSamples& samples) {
    const int bits = samples.bits - (samples.kind == SampleKind::snorm ? 1 : 0);
    return static_cast<double>((std::uint64_t{1} << bits) - 1);
}

class RawRows final : public RowSource {
public:
    RawRows(const InputFile& file, RawTexels place)
        : file_(file), samples_(place.samples), first_(place.first),
          pitch_(place.pitch != 0 ? place.pitch : static_cast<std::size_t>(place.extent.width) * place.samples.bytes()),
          no_data_number_(place.no_data) {
        describe(place.extent, {"Y"}, static_cast<std::size_t>(place.extent.width) * samples_.bytes(), samples_.kind,
                 samples_.bits);
        head_.samples = {.kind = tiff_kind(samples_.kind),
                         .bits = static_cast<std::uint32_t>(samples_.bits),
                         .has_place = place.has_place ? 1u : 0u,
                         .place = place.place};
        if (no_data_number_) head_.no_data = fraction(*no_data_number_);
        head_.remark = std::move(place.remark);
    }

    [[nodiscard]] bool is_random() const override { return true; }
    bool store_numbers() override {
        has_numbers_ = true;
        head_.no_data = no_data_number_;
        return true;
    }
    Result<void> decode(int first, int count, std::byte* rows) override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    [[nodiscard]] float fraction(float number) const {
        if (samples_.kind == SampleKind::floating) return number;
        return static_cast<float>(std::max(static_cast<double>(number) / greatest_of(samples_), -1.0));
    }
    template <class Code>
    void store_codes(const std::byte* row, float* to) const;
    void store_integers(const std::byte* row, float* to) const;

    const InputFile& file_;
    const RawSamples samples_;
    const std::int64_t first_;
    const std::size_t pitch_;
    const std::optional<float> no_data_number_;
    bool has_numbers_ = false;
};

Result<void> RawRows::decode(int first, int count, std::byte* rows) {
    const bool is_dense = pitch_ == row_bytes();
    const int together = is_dense ? count : 1;
    const std::size_t bytes = row_bytes() * static_cast<std::size_t>(together);
    for (int j = 0; j < count; j += together) {
        const std::int64_t place = first_ + static_cast<std::int64_t>(pitch_) * (first + j);
        const Result<std::size_t> got = file_.read_at(place, rows + row_bytes() * static_cast<std::size_t>(j), bytes);
        if (!got) return got.error();
        if (*got < bytes) return Error{ErrorCode::bad_data, file_.path(), "the file has become shorter"};
    }
    const std::size_t sample = samples_.bytes(), all = row_bytes() * static_cast<std::size_t>(count);
    for (std::size_t at = 0; samples_.big_endian && at < all; at += sample) std::reverse(rows + at, rows + at + sample);
    return {};
}

template <class Code>
void RawRows::store_codes(const std::byte* row, float* to) const {
    const double greatest = has_numbers_ ? 1.0 : greatest_of(samples_),
                 least = has_numbers_ ? -greatest_of(samples_) - 1.0 : -1.0;
    for (int i = 0; i < extent().width; ++i, row += sizeof(Code)) {
        Code code;
        std::memcpy(&code, row, sizeof code);
        to[i] = static_cast<float>(std::max(static_cast<double>(code) / greatest, least));
    }
}

void RawRows::store_integers(const std::byte* row, float* to) const {
    const bool is_signed = samples_.kind == SampleKind::snorm;
    switch (samples_.bits) {
        case 8: return is_signed ? store_codes<std::int8_t>(row, to) : store_codes<std::uint8_t>(row, to);
        case 16: return is_signed ? store_codes<std::int16_t>(row, to) : store_codes<std::uint16_t>(row, to);
        default: return is_signed ? store_codes<std::int32_t>(row, to) : store_codes<std::uint32_t>(row, to);
    }
}

void RawRows::store(const std::byte* rows, int first, int end, Image& image) const {
    for (int j = first; j < end; ++j, rows += row_bytes()) {
        float* const to = image.planes.front().row(j);
        const bool is_wide = samples_.kind != SampleKind::floating && samples_.bits == 32;
        if (samples_.kind != SampleKind::floating && (has_numbers_ || is_wide))
            store_integers(rows, to);
        else
            decode_samples(samples_.kind, samples_.bits, rows, samples_.bytes(), extent().width, to);
    }
}

}  // namespace

std::int64_t RawTexels::end() const {
    const auto row = static_cast<std::int64_t>(static_cast<std::size_t>(extent.width) * samples.bytes());
    const std::int64_t step = pitch != 0 ? static_cast<std::int64_t>(pitch) : row;
    return first + step * (extent.height - 1) + row;
}

std::unique_ptr<RowSource> open_raw_rows(const InputFile& file, RawTexels place) {
    return std::make_unique<RawRows>(file, std::move(place));
}

}  // namespace tex::inline v1
