// SPDX-License-Identifier: Apache-2.0

#include "files/descriptor.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/nameless_file.h"
#include "files/path_names.h"
#include "scratch.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

class Descriptors : public testing::Test, protected Scratch {};

std::string read_at(int fd, std::uint64_t offset, std::size_t count) {
    std::string text(count, '\0');
    const auto got = read_some_at(fd, offset, reinterpret_cast<std::byte*>(text.data()), count);
    text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return text;
}

std::string read_next(int fd, std::size_t count) {
    std::string text(count, '\0');
    const auto got = read_some(fd, reinterpret_cast<std::byte*>(text.data()), count);
    text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return text;
}

// Windows moves the position with every read, which must not be seen.
TEST_F(Descriptors, AReadAtAnOffsetLeavesThePosition) {
    write("text", "0123456789");
    const Descriptor file = open_for_reading(path("text"));
    ASSERT_TRUE(file);
    EXPECT_EQ(read_next(file.get(), 3), "012");
    EXPECT_EQ(read_at(file.get(), 7, 9), "789");
    EXPECT_EQ(read_at(file.get(), 10, 1), "");
    EXPECT_EQ(position_of(file.get()), 3);
    EXPECT_EQ(read_next(file.get(), 2), "34");
    ASSERT_TRUE(set_position(file.get(), 9));
    EXPECT_EQ(read_next(file.get(), 2), "9");
}

TEST_F(Descriptors, BytesAreNotLines) {
    constexpr std::string_view kBytes("a\r\nb\n\x1a\0c", 8);
    write("bytes", kBytes);
    const Descriptor file = open_for_reading(path("bytes"));
    ASSERT_TRUE(file);
    EXPECT_EQ(read_next(file.get(), 20), kBytes);
}

TEST_F(Descriptors, ATemporaryFileHasNoNameAnybodyFinds) {
    {
        const Descriptor file = temporary_file(folder_);
        ASSERT_TRUE(file);
        const std::string text = "some bytes";
        const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
        EXPECT_EQ(write_some_at(file.get(), 5, bytes, text.size()), static_cast<std::ptrdiff_t>(text.size()));
        EXPECT_EQ(read_at(file.get(), 5, 20), text);
        EXPECT_EQ(read_at(file.get(), 0, 5), std::string(5, '\0'));
        EXPECT_EQ(FileStatus::of(file.get())->version.size, 15);
    }
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Descriptors, TwoNamesOfAFileAreOne) {
    write("one", "x");
    fs::create_hard_link(path("one"), path("two"));
    write("three", "x");
    const auto one = FileVersion::of(path("one")), two = FileVersion::of(path("two"));
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->inode, two->inode);
    EXPECT_NE(one->inode, FileVersion::of(path("three"))->inode);
    EXPECT_EQ(FileStatus::of(folder_)->kind, FileKind::folder);
    EXPECT_FALSE(FileVersion::of(folder_));
}

TEST_F(Descriptors, WhatIsMissingHasAReason) {
    EXPECT_FALSE(open_for_reading(path("none")));
    EXPECT_EQ(errno, ENOENT);
    EXPECT_FALSE(FileStatus::of(path("none")));
    EXPECT_EQ(errno, ENOENT);
}

TEST(PathNames, TheLastNameBeginsAfterTheLastSeparator) {
    EXPECT_EQ(name_begin("a.png"), 0U);
    EXPECT_EQ(name_begin("art/rock/a.png"), 9U);
    EXPECT_EQ(name_begin("art/"), 4U);
    EXPECT_EQ(name_begin("art\\a.png"), kHasBackslashes ? 4U : 0U);
    EXPECT_TRUE(is_absolute("/art"));
    EXPECT_FALSE(is_absolute("art/C:"));
    EXPECT_EQ(is_absolute("C:art"), kHasBackslashes);
    EXPECT_EQ(slashed(fs::path("art") / "a.png"), "art/a.png");
    EXPECT_EQ(slashed("art//a.png"), kHasBackslashes ? "art/a.png" : "art//a.png");
}

}  // namespace
}  // namespace tex
