// SPDX-License-Identifier: Apache-2.0
// c_maps.h: planes of a caller for the tests of tex_c.h: rows end with their last texels, and what lies between them
// must not change.

#pragma once

#include <tex/tex_c.h>

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>
#include <tex/types.h>

namespace tex::c_maps {

inline constexpr float kUntouched = -77.25f;

// Memory that ends where its page ends; the next page may not be touched. So what reads or writes beyond it crashes, in
// kernels too, which the sanitizers of some builds leave out.
template <class T>
class Guarded {
public:
    Guarded(std::size_t count, T value) : count_(count) {
        const std::size_t bytes = count * sizeof(T), pages = (bytes + kPage - 1) / kPage * kPage;
        mapped_ = pages + kPage;
        base_ = static_cast<char*>(mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
        if (base_ == MAP_FAILED || mprotect(base_ + pages, kPage, PROT_NONE) != 0) std::abort();
        data_ = reinterpret_cast<T*>(base_ + pages - bytes);
        std::fill_n(data_, count, value);
    }
    Guarded(const Guarded& other) : Guarded(other.count_, T{}) { std::copy_n(other.data_, count_, data_); }
    Guarded& operator=(const Guarded&) = delete;
    ~Guarded() { munmap(base_, mapped_); }

    [[nodiscard]] T* data() { return data_; }
    [[nodiscard]] std::size_t size() const { return count_; }

private:
    static constexpr std::size_t kPage = 4096;
    std::size_t count_, mapped_ = 0;
    char* base_ = nullptr;
    T* data_ = nullptr;
};

// A plane in memory of exactly its floats.
struct CallerPlane {
    explicit CallerPlane(Extent extent, int gap = 3)
        : stride(extent.width + gap), width(extent.width), height(extent.height),
          floats(static_cast<std::size_t>(stride * (height - 1) + width), kUntouched) {}
    CallerPlane(const Plane<float>& from, int gap = 3) : CallerPlane(from.extent(), gap) {
        for (int j = 0; j < height; ++j) std::copy_n(from.row(j), width, row(j));
    }

    [[nodiscard]] float* row(int j) { return floats.data() + j * stride; }
    [[nodiscard]] tex_plane view() { return {floats.data(), stride, width, height}; }

    // Whether nothing was written between the rows, and rows [first, end) are those of `wanted`, bit for bit.
    void expect(const Plane<float>& wanted, int first, int end) {
        for (int j = first; j < end; ++j) {
            for (int i = 0; i < width; ++i) {
                const float found = row(j)[i], right = wanted.at(i, j);
                if (found != right && !(found != found && right != right)) {
                    ADD_FAILURE() << "texel " << i << ", " << j << ": " << found << ", not " << right;
                    return;
                }
            }
        }
        for (int j = 0; j + 1 < height; ++j) {
            for (std::ptrdiff_t i = width; i < stride; ++i) ASSERT_EQ(row(j)[i], kUntouched) << "after row " << j;
        }
    }

    std::ptrdiff_t stride;
    int width, height;
    Guarded<float> floats;
};

struct CallerMap {
    explicit CallerMap(Extent extent) : x(extent), y(extent), z(extent) {}
    explicit CallerMap(const NormalMap& from) : x(from.x), y(from.y), z(from.z) {}

    [[nodiscard]] tex_map view() {
        return {x.floats.data(), y.floats.data(), z.floats.data(), x.stride, x.width, x.height};
    }
    void expect(const NormalMap& wanted) { expect(wanted, 0, x.height); }
    void expect(const NormalMap& wanted, int first, int end) {
        x.expect(wanted.x, first, end);
        y.expect(wanted.y, first, end);
        z.expect(wanted.z, first, end);
    }

    CallerPlane x, y, z;
};

// Scratch memory of exactly the size that a function states, at an odd address.
class ScratchMemory {
public:
    explicit ScratchMemory(std::size_t size) : bytes_(size + 1, 0), size_(size) {}
    [[nodiscard]] void* data() { return bytes_.data() + 1; }
    [[nodiscard]] std::size_t size() const { return size_; }

private:
    Guarded<unsigned char> bytes_;
    std::size_t size_;
};

}  // namespace tex::c_maps
