// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "formats/reader/reader_process.h"
#include "formats/reader/reader_rows.h"

namespace tex {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

ReadOptions quick() {
    ReadOptions options;
    options.reader_timeout = 20;
    return options;
}

void put(Bytes& bytes, std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k)));
}

// An uncompressed TIFF with one strip, built tag by tag.
struct TiffMaker {
    int width, height;
    int samples = 1;
    int bits = 8;
    int sample_format = 1;  // 1 unsigned, 2 signed, 3 floating
    int photometric = 1;    // 1 black is zero, 2 RGB, 3 palette, 5 CMYK
    int extra = -1;         // type of an extra sample: 1 associated, 2 unassociated alpha
    int orientation = 1;
    Bytes palette = {};  // 3 * 2^bits shorts
    Bytes data = {};

    [[nodiscard]] Bytes make() const {
        std::vector<std::array<std::uint32_t, 4>> tags = {
            {256, 4, 1, static_cast<std::uint32_t>(width)},       {257, 4, 1, static_cast<std::uint32_t>(height)},
            {258, 3, static_cast<std::uint32_t>(samples), 0},     {259, 3, 1, 1},
            {262, 3, 1, static_cast<std::uint32_t>(photometric)}, {273, 4, 1, 0},
            {274, 3, 1, static_cast<std::uint32_t>(orientation)}, {277, 3, 1, static_cast<std::uint32_t>(samples)},
            {278, 4, 1, static_cast<std::uint32_t>(height)},      {279, 4, 1, static_cast<std::uint32_t>(data.size())}};
        if (!palette.empty()) tags.push_back({320, 3, static_cast<std::uint32_t>(palette.size() / 2), 0});
        if (extra >= 0) tags.push_back({338, 3, 1, static_cast<std::uint32_t>(extra)});
        tags.push_back({339, 3, static_cast<std::uint32_t>(samples), 0});
        const auto after = static_cast<std::uint32_t>(8 + 2 + 12 * tags.size() + 4);
        Bytes tail;
        for (auto& tag : tags) {
            const bool list = tag[0] == 258 || tag[0] == 339;
            if (list && samples > 2) {
                tag[3] = after + static_cast<std::uint32_t>(tail.size());
                for (int k = 0; k < samples; ++k)
                    put(tail, static_cast<std::uint32_t>(tag[0] == 258 ? bits : sample_format), 2);
            } else if (list) {
                const auto v = static_cast<std::uint32_t>(tag[0] == 258 ? bits : sample_format);
                tag[3] = samples == 2 ? v | v << 16 : v;
            } else if (tag[0] == 320) {
                tag[3] = after + static_cast<std::uint32_t>(tail.size());
                tail.insert(tail.end(), palette.begin(), palette.end());
            } else if (tag[0] == 273) {
                continue;  // filled in when the tail is known
            }
        }
        Bytes bytes;
        put(bytes, 0x002a4949, 4);
        put(bytes, 8, 4);
        put(bytes, static_cast<std::uint32_t>(tags.size()), 2);
        for (const auto& tag : tags) {
            put(bytes, tag[0], 2);
            put(bytes, tag[1], 2);
            put(bytes, tag[2], 4);
            put(bytes, tag[0] == 273 ? after + static_cast<std::uint32_t>(tail.size()) : tag[3], 4);
        }
        put(bytes, 0, 4);
        bytes.insert(bytes.end(), tail.begin(), tail.end());
        bytes.insert(bytes.end(), data.begin(), data.end());
        return bytes;
    }
};

template <class T>
Bytes raw(std::initializer_list<T> values) {
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.begin(), bytes.size());
    return bytes;
}

Result<Image> read(const Bytes& bytes, const ReadOptions& options = quick()) {
    Result<InputFile> file = InputFile::from_memory("test", bytes);
    if (!file) return file.error();
    return read_all(open_reader_rows(*file, options));
}

