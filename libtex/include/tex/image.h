// SPDX-License-Identifier: Apache-2.0
// image.h: extents, planes of values, and images made of named planes.
//
// Memory layout. The value of texel (i, j), i to the right, j down from the top row, is at
//
//     data[j * stride + i]          0 <= i < extent.width,  0 <= j < extent.height
//
// with the stride in elements, not bytes. Rows of a Plane start on kRowAlignment bytes and are padded to a multiple of
// it, so that a kernel may load and store whole vectors past the last texel of a row; the values in the padding have no
// meaning. Rows of a PlaneView that a caller makes need no padding: verbs on whole images accept any stride >= width.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/names.h>

#pragma GCC visibility push(default)
namespace tex {

// Width and height in texels; a valid extent has both at least 1.
struct Extent {
    int width = 0;
    int height = 0;

    [[nodiscard]] constexpr std::int64_t texels() const { return static_cast<std::int64_t>(width) * height; }
    friend constexpr bool operator==(Extent a, Extent b) { return a.width == b.width && a.height == b.height; }
    friend constexpr bool operator!=(Extent a, Extent b) { return !(a == b); }
};

// The largest width or height that libtex handles, in texels.
inline constexpr int kMaxExtent = 1 << 20;

// Rows of a Plane start at multiples of this many bytes: the widest vector of any kernel.
inline constexpr std::size_t kRowAlignment = 64;

// A view of a plane that another object owns. `stride` is in elements, at least extent.width.
template <class T>
struct PlaneView {
    T* data = nullptr;
    Extent extent;
    std::ptrdiff_t stride = 0;

    [[nodiscard]] T* row(int j) const { return data + j * stride; }
    [[nodiscard]] T& at(int i, int j) const { return data[j * stride + i]; }
    operator PlaneView<const T>() const { return {data, extent, stride}; }
};

// allocate_rows() returns the memory of a Plane: `bytes` bytes that start at a multiple of kRowAlignment. It is
// released with the last pointer to it. Compiled in libtex, so that programs compiled with -fno-exceptions can use
// planes. If memory runs out, std::bad_alloc is thrown, and such a program ends.
[[nodiscard]] std::shared_ptr<void> allocate_rows(std::size_t bytes);

// The stride of a Plane of this width: rows are padded to whole multiples of kRowAlignment.
template <class T>
[[nodiscard]] constexpr std::ptrdiff_t padded_stride(int width) {
    constexpr std::ptrdiff_t kStep = static_cast<std::ptrdiff_t>(kRowAlignment / sizeof(T));
    return (width + kStep - 1) / kStep * kStep;
}

// Owns one plane, or shares its memory with others. Movable, not copyable by accident: clone() copies. The constructor
// leaves the texels unset and the padding zero, and throws std::bad_alloc like any container of the standard library.
template <class T>
class Plane {
public:
    Plane() = default;
    explicit Plane(Extent extent)
        : Plane(extent, padded_stride<T>(extent.width), allocate(extent, padded_stride<T>(extent.width))) {
        clear_padding();
    }
    Plane(Extent extent, T value) : Plane(extent) {
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) row(j)[i] = value;
        }
    }
    // A plane in memory that exists already. `rows` points to the first texel and keeps the memory; `stride` is in
    // elements, at least extent.width, or 0 if all rows are the same row, which must not be written to. Every row, also
    // the last one, must be followed by readable memory up to a multiple of kRowAlignment bytes after its start, but
    // need not be aligned: a verb that takes the plane as const only reads it, and all give the same bytes.
    Plane(Extent extent, std::ptrdiff_t stride, std::shared_ptr<T> rows)
        : extent_(extent), stride_(stride), rows_(std::move(rows)) {}

    Plane(Plane&&) noexcept = default;
    Plane& operator=(Plane&&) noexcept = default;
    Plane(const Plane&) = delete;
    Plane& operator=(const Plane&) = delete;
    ~Plane() = default;

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }  // in elements
    [[nodiscard]] bool empty() const { return rows_ == nullptr; }
    [[nodiscard]] T* row(int j) { return rows_.get() + j * stride_; }
    [[nodiscard]] const T* row(int j) const { return rows_.get() + j * stride_; }
    [[nodiscard]] T& at(int i, int j) { return row(j)[i]; }
    [[nodiscard]] const T& at(int i, int j) const { return row(j)[i]; }
    [[nodiscard]] PlaneView<T> view() { return {rows_.get(), extent_, stride_}; }
    [[nodiscard]] PlaneView<const T> view() const { return {rows_.get(), extent_, stride_}; }

    [[nodiscard]] Plane clone() const {
        if (empty()) return {};
        Plane copy(extent_);
        for (int j = 0; j < extent_.height; ++j)
            std::memcpy(copy.row(j), row(j), static_cast<std::size_t>(extent_.width) * sizeof(T));
        return copy;
    }

    // The padding becomes zero.
    void clear_padding() {
        for (int j = 0; j < extent_.height; ++j) {
            std::memset(row(j) + extent_.width, 0, static_cast<std::size_t>(stride_ - extent_.width) * sizeof(T));
        }
    }

private:
    static std::shared_ptr<T> allocate(Extent extent, std::ptrdiff_t stride) {
        const std::size_t count = static_cast<std::size_t>(stride) * static_cast<std::size_t>(extent.height);
        std::shared_ptr<void> memory = allocate_rows(count * sizeof(T));
        T* const rows = static_cast<T*>(memory.get());
        return {std::move(memory), rows};
    }

    Extent extent_;
    std::ptrdiff_t stride_ = 0;
    std::shared_ptr<T> rows_;
};

// How a file stored the values before they were converted to float.
enum class SampleKind { unorm, snorm, floating };

// A picture as read from a file: planes of one extent, in the order of the file, each with its channel's
// name ("R", "G", "B", "A" for colour and alpha, "Y" for grey; EXR channels keep theirs). The values are the raw
// data of the file: no colour conversion, no multiplication by alpha. Unsigned integers of n bits are
// divided by 2^n - 1 and so lie in [0, 1], signed ones by 2^(n-1) - 1 and lie in [-1, 1], floats are as stored and may
// be infinite or NaN. The values may also be the numbers themselves: see `stored`.
struct Image {
    std::vector<Plane<float>> planes;
    std::vector<std::string> names;

    SampleKind sample = SampleKind::unorm;
    int bits = 8;  // significant bits of a sample in the file: 1 to 16, or 32; 16 or 32 for half and float

    // The EXR attribute normalEncoding, or empty: "signed" if the values are the components of normals themselves.
    std::string normal_encoding;

    // What a picture that libtex wrote states about its channels, for example "rgb +y" (see encode_file()), or empty.
    // read_texture() applies it.
    std::string normal_mark;
    // The value of texels without data, if the file names one (GDAL_NODATA in TIFF).
    std::optional<float> no_data;

    // Whether the values are the numbers that the file stores (ReadOptions::values), as scale * number + offset.
    // `sample` is then floating.
    bool stored = false;
    double scale = 1.0;  // of GDAL, if the file states them
    double offset = 0.0;

    std::string remark;  // what the reader had to find out, such as the extent of a file without a header, or empty

    [[nodiscard]] Extent extent() const { return planes.empty() ? Extent{} : planes.front().extent(); }
    // The index of the plane called `name` (exact), or -1.
    [[nodiscard]] int find(const std::string& name) const {
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (names[k] == name) return static_cast<int>(k);
        }
        return -1;
    }
};

}  // namespace tex
#pragma GCC visibility pop
