// SPDX-License-Identifier: Apache-2.0

#include "files/input_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <thread>

#include "scratch.h"

namespace tex {
namespace {

Result<std::vector<std::byte>> read_whole_file(const std::string& path) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.error();
    return file->read_rest(1 << 20);
}

class InputFileTest : public testing::Test, protected Scratch {
protected:
    static std::string text(const std::vector<std::byte>& bytes) {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
};

TEST_F(InputFileTest, ReadsAWholeFile) {
    std::string content(200'000, 'x');
    for (std::size_t k = 0; k < content.size(); ++k) content[k] = static_cast<char>(k * 7 / 3);
    const auto bytes = read_whole_file(write("a", content));
    ASSERT_TRUE(bytes) << bytes.error().message();
    EXPECT_EQ(text(*bytes), content);
}

TEST_F(InputFileTest, AnEarlierInterruptionIsNotOneAtTheEnd) {
    auto file = InputFile::open(write("a", "abc"));
    ASSERT_TRUE(file);
    std::byte bytes[8];
    ASSERT_EQ(*file->read(bytes, 3), 3u);
    errno = EINTR;
    EXPECT_EQ(*file->read(bytes, 8), 0u);
}

TEST_F(InputFileTest, ReadsAFifo) {
    const std::string path = folder_ + "/fifo";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const std::string content(300'000, 'y');
    std::thread writer([&] { std::ofstream(path, std::ios::binary) << content; });
    const auto bytes = read_whole_file(path);
    writer.join();
    ASSERT_TRUE(bytes) << bytes.error().message();
    EXPECT_EQ(text(*bytes), content);
}

TEST_F(InputFileTest, SettlesAStreamInMemory) {
    const std::string path = folder_ + "/fifo";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(path, std::ios::binary) << std::string(100'000, 'y'); });
    auto file = InputFile::open(path);
    ASSERT_TRUE(file);
    EXPECT_FALSE(file->size());
    const auto settled = file->settle(1 << 20);
    writer.join();
    ASSERT_TRUE(settled);
    EXPECT_EQ(file->size(), 100'000);
    std::byte some[20];
    EXPECT_EQ(*file->read_at(99'990, some, 20), 10u);
    EXPECT_EQ(file->read_rest(1 << 20)->size(), 100'000u);
}

TEST_F(InputFileTest, HeadDoesNotConsume) {
    auto file = InputFile::open(write("a", "0123456789"));
    ASSERT_TRUE(file);
    EXPECT_EQ(file->head().size(), 10u);
    EXPECT_EQ(file->size(), 10);
    std::byte three[3];
    ASSERT_EQ(*file->read(three, 3), 3u);
    EXPECT_EQ(static_cast<char>(three[0]), '0');
    EXPECT_EQ(text(*file->read_rest(100)), "3456789");
    ASSERT_EQ(*file->read_at(8, three, 3), 2u);
    EXPECT_EQ(static_cast<char>(three[1]), '9');
}

TEST_F(InputFileTest, RefusesWhatIsNoFileInPlainWords) {
    EXPECT_EQ(read_whole_file(folder_ + "/missing").error().reason, "no such file or directory");
    EXPECT_EQ(read_whole_file(folder_).error().reason, "is a directory; name its files");
    EXPECT_EQ(read_whole_file("/dev/zero").error().reason, "is a device, not a file");
    EXPECT_EQ(read_whole_file(write("empty", "")).error().code, ErrorCode::bad_data);
    EXPECT_EQ(read_whole_file(std::string("a\0b", 3)).error().code, ErrorCode::io);
    if (geteuid() != 0) {
        const std::string path = write("secret", "s");
        ASSERT_EQ(chmod(path.c_str(), 0), 0);
        EXPECT_EQ(read_whole_file(path).error().reason, "permission denied");
    }
}

TEST_F(InputFileTest, RefusesMoreThanTheLimitBeforeTakingMemory) {
    const std::string path = write("sparse", "x");
    ASSERT_EQ(truncate(path.c_str(), off_t{1} << 40), 0);
    const auto bytes = read_whole_file(path);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
}

TEST_F(InputFileTest, AFileShortenedMeanwhileEndsEarly) {
    const std::string path = write("a", std::string(100'000, 'z'));
    auto file = InputFile::open(path);
    ASSERT_TRUE(file);
    ASSERT_EQ(truncate(path.c_str(), 1000), 0);
    EXPECT_EQ(file->read_rest(1 << 20)->size(), 1000u);
}

}  // namespace
}  // namespace tex