void expect_row(const Result<Image>& image, std::size_t plane, const std::vector<float>& values) {
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_LT(plane, image->planes.size());
    ASSERT_EQ(static_cast<std::size_t>(image->extent().width), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(image->planes[plane].at(static_cast<int>(i), 0), values[i]) << i;
}

TEST(Reader, ReadsEverySampleTypeOfTiffRaw) {
    TiffMaker tiff{4, 1};
    tiff.data = raw<std::uint8_t>({0, 1, 128, 255});
    expect_row(read(tiff.make()), 0, {0.0f, 1 / 255.0f, 128 / 255.0f, 1.0f});
    tiff.bits = 16;
    tiff.data = raw<std::uint16_t>({0, 1, 32768, 65535});
    expect_row(read(tiff.make()), 0, {0.0f, 1 / 65535.0f, 32768 / 65535.0f, 1.0f});
    tiff.bits = 32;
    tiff.data = raw<std::uint32_t>({0, 1, 2147483648u, 4294967295u});
    expect_row(read(tiff.make()), 0,
               {0.0f, static_cast<float>(1 / 4294967295.0), static_cast<float>(2147483648.0 / 4294967295.0), 1.0f});
    tiff.sample_format = 2;
    tiff.bits = 16;
    tiff.data = raw<std::int16_t>({-32768, -32767, 0, 32767});
    const Result<Image> sixteen = read(tiff.make());
    expect_row(sixteen, 0, {-1.0f, -1.0f, 0.0f, 1.0f});
    EXPECT_EQ(sixteen->sample, SampleKind::snorm);
    tiff.sample_format = 3;
    tiff.bits = 32;
    tiff.data = raw<float>({-5.25f, 0.1f, 8848.86f, 1e30f});
    const Result<Image> floats = read(tiff.make());
    expect_row(floats, 0, {-5.25f, 0.1f, 8848.86f, 1e30f});
    EXPECT_EQ(floats->sample, SampleKind::floating);
    EXPECT_EQ(floats->bits, 32);
}

TEST(Reader, FewBitsAreTheirCodesOverTheLargest) {
    TiffMaker tiff{4, 1};
    tiff.bits = 4;
    tiff.data = raw<std::uint8_t>({0x01, 0x7f});
    const Result<Image> four = read(tiff.make());
    expect_row(four, 0, {0.0f, 1 / 15.0f, 7 / 15.0f, 1.0f});
    EXPECT_EQ(four->bits, 4);
    tiff.bits = 1;
    tiff.data = raw<std::uint8_t>({0x50});
    expect_row(read(tiff.make()), 0, {0.0f, 1.0f, 0.0f, 1.0f});
}

TEST(Reader, PaletteColoursKeepAllTheirBits) {
    TiffMaker tiff{4, 1};
    tiff.bits = 4;
    tiff.photometric = 3;
    for (int c = 0; c < 3; ++c) {
        for (std::uint32_t v = 0; v < 16; ++v) put(tiff.palette, (v * 13 + static_cast<std::uint32_t>(c)) * 257, 2);
    }
    tiff.data = raw<std::uint8_t>({0x01, 0x7f});
    const Result<Image> image = read(tiff.make());
    expect_row(image, 0, {0.0f, 13 / 255.0f, 91 / 255.0f, 195 / 255.0f});
    expect_row(image, 2, {2 / 255.0f, 15 / 255.0f, 93 / 255.0f, 197 / 255.0f});
    EXPECT_EQ(image->bits, 8);
}

TEST(Reader, UnassociatedAlphaTouchesNoColour) {
    TiffMaker tiff{1, 1};
    tiff.samples = 4;
    tiff.photometric = 2;
    tiff.extra = 2;
    tiff.data = raw<std::uint8_t>({200, 100, 50, 10});
    const Result<Image> image = read(tiff.make());
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->names, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(image->planes[0].at(0, 0), 200 / 255.0f);
    EXPECT_EQ(image->planes[3].at(0, 0), 10 / 255.0f);
}

TEST(Reader, OrientationTagsChangeNothing) {
    TiffMaker tiff{2, 2};
    tiff.data = raw<std::uint8_t>({10, 20, 30, 40});
    tiff.orientation = 6;
    const Result<Image> image = read(tiff.make());
    ASSERT_TRUE(image);
    EXPECT_EQ(image->planes[0].at(1, 0), 20 / 255.0f);
    EXPECT_EQ(image->planes[0].at(0, 1), 30 / 255.0f);
}

TEST(Reader, RefusesCmyk) {
    TiffMaker tiff{1, 1};
    tiff.samples = 4;
    tiff.photometric = 5;
    tiff.data = raw<std::uint8_t>({1, 2, 3, 4});
    const Result<Image> image = read(tiff.make());
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::unsupported);
    EXPECT_EQ(image.error().reason, "CMYK pictures are not read");
}

TEST(Reader, RefusesMoreTexelsThanTheLimit) {
    TiffMaker tiff{4, 1};
    tiff.data = raw<std::uint8_t>({0, 1, 128, 255});
    ReadOptions options = quick();
    options.max_texels = 3;
    EXPECT_EQ(read(tiff.make(), options).error().code, ErrorCode::unsupported);
    tiff.width = 1'000'000;  // with four bytes of data
    tiff.height = 1'000'000;
    EXPECT_FALSE(read(tiff.make()));
}

