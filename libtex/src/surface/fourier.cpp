// SPDX-License-Identifier: Apache-2.0

#include "surface/fourier.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// Appends the real and imaginary parts of exp(-2 pi i turn / turns).
void append_turn(WorkingVector<float>& factors, std::int64_t turn, std::int64_t turns) {
    const double angle = -2.0 * math::kPi * static_cast<double>(turn % turns) / static_cast<double>(turns);
    factors.push_back(static_cast<float>(math::cos(angle)));
    factors.push_back(static_cast<float>(math::sin(angle)));
}

constexpr int kRadices[] = {4, 5, 3, 2};

// `length` without its factors 2, 3 and 5.
int rough_part(int length) {
    for (const int prime : {2, 3, 5}) {
        while (length % prime == 0) length /= prime;
    }
    return length;
}

// exp(-i pi k^2 / length). k^2 is reduced in whole numbers, so that long sequences lose no accuracy.
WorkingVector<float> chirp_of(int length) {
    WorkingVector<float> chirp;
    chirp.reserve(2 * static_cast<std::size_t>(length));
    for (std::int64_t k = 0; k < length; ++k) append_turn(chirp, k * k, 2 * static_cast<std::int64_t>(length));
    return chirp;
}

void clear_from(Groups& data, int begin) {
    const int end = data.extent().height;
    std::memset(data.row(begin), 0, static_cast<std::size_t>(end - begin) * kGroup * sizeof(float));
}

}  // namespace

int smooth_length(int length) {
    while (rough_part(length) != 1) ++length;
    return length;
}

SmoothFourier::SmoothFourier(int length) : length_(length) {
    int stride = 1;
    stages_.reserve(32);
    for (const int radix : kRadices) {
        for (; length % radix == 0; length /= radix, stride *= radix) {
            Stage stage{radix, length, stride, {}};
            stage.twiddles.reserve(2 * static_cast<std::size_t>(length / radix * (radix - 1)));
            for (int p = 0; p < length / radix; ++p) {
                for (int l = 1; l < radix; ++l) append_turn(stage.twiddles, static_cast<std::int64_t>(p) * l, length);
            }
            stages_.push_back(std::move(stage));
        }
    }
}

void SmoothFourier::run(Groups& data, Groups& scratch) const {
    for (const Stage& stage : stages_) {
        fourier_stage({stage.radix, stage.length, stage.stride, stage.twiddles.data()}, data.row(0), scratch.row(0));
        std::swap(data, scratch);
    }
}

Fourier::Fourier(int length)
    : length_(length), fourier_(rough_part(length) == 1 ? length : smooth_length(2 * length - 1)) {
    const int size = fourier_.length();
    if (size == length) return;
    chirp_ = chirp_of(length);
    // The transform of the conjugate chirp, which is even, divided by the size: the inverse transform does not divide.
    Groups data = groups_of(size);
    Groups scratch = groups_of(size);
    clear_from(data, 0);
    for (int k = 0; k < length; ++k) {
        const auto at = 2 * static_cast<std::size_t>(k);
        for (const int row : {k, (size - k) % size}) {
            data.row(row)[0] = chirp_[at] / static_cast<float>(size);
            data.row(row)[kGroup / 2] = -chirp_[at + 1] / static_cast<float>(size);
        }
    }
    fourier_.run(data, scratch);
    kernel_.reserve(2 * static_cast<std::size_t>(size));
    for (int k = 0; k < size; ++k) {
        kernel_.push_back(data.row(k)[0]);
        kernel_.push_back(data.row(k)[kGroup / 2]);
    }
}

void Fourier::run(Groups& data, Groups& scratch) const {
    if (chirp_.empty()) {
        fourier_.run(data, scratch);
        return;
    }
    // The inverse transform is the conjugate of the transform of the conjugate.
    multiply_groups(Product::plain, chirp_.data(), length_, data.row(0));
    clear_from(data, length_);
    fourier_.run(data, scratch);
    multiply_groups(Product::conjugate, kernel_.data(), fourier_.length(), data.row(0));
    fourier_.run(data, scratch);
    multiply_groups(Product::of_conjugate, chirp_.data(), length_, data.row(0));
}

}  // namespace tex::inline v1
