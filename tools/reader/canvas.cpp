// SPDX-License-Identifier: Apache-2.0

#include <cstring>
#include <utility>

#include "canvas.h"

namespace tex::reader {
namespace {

// Orientations 5 to 8 exchange rows and columns first. Then the picture is mirrored.
constexpr bool exchanges(std::uint32_t orientation) { return orientation >= 5; }
constexpr bool mirrors_x(std::uint32_t o) { return o == 2 || o == 3 || o == 6 || o == 7; }
constexpr bool mirrors_y(std::uint32_t o) { return o == 3 || o == 4 || o == 7 || o == 8; }

}  // namespace

bool Canvas::begin(const Task& task) {
    if (header_.orientation < 1 || header_.orientation > 8) header_.orientation = 1;
    width_ = static_cast<std::size_t>(header_.width);
    height_ = static_cast<std::size_t>(header_.height);
    pixel_ = reader_type_bytes(header_.type) * static_cast<std::size_t>(header_.channels);
    if (exchanges(header_.orientation)) std::swap(header_.width, header_.height);
    if (!begin_picture(task, header_)) return false;
    if (header_.orientation != 1) waiting_.reserve(width_ * height_ * pixel_);
    return true;
}

void Canvas::put(const void* rows, int count) {
    if (header_.orientation == 1) return put_rows(header_, rows, count);
    const auto* const first = static_cast<const std::byte*>(rows);
    waiting_.insert(waiting_.end(), first, first + static_cast<std::size_t>(count) * width_ * pixel_);
}

void Canvas::end() {
    const std::uint32_t orientation = header_.orientation;
    if (orientation == 1) return;
    const auto width = static_cast<std::size_t>(header_.width);
    const auto height = static_cast<std::size_t>(header_.height);
    std::vector<std::byte> row(width * pixel_);
    for (std::size_t j = 0; j < height; ++j) {
        for (std::size_t i = 0; i < width; ++i) {
            std::size_t x = mirrors_x(orientation) ? width - 1 - i : i;
            std::size_t y = mirrors_y(orientation) ? height - 1 - j : j;
            if (exchanges(orientation)) std::swap(x, y);
            std::memcpy(&row[i * pixel_], &waiting_[(y * width_ + x) * pixel_], pixel_);
        }
        put_rows(header_, row.data(), 1);
    }
}

}  // namespace tex::reader