TEST(Reader, TgaRowsComeFromTheTop) {
    for (const bool from_top : {false, true}) {
        Bytes tga;
        put(tga, 0x030000, 4);  // no id, no palette, grey, then five bytes for the missing palette
        put(tga, 0, 4);
        put(tga, 0, 4);
        put(tga, 1, 2);
        put(tga, 2, 2);
        put(tga, 8, 1);
        put(tga, from_top ? 0x20 : 0, 1);
        put(tga, 10, 1);
        put(tga, 20, 1);
        const Result<Image> image = read(tga);
        ASSERT_TRUE(image) << image.error().message();
        EXPECT_EQ(image->planes[0].at(0, 0), (from_top ? 10 : 20) / 255.0f);
        EXPECT_EQ(image->names, (std::vector<std::string>{"Y"}));
    }
}

// -- readers that misbehave ----------------------------------------------------------------------------------

class BadReader : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "reader_XXXXXX";
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        tiff_.data = raw<std::uint8_t>({0, 1, 128, 255});
    }
    void TearDown() override { fs::remove_all(folder_); }
    // Reads a sound picture with a shell script as the reader.
    Error read_with(const std::string& script, int timeout = 20) {
        ReadOptions options;
        options.reader = folder_ + "/reader";
        options.reader_timeout = timeout;
        std::ofstream(options.reader) << "#!/bin/sh\n" << script << '\n';
        chmod(options.reader.c_str(), 0755);
        const Result<Image> image = read(tiff_.make(), options);
        return image ? Error{ErrorCode::cancelled, {}, "it was read"} : image.error();
    }
    // A script that writes `header` and then `data` zero bytes, and succeeds.
    std::string handing_over(const ReaderHeader& header, int data) {
        std::ofstream file(folder_ + "/header", std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof header);
        file.close();
        return "/usr/bin/head -c 8192 " + folder_ + "/header /dev/zero 2>/dev/null >/dev/null; /bin/cat " + folder_ +
               "/header >&3; /usr/bin/head -c " +
               std::to_string(static_cast<int>(kReaderDataOffset - sizeof header) + data) + " /dev/zero >&3";
    }
    ReaderHeader sound() const {
        ReaderHeader header;
        header.state = ReaderState::done;
        header.width = 4;
        header.height = 1;
        header.channels = 1;
        header.bits = 8;
        return header;
    }
    TiffMaker tiff_{4, 1};
    std::string folder_;
};

TEST_F(BadReader, ThatCrashesIsOneSentence) {
    ReaderHeader header = sound();
    header.state = ReaderState::working;
    const Error error = read_with(handing_over(header, 4) + "; kill -SEGV $$");
    EXPECT_EQ(error.code, ErrorCode::bad_data);
    EXPECT_EQ(error.reason, "the decoder crashed on this file (signal 11)");
    const Error early = read_with("kill -SEGV $$");  // before it was ready, so the file is not to blame
    EXPECT_EQ(early.code, ErrorCode::io);
    EXPECT_EQ(early.reason, "the reader program " + folder_ + "/reader cannot be started (signal 11)");
}

TEST_F(BadReader, ThatHangsIsStoppedWithAllItStarted) {
    const auto begin = std::chrono::steady_clock::now();
    const Error error = read_with("/bin/sleep 60 & /bin/sleep 60", 1);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(error.code, ErrorCode::bad_data);
    EXPECT_EQ(error.reason, "the decoder did not end within 1 s");
    EXPECT_LT(took.count(), 5.0);
}

TEST_F(BadReader, ThatClosesItsPipeAndLingersIsStopped) {
    const auto begin = std::chrono::steady_clock::now();
    const Error error = read_with("exec 5>&-; exec /bin/sleep 60");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_NE(error.code, ErrorCode::cancelled);
    EXPECT_LT(took.count(), 5.0);
}

TEST_F(BadReader, ThatEndsEarlyIsOneSentence) {
    EXPECT_EQ(read_with("exit 0").reason, "the decoder ended without a result (exit status 0)");
    EXPECT_EQ(read_with("exit 4").reason, "the decoder ended without a result (exit status 4)");
    EXPECT_EQ(read_with("exit 3").code, ErrorCode::out_of_memory);  // kNoRoom
}

