// SPDX-License-Identifier: Apache-2.0

#include "kernels/zip_bytes.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/targets.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

int value(std::byte b) { return static_cast<int>(b); }

// One byte after the other.
Bytes differences(const Bytes& bytes) {
    Bytes sorted;
    for (const std::size_t first : {0u, 1u}) {
        for (std::size_t k = first; k < bytes.size(); k += 2) sorted.push_back(bytes[k]);
    }
    Bytes result = sorted;
    for (std::size_t k = 1; k < sorted.size(); ++k)
        result[k] = static_cast<std::byte>((value(sorted[k]) - value(sorted[k - 1]) + 128) & 255);
    return result;
}

// The bytes beside the result keep this value.
constexpr std::byte kBeside{0xa5};

template <class Convert>
Bytes converted(const Convert& convert, const Bytes& from) {
    Bytes out(from.size() + 64, kBeside);
    convert(from.data(), from.size(), out.data());
    for (std::size_t k = from.size(); k < out.size(); ++k) EXPECT_EQ(value(out[k]), value(kBeside)) << k;
    out.resize(from.size());
    return out;
}

TEST(ZipBytes, AreThoseOfTheFormatOnEveryTarget) {
    std::mt19937 random(3);
    for (std::size_t count = 0; count < 700; count += count < 300 ? 1 : 37) {
        Bytes bytes(count);
        for (std::byte& b : bytes) b = static_cast<std::byte>(random());
        const Bytes expected = differences(bytes);
        on_every_target([&] {
            EXPECT_EQ(converted(predict_zip_bytes, bytes), expected) << count;
            EXPECT_EQ(converted(restore_zip_bytes, expected), bytes) << count;
        });
    }
}

}  // namespace
}  // namespace tex
