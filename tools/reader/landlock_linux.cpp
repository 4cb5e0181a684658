// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

#include "reader.h"

namespace tex::reader {
namespace {

// The structure of newer kernels. The headers of Debian 12 have only its first member.
struct Ruleset {
    std::uint64_t files = 0;
    std::uint64_t network = 0;  // from version 4 on
    std::uint64_t scopes = 0;   // from version 6 on
};

constexpr std::uint64_t kFilesOfVersion1 = (std::uint64_t{1} << 13) - 1;
constexpr std::uint64_t kMovesBetweenFolders = std::uint64_t{1} << 13;  // version 2
constexpr std::uint64_t kTruncation = std::uint64_t{1} << 14;           // version 3
constexpr std::uint64_t kControlOfDevices = std::uint64_t{1} << 15;     // version 5
constexpr std::uint64_t kTcp = 3;                                       // version 4: to bind and to connect
constexpr std::uint64_t kAbstractSockets = 1;                           // version 6
constexpr std::uint64_t kSignals = 2;                                   // version 6: to processes outside

// Creates a ruleset without a rule: it forbids everything that this kernel can restrict. Returns a descriptor, or -1.
int empty_ruleset(int version) {
    Ruleset ruleset;
    ruleset.files = kFilesOfVersion1;
    if (version >= 2) ruleset.files |= kMovesBetweenFolders;
    if (version >= 3) ruleset.files |= kTruncation;
    if (version >= 4) ruleset.network = kTcp;
    if (version >= 5) ruleset.files |= kControlOfDevices;
    if (version >= 6) ruleset.scopes = kAbstractSockets | kSignals;
    const std::size_t known = version >= 6 ? 3 : version >= 4 ? 2 : 1;
    return static_cast<int>(syscall(SYS_landlock_create_ruleset, &ruleset, known * sizeof(std::uint64_t), 0));
}

}  // namespace

int landlock_version() {
    const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0L, LANDLOCK_CREATE_RULESET_VERSION);
    return version < 1 ? 0 : static_cast<int>(version);
}

bool restrict_files() {
    const int version = landlock_version();
    if (version < 1) return false;
    const int rules = empty_ruleset(version);
    if (rules < 0) return false;
    // Decoders open their input by its name in /proc. A rule cannot name a file in memory, and such a file needs no
    // rule. `tex-reader --version` has no input.
    landlock_path_beneath_attr input{};
    input.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    input.parent_fd = kInputDescriptor;
    const bool named = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &input, 0) == 0 ||
                       errno == EBADFD || errno == EBADF;
    const bool done =
        named && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    close(rules);
    return done && open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC) < 0;
}

}  // namespace tex::reader