TEST_F(BadReader, ThatHandsOverNoiseIsNotBelieved) {
    EXPECT_EQ(read_with("/usr/bin/head -c 20000 /dev/urandom >&3").code, ErrorCode::bad_data);
    EXPECT_EQ(read_with("/usr/bin/head -c 20000 /dev/zero >&3").code, ErrorCode::bad_data);
    EXPECT_EQ(read_with("/usr/bin/head -c 10 /dev/zero >&3").code, ErrorCode::bad_data);
}

TEST_F(BadReader, ThatLiesAboutThePictureIsNotBelieved) {
    EXPECT_EQ(read_with(handing_over(sound(), 4)).reason, "it was read");  // the script itself works
    EXPECT_EQ(read_with(handing_over(sound(), 3)).code, ErrorCode::bad_data);
    ReaderHeader header = sound();
    header.width = -4;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header = sound();
    header.width = 2'000'000'000;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::unsupported);
    header = sound();
    header.width = header.height = 30'000;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header.channels = kMaxReaderChannels;  // 58 GB of bytes, 230 GB of floats
    EXPECT_EQ(read_with(handing_over(header, 4)).reason, "the decoder handed over nonsense");
    header = sound();
    header.channels = 1'000'000;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header = sound();
    header.type = static_cast<ReaderType>(77);
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header = sound();
    header.bits = 99;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header = sound();
    header.state = ReaderState::working;
    EXPECT_EQ(read_with(handing_over(header, 4)).code, ErrorCode::bad_data);
    header.state = ReaderState::refused;
    std::memset(header.reason, 7, sizeof header.reason);
    EXPECT_EQ(read_with(handing_over(header, 4)).reason, "the decoder gave no reason");
}

TEST_F(BadReader, ThatIsNotThereIsAnIoError) {
    ReadOptions options;
    options.reader = folder_ + "/none";
    const Result<Image> image = read(tiff_.make(), options);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::io);
    EXPECT_NE(image.error().reason.find("cannot be started"), std::string::npos) << image.error().reason;
}

TEST(Reader, KeepsToItsMemoryLimit) {
    TiffMaker tiff{20'000, 20'000};
    tiff.data = raw<std::uint8_t>({0});
    ReadOptions options = quick();
    options.reader_memory = std::int64_t{1} << 30;
    EXPECT_FALSE(read(tiff.make(), options));
}

TEST(Reader, FilesInMemoryGrowButDoNotShrink) {
    const Result<Descriptor> file = memory_file("test");
    ASSERT_TRUE(file);
    EXPECT_EQ(ftruncate(file.value().get(), 1000), 0);
    EXPECT_NE(ftruncate(file.value().get(), 999), 0);
}

TEST(Reader, FilesOnDiskAreReadThroughTheSandbox) {
    const std::string path = testing::TempDir() + "reader_test.ppm";
    std::ofstream(path) << "P5 2 1 255\n" << '\xff' << '\0';
    const Result<Image> image = read_image(path, quick());
    std::filesystem::remove(path);
    expect_row(image, 0, {1.0f, 0.0f});
}

TEST(Reader, TellsWhatItIs) {
    const Result<ReaderInfo> info = reader_info(quick());
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_TRUE(fs::exists(info->program));
    EXPECT_TRUE(info->openimageio.starts_with("2.")) << info->openimageio;
    EXPECT_TRUE(info->calls_filtered);
    EXPECT_EQ(info->landlock, static_cast<int>(std::max(0L, syscall(SYS_landlock_create_ruleset, nullptr, 0, 1))));
    EXPECT_EQ(info->files_restricted, info->landlock > 0);
    ReadOptions absent = quick();
    absent.reader = "/nowhere/tex-reader";
    EXPECT_EQ(reader_info(absent).error().code, ErrorCode::io);
}

TEST(Reader, FiltersSystemCallsAndRestrictsFiles) {
    const Result<std::string> program = find_reader({});
    ASSERT_TRUE(program) << program.error().message();
    FILE* pipe = popen((*program + " --version").c_str(), "r");
    char text[200] = {};
    EXPECT_GT(fread(text, 1, sizeof text - 1, pipe), 0u);
    pclose(pipe);
    EXPECT_NE(std::strstr(text, "system calls filtered"), nullptr) << text;
    const bool has_landlock = syscall(SYS_landlock_create_ruleset, nullptr, 0, 1) >= 1;
    EXPECT_NE(std::strstr(text, has_landlock ? "files restricted" : "files not restricted"), nullptr) << text;
}

}  // namespace
}  // namespace tex
