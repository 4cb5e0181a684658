// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_memory.h"

#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "formats/reader/reader.h"

namespace tex {
namespace {

constexpr std::int64_t kMiB = std::int64_t{1} << 20;

ReaderHeader header_of(int width, int height, int channels, ReaderType type) {
    ReaderHeader header;
    header.width = width;
    header.height = height;
    header.channels = channels;
    header.type = type;
    return header;
}

struct Limits {
    rlim_t space, size;
    bool operator==(const Limits&) const = default;
};

// The limits of a process after a grant, if its address space was limited to `space`.
[[maybe_unused]] Limits after_grant(std::int64_t space, std::uint64_t result, std::int64_t memory) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit of_space{static_cast<rlim_t>(space), static_cast<rlim_t>(space)};
        const rlimit of_size{kReaderDataOffset, static_cast<rlim_t>(memory)};
        setrlimit(RLIMIT_AS, &of_space);
        setrlimit(RLIMIT_FSIZE, &of_size);
        raise(SIGSTOP);
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, WUNTRACED);
    grant_result(child, result, memory);
    rlimit now_space{};
    rlimit now_size{};
    prlimit(child, RLIMIT_AS, nullptr, &now_space);
    prlimit(child, RLIMIT_FSIZE, nullptr, &now_size);
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return {now_space.rlim_cur, now_size.rlim_cur};
}

}  // namespace

TEST(ReaderMemory, AResultIsAsLongAsItsHeaderSays) {
    EXPECT_EQ(claimed_result(header_of(10, 20, 3, ReaderType::u16), "decode", kMiB), 8192u + 1200);
    EXPECT_EQ(claimed_result(header_of(1024, 1016, 1, ReaderType::u8), "decode", kMiB), 1u << 20);
    EXPECT_EQ(claimed_result(header_of(1024, 1017, 1, ReaderType::u8), "decode", kMiB), 0u);
    ReaderHeader encoded;
    encoded.bytes = 77;
    EXPECT_EQ(claimed_result(encoded, "encode", kMiB), 8192u + 77);
}

TEST(ReaderMemory, AHeaderThatSaysNothingYetIsNotAnswered) {
    EXPECT_EQ(claimed_result(ReaderHeader(), "decode", kMiB), std::nullopt);
    EXPECT_EQ(claimed_result(ReaderHeader(), "describe", kMiB), std::nullopt);
    EXPECT_EQ(claimed_result(header_of(4, 4, 4, ReaderType::u8), "encode", kMiB), std::nullopt);
}

TEST(ReaderMemory, NonsenseGetsNothing) {
    constexpr int kMost = 0x7fffffff;
    for (const ReaderHeader& header :
         {header_of(-1, 1, 1, ReaderType::u8), header_of(1, -1, 1, ReaderType::u8), header_of(1, 1, 0, ReaderType::u8),
          header_of(1, 1, kMost, ReaderType::u8), header_of(kMost, kMost, 64, ReaderType::f32),
          header_of(1, 1, 1, static_cast<ReaderType>(99))})
        EXPECT_EQ(claimed_result(header, "decode", kMiB), 0u);
    ReaderHeader encoded;
    encoded.bytes = ~std::uint64_t{0};
    EXPECT_EQ(claimed_result(encoded, "encode", kMiB), 0u);
    EXPECT_EQ(claimed_result(header_of(1, 1, 1, ReaderType::u8), "decode", -1), 0u);
}

#if !defined(__SANITIZE_ADDRESS__)  // with it, processes are larger than any limit
TEST(ReaderMemory, WhatTheResultGetsTheAddressSpaceLoses) {
    constexpr std::int64_t kAll = 4096 * kMiB;
    EXPECT_EQ(after_grant(kAll, 100 * kMiB, kAll), (Limits{3996 * kMiB, 100 * kMiB}));
    // A process that starts with less keeps less.
    EXPECT_EQ(after_grant(2000 * kMiB, 100 * kMiB, kAll), (Limits{2000 * kMiB, 100 * kMiB}));
    // There is no room for a result without claimed bytes, nor beside an address space that is already too large. The
    // answer is then one byte.
    EXPECT_EQ(after_grant(kAll, 0, kAll), (Limits{kAll, 8193}));
    EXPECT_EQ(after_grant(kAll, kAll - kMiB, kAll), (Limits{kMiB, 8193}));
}

// In an earlier version the reader could use the memory twice: as address space, and in the result.
TEST(ReaderMemory, OneBoundHoldsForBothTogether) {
    constexpr int kWidth = 17'000, kHeight = 18'500;  // 900 MiB
    std::string bytes("BM", 2);
    const auto put = [&](std::uint32_t value, int count) {
        for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> 8 * k & 0xff);
    };
    constexpr std::uint32_t kHeader = 54, kData = kWidth * kHeight * 3;
    for (const std::uint32_t field : {kHeader + kData, 0u, kHeader, 40u}) put(field, 4);
    put(kWidth, 4), put(kHeight, 4), put(1, 2), put(24, 2);
    for (const std::uint32_t field : {0u, kData, 0u, 0u, 0u, 0u}) put(field, 4);
    const std::string path = testing::TempDir() + "reader_memory_test.bmp";
    std::ofstream(path, std::ios::binary) << bytes;
    ASSERT_EQ(truncate(path.c_str(), kHeader + std::int64_t{kData}), 0);  // the rest is a hole
    ReadOptions options;
    options.reader_memory = 1024 * kMiB;
    const Result<Image> image = read_image(path, options);
    std::filesystem::remove(path);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().reason, "needs more memory than the 1024 MiB that a decoder may have");
}
#endif

}  // namespace tex
