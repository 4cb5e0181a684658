// SPDX-License-Identifier: Apache-2.0
// The reader's time limit, whenever it is checked. reader_test.cpp tests the data that a reader hands over.

#include "formats/reader/reader_process.h"

#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "files/input_file.h"
#include "scratch.h"

namespace tex {
namespace {

class ReaderTime : public testing::Test, protected Scratch {
protected:
    void SetUp() override {
        ReaderHeader header;
        header.state = ReaderState::done;
        std::ofstream file(folder_ + "/header", std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof header);
    }

    // The result of finish() for this shell script, which has one second, if it is called after `wait`.
    Result<ReaderHeader> finish_after(const std::string& script, std::chrono::milliseconds wait) {
        ReadOptions options;
        options.reader = folder_ + "/reader";
        options.reader_timeout = 1;
        std::ofstream(options.reader) << "#!/bin/sh\n/bin/cat " << folder_ << "/header >&3\nprintf x >&5\n"
                                      << script << '\n';
        chmod(options.reader.c_str(), 0755);
        const Result<Descriptor> input = memory_file({});
        const Result<Descriptor> result = memory_file({});
        Result<ReaderProcess> process = ReaderProcess::start(
            {ReaderProgram::pictures, "file", "decode", "tiff", input->get(), result->get()}, options);
        if (!process) return process.error();
        std::this_thread::sleep_for(wait);
        return process->finish();
    }
};

}  // namespace

// Baking the finished rows may take long. The limit applies to the reader's own time.
TEST_F(ReaderTime, IsWhatTheReaderTakesNotWhoeverWaitsForIt) {
    const Result<ReaderHeader> header = finish_after("exit 0", std::chrono::milliseconds(1200));
    ASSERT_TRUE(header) << header.error().message();
    EXPECT_EQ(header->state, ReaderState::done);
}

TEST_F(ReaderTime, IsNotProlongedByChatter) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<ReaderHeader> header = finish_after("while :; do printf x >&5; done", std::chrono::milliseconds(900));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    ASSERT_FALSE(header);
    EXPECT_EQ(header.error().reason, "the decoder did not end within 1 s");
    EXPECT_LT(took.count(), 5.0);
}

}  // namespace tex
