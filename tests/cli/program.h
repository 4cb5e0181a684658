// SPDX-License-Identifier: Apache-2.0
// program.h: runs the real commands in scratch folders and keeps what they print.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scratch.h"

namespace tex::cli {

struct Ran {
    int code = -1;  // as a shell sees it: 128 + n after signal n
    std::string out;
    std::string err;
    std::int64_t peak_bytes = 0;  // resident; the largest of the program and its waited-for children
    double cpu_seconds = 0.0;     // of all of them, user and system
};

struct Setting {
    std::string input;                     // standard input
    std::vector<std::string> environment;  // "NAME=value", besides the test's own
    std::string stdout_path;               // file for standard output, instead of Ran::out
    int interrupt_after_ms = 0;            // send `signal` after so long, and so many microseconds
    int interrupt_after_us = 0;
    int signal = 0;
};

// A program that runs while the test goes on, in the scratch folder. It is killed together with its object.
class Background {
public:
    // `program` is a command of the build, or a path.
    Background(const Scratch& scratch, const std::string& program, const std::vector<std::string>& arguments,
               const Setting& setting = {});
    ~Background();
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    // What it has printed so far.
    [[nodiscard]] std::string out() const;
    [[nodiscard]] std::string err() const { return streams_.read("err"); }

    void send(int signal) const;
    // Waits until it ends. To be called once.
    [[nodiscard]] Ran wait();

private:
    const Scratch streams_;
    const std::string stdout_path_;
    int process_ = 0;
};

// Runs `program` (a command of the build, or a path) with these arguments, in the scratch folder.
Ran run(const Scratch& scratch, const std::string& program, const std::vector<std::string>& arguments,
        const Setting& setting = {});

// Runs a line through a shell; the commands of the build are in its PATH.
Ran shell(const Scratch& scratch, const std::string& script);

[[nodiscard]] bool is_installed(const std::string& program);

// The commands in this build.
[[nodiscard]] std::vector<std::string> commands();

[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

// What was said, without the warnings of an output that lacks what nobody asked about: smaller levels, whole blocks.
[[nodiscard]] std::string without_notes(const std::string& said);

// JSON lines without their times, which differ from run to run.
[[nodiscard]] std::string without_seconds(const std::string& json);

}  // namespace tex::cli
