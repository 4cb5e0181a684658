// SPDX-License-Identifier: Apache-2.0
// process.h: runs programs and measures them, for benchmarks of whole processes.

#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace bench {

struct Measured {
    double wall = 0.0;  // seconds
    double user = 0.0;
    double system = 0.0;
    double memory = 0.0;  // MB, the peak of the largest process
};

// Runs a program to its end. If the program fails, the benchmark ends.
inline Measured run(const std::vector<std::string>& command) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const auto begin = std::chrono::steady_clock::now();
    pid_t child = -1;
    int status = -1;
    rusage usage{};
    if (posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ) == 0) wait4(child, &status, 0, &usage);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    posix_spawn_file_actions_destroy(&actions);
    if (status != 0) {
        std::string line;
        for (const std::string& word : command) line += word + " ";
        std::fprintf(stderr, "failed: %s\n", line.c_str());
        std::exit(1);
    }
    const auto seconds = [](timeval t) {
        return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
    };
    return {wall.count(), seconds(usage.ru_utime), seconds(usage.ru_stime),
            static_cast<double>(usage.ru_maxrss) / 1024.0};
}

inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The median of each figure separately.
inline Measured median_of(const std::vector<Measured>& runs) {
    const auto of = [&](double Measured::*figure) {
        std::vector<double> values;
        for (const Measured& run : runs) values.push_back(run.*figure);
        return median(std::move(values));
    };
    return {of(&Measured::wall), of(&Measured::user), of(&Measured::system), of(&Measured::memory)};
}

// Runs body() in its own process. Otherwise its memory would also count as memory of all programs started later.
// Returns false if it failed.
template <class Body>
bool run_apart(const Body& body) {
    const pid_t child = fork();
    if (child == 0) {
        body();
        _exit(0);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace bench
