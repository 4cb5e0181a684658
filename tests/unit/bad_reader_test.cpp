// SPDX-License-Identifier: Apache-2.0
// Reader programs that misbehave.

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <string>

#include "formats/reader/reader_process.h"
#include "scratch.h"
#include "unit/tiff_maker.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

class BadReader : public testing::Test, protected Scratch {
protected:
    void SetUp() override { tiff_.data = raw<std::uint8_t>({0, 1, 128, 255}); }
    // Reads a sound picture with a shell script as the reader.
    Error read_with(const std::string& script, int timeout = 20) {
        ReadOptions options;
        options.reader = folder_ + "/reader";
        options.reader_timeout = timeout;
        std::ofstream(options.reader) << "#!/bin/sh\n" << script << '\n';
        chmod(options.reader.c_str(), 0755);
        const Result<Image> image = tex::read(tiff_.make(), options);
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
    EXPECT_EQ(read_with(handing_over(header, 4)).reason, "the decoder returned invalid data");
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
    const Result<Image> image = tex::read(tiff_.make(), options);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::io);
    EXPECT_NE(image.error().reason.find("cannot be started"), std::string::npos) << image.error().reason;
}

}  // namespace
}  // namespace tex
