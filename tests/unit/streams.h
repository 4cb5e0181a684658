// SPDX-License-Identifier: Apache-2.0
// streams.h: code shared by the tests of files that are processed as streams: a folder, and damage.

#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tex/types.h>

#include "scratch.h"
#include "unit/textures.h"

namespace tex {

using Bytes = std::vector<std::byte>;

template <class E, std::size_t N>
E any_of(const Named<E> (&table)[N], std::mt19937& random) {
    return table[random() % N].value;
}

class StreamTest : public testing::Test, protected Scratch {
protected:
    // "cut" and "hurt" are damaged copies of a sound file. For them stream(input, threads) must return the same error
    // as read(input), and must not leave "out".
    template <class Read, class Stream>
    void expect_same_damage(const std::string& sound, const Read& read, const Stream& stream) const {
        Bytes bytes = bytes_of(sound);
        const std::string cut = write("cut", Bytes(bytes.begin(), bytes.end() - 300));
        bytes[bytes.size() / 2] ^= std::byte{0x5a};
        for (const std::string& input : {write("hurt", bytes), cut}) {
            const Error expected = read(input).error();
            EXPECT_EQ(expected.code, ErrorCode::bad_data);
            for (const int threads : {1, 3}) {
                const auto report = stream(input, threads);
                ASSERT_FALSE(report);
                EXPECT_EQ(report.error().message(), expected.message());
                EXPECT_EQ(report.error().code, expected.code);
                EXPECT_FALSE(std::filesystem::exists(path("out")));
            }
        }
    }
};

}  // namespace tex
