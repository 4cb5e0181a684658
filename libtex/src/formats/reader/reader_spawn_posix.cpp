// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>

#include "files/input_file.h"
#include "formats/reader/reader.h"
#include "formats/reader/reader_protocol.h"

namespace tex::inline v1 {
namespace {

// The folder of the binary that contains this code: libtex, or the program that it is linked into.
std::string own_folder() {
    char resolved[PATH_MAX];
    if (realpath(own_binary().c_str(), resolved) == nullptr) return {};
    std::string folder = resolved;
    return folder.erase(folder.rfind('/'));
}

struct ProgramName {
    const char* file;
    const char* package;  // which has the program and nothing else; nullptr: a package with other programs
};

constexpr ProgramName kReader = {"tex-reader", nullptr};
constexpr ProgramName kOiioReader = {"tex-reader-oiio", "libtex-reader-oiio"};
constexpr ProgramName kMeshReader = {"tex-mesh-reader", nullptr};

const ProgramName& name_of(ReaderProgram program) {
    switch (program) {
        case ReaderProgram::pictures: break;
        case ReaderProgram::other_pictures: return kOiioReader;
        case ReaderProgram::meshes: return kMeshReader;
    }
    return kReader;
}

Error absent(const ProgramName& name) {
    const std::string file = name.file;
    if (name.package == nullptr) {
        return {ErrorCode::io,
                {},
                "the reader program " + file + " was not found beside libtex: not in " + own_folder() +
                    ", nor in ../libexec/libtex from there"};
    }
    return {ErrorCode::io,
            {},
            "files of this type are read and written by " + file + ", which is not installed: install the package " +
                name.package};
}

// Attributes and file actions for a spawned process, freed together.
class SpawnPlan {
public:
    SpawnPlan() {
        posix_spawnattr_init(&attributes);
        posix_spawn_file_actions_init(&actions);
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    posix_spawnattr_t attributes{};
    posix_spawn_file_actions_t actions{};
};

}  // namespace

Result<std::string> find_reader(const ReadOptions& options, ReaderProgram program) {
    const ProgramName& name = name_of(program);
    if (!options.reader.empty()) {
        if (program == ReaderProgram::pictures) return options.reader;
        const std::string beside = options.reader.substr(0, options.reader.rfind('/') + 1) + name.file;
        if (access(beside.c_str(), X_OK) == 0) return beside;
        return absent(name);
    }
    const std::string folder = own_folder();
    for (const char* place : {"/../libexec/libtex/", "/../../libexec/libtex/", "/"}) {
        const std::string found = folder + place + name.file;
        if (!folder.empty() && access(found.c_str(), X_OK) == 0) return found;
    }
    return absent(name);
}

int spawn_reader(const std::string& program, std::vector<std::string> arguments, std::span<const int> descriptors,
                 pid_t& child) {
    // Moves the descriptors to numbers above those that the protocol needs. fcntl() finds no number beyond the limit of
    // descriptors.
    const int free = kFirstDescriptor + static_cast<int>(descriptors.size());
    std::vector<Descriptor> from;
    for (const int descriptor : descriptors) {
        from.emplace_back(fcntl(descriptor, F_DUPFD_CLOEXEC, free));
        if (!from.back()) return errno == EINVAL ? EMFILE : errno;
    }
    SpawnPlan plan;
    int failed = 0;
    const auto check = [&failed](int status) { failed = failed != 0 ? failed : status; };
    for (int fd = 0; fd < kFirstDescriptor; ++fd) {
        check(posix_spawn_file_actions_addopen(&plan.actions, fd, "/dev/null", fd == 0 ? O_RDONLY : O_WRONLY, 0));
    }
    for (int fd = kFirstDescriptor; fd < free; ++fd) {
        const int source = from[static_cast<std::size_t>(fd - kFirstDescriptor)].get();
        check(posix_spawn_file_actions_adddup2(&plan.actions, source, fd));
    }
    check(close_others(plan.actions, free));

    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    check(posix_spawnattr_setsigmask(&plan.attributes, &none));
    check(posix_spawnattr_setsigdefault(&plan.attributes, &all));
    check(posix_spawnattr_setpgroup(&plan.attributes, 0));
    constexpr short kFlags = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP;
    check(posix_spawnattr_setflags(&plan.attributes, static_cast<short>(kFlags | flags_that_close_others())));
    if (failed != 0) return failed;

    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    char* const no_environment[] = {nullptr};
    return posix_spawn(&child, program.c_str(), &plan.actions, &plan.attributes, argv.data(), no_environment);
}

}  // namespace tex::inline v1
