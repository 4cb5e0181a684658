// SPDX-License-Identifier: Apache-2.0

#include "cli/program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words) result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

// The commands of this build, or wrappers with their names in another folder, which run those of another machine.
std::string path_of(const std::string& program) {
    if (program.find('/') != std::string::npos) return program;
    const char* folder = std::getenv("TEX_PROGRAMS");
    return std::string(folder == nullptr ? TEX_BINARY_DIR : folder) + "/" + program;
}

}  // namespace

Background::Background(const Scratch& scratch, const std::string& program, const std::vector<std::string>& arguments,
                       const Setting& setting)
    : stdout_path_(setting.stdout_path) {
    streams_.write("in", setting.input);
    const std::string out = stdout_path_.empty() ? streams_.path("out") : stdout_path_;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, streams_.path("in").c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, streams_.path("err").c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addchdir_np(&actions, scratch.path().c_str());

    std::vector<std::string> words = {path_of(program)};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> environment = setting.environment;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string name = std::string(*variable).substr(0, std::string_view(*variable).find('=') + 1);
        const auto is_set = [&](const std::string& other) { return other.starts_with(name); };
        if (name == "OCIO=" || std::any_of(setting.environment.begin(), setting.environment.end(), is_set)) continue;
        environment.emplace_back(*variable);
    }
    const int failed = posix_spawn(&process_, words[0].c_str(), &actions, nullptr, pointers(words).data(),
                                   pointers(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("cannot start " + words[0]);
}

Background::~Background() {
    if (process_ == 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
}

std::string Background::out() const { return stdout_path_.empty() ? streams_.read("out") : std::string(); }

void Background::send(int signal) const { kill(process_, signal); }

Ran Background::wait() {
    int status = 0;
    rusage usage{};
    wait4(process_, &status, 0, &usage);
    process_ = 0;
    Ran ran;
    ran.peak_bytes = std::int64_t{usage.ru_maxrss} * 1024;
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    ran.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    ran.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    ran.out = out();
    ran.err = err();
    return ran;
}

Ran run(const Scratch& scratch, const std::string& program, const std::vector<std::string>& arguments,
        const Setting& setting) {
    Background started(scratch, program, arguments, setting);
    if (setting.signal != 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(setting.interrupt_after_ms) +
                                    std::chrono::microseconds(setting.interrupt_after_us));
        started.send(setting.signal);
    }
    return started.wait();
}

Ran shell(const Scratch& scratch, const std::string& script) {
    const char* path = std::getenv("PATH");
    Setting setting;
    setting.environment = {std::string("PATH=" TEX_BINARY_DIR ":") + (path == nullptr ? "/usr/bin:/bin" : path)};
    return run(scratch, "/bin/bash", {"-c", script}, setting);
}

bool is_installed(const std::string& program) {
    const Scratch scratch;
    return shell(scratch, "command -v " + program).code == 0;
}

std::vector<std::string> commands() {
    std::istringstream names(TEX_COMMAND_NAMES);
    return {std::istream_iterator<std::string>(names), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string without_notes(const std::string& said) {
    std::string rest;
    for (const std::string& line : lines_of(said)) {
        if (line.find("one level is written") == std::string::npos &&
            line.find("is no multiple of 4") == std::string::npos &&
            line.find("a wall along the border") == std::string::npos &&
            line.find("without --roughness-in, the material's own") == std::string::npos &&
            line.find("one level loses no variance") == std::string::npos)
            rest += line + "\n";
    }
    return rest;
}

std::string without_seconds(const std::string& json) {
    static const std::regex seconds(",\"seconds\":[-+.e0-9]+");
    return std::regex_replace(json, seconds, "");
}

}  // namespace tex::cli
