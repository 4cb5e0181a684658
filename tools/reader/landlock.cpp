// SPDX-License-Identifier: Apache-2.0

#include <dirent.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <vector>

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

// Creates a ruleset without a rule: it forbids everything that this kernel can restrict, except `spared`. Returns a
// descriptor, or -1.
int empty_ruleset(int version, std::uint64_t spared = 0) {
    Ruleset ruleset;
    ruleset.files = kFilesOfVersion1;
    if (version >= 2) ruleset.files |= kMovesBetweenFolders;
    if (version >= 3) ruleset.files |= kTruncation;
    if (version >= 4) ruleset.network = kTcp;
    if (version >= 5) ruleset.files |= kControlOfDevices;
    ruleset.files &= ~spared;
    if (version >= 6) ruleset.scopes = kAbstractSockets | kSignals;
    const std::size_t known = version >= 6 ? 3 : version >= 4 ? 2 : 1;
    return static_cast<int>(syscall(SYS_landlock_create_ruleset, &ruleset, known * sizeof(std::uint64_t), 0));
}

bool restrict_this_thread(int rules) {
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
}

// The input and the result of the signal handler.
struct Order {
    int rules = -1;
    bool obeyed = false;
    sem_t answered;
} order;

void obey(int /*signal*/) {
    const int error = errno;
    order.obeyed = restrict_this_thread(order.rules);
    sem_post(&order.answered);
    errno = error;
}

// The signal that glibc uses to make every thread take part in setuid(). No thread can block it, while some libraries
// block all other signals in their threads. sigaction() refuses this signal, too. So the handler is first installed for
// another signal, and the kernel's form of that action is copied.
constexpr int kOrder = 33;
constexpr int kStandIn = SIGUSR1;

class OrderHandler {
public:
    OrderHandler() {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = obey;
        action.sa_flags = SA_RESTART;
        sigfillset(&action.sa_mask);
        sound_ = sem_init(&order.answered, 0, 0) == 0 && sigaction(kStandIn, &action, &before) == 0;
        if (!sound_) return;
        KernelAction ours{};
        sound_ = kernel_action(kStandIn, nullptr, &ours) && kernel_action(kOrder, &ours, &before_);
        sigaction(kStandIn, &before, nullptr);
    }
    ~OrderHandler() {
        if (sound_) kernel_action(kOrder, &before_, nullptr);
    }
    OrderHandler(const OrderHandler&) = delete;
    OrderHandler& operator=(const OrderHandler&) = delete;
    [[nodiscard]] bool is_sound() const { return sound_; }

private:
    struct KernelAction {
        unsigned long words[8];  // larger than on any Linux
    };
    static bool kernel_action(int signal, const KernelAction* action, KernelAction* before) {
        constexpr std::size_t kMaskBytes = 8;
        return syscall(SYS_rt_sigaction, signal, action, before, kMaskBytes) == 0;
    }

    bool sound_ = false;
    KernelAction before_{};
};

// Makes a thread restrict itself. Returns true if it has done so or has ended; false if it has not done so within ten
// seconds.
bool restrict_thread(pid_t thread) {
    order.obeyed = false;
    if (syscall(SYS_tgkill, getpid(), thread, kOrder) != 0) return errno == ESRCH;
    for (int tries = 0; tries < 1000; ++tries) {  // on a busy machine a thread may wait long for a processor
        timespec until{};
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += 10'000'000;
        if (until.tv_nsec >= 1'000'000'000) ++until.tv_sec, until.tv_nsec -= 1'000'000'000;
        if (sem_timedwait(&order.answered, &until) == 0) return order.obeyed;
        if (syscall(SYS_tgkill, getpid(), thread, 0) != 0) return true;
    }
    return false;
}

// The ids of this process's threads.
std::vector<pid_t> all_threads() {
    std::vector<pid_t> threads;
    DIR* const folder = opendir("/proc/self/task");
    if (folder == nullptr) return threads;
    while (const dirent* entry = readdir(folder)) {
        if (entry->d_name[0] != '.') threads.push_back(static_cast<pid_t>(std::strtol(entry->d_name, nullptr, 10)));
    }
    closedir(folder);
    return threads;
}

// Landlock restricts the calling thread and the threads that it starts later. But libraries start threads while they
// are loaded, and an attacker in this process can make any of them open a file. Returns false if a thread cannot be
// restricted.
bool restrict_other_threads(int rules) {
    order.rules = rules;
    const OrderHandler handler;
    if (!handler.is_sound()) return false;
    const pid_t self = static_cast<pid_t>(syscall(SYS_gettid));
    std::vector<pid_t> restricted = {self};
    bool sound = true;
    bool found = false;
    do {  // repeat, because an unrestricted thread may have started another one
        const std::vector<pid_t> threads = all_threads();
        // The list may be missing (no /proc), or its ids those of another namespace of processes.
        sound = sound && std::find(threads.begin(), threads.end(), self) != threads.end();
        found = false;
        for (const pid_t thread : threads) {
            if (std::find(restricted.begin(), restricted.end(), thread) != restricted.end()) continue;
            found = true;
            restricted.push_back(thread);
            sound = sound && restrict_thread(thread);
        }
    } while (sound && found);
    return sound;
}

// ThreadSanitizer has a thread that accepts no signals.
#if defined(__SANITIZE_THREAD__)
#define TEX_READER_ONE_THREAD 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TEX_READER_ONE_THREAD 1
#endif
#endif
#ifdef TEX_READER_ONE_THREAD
constexpr bool kRestrictsAll = false;
#else
constexpr bool kRestrictsAll = true;
#endif

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
    const bool others = !kRestrictsAll || (named && restrict_other_threads(rules));
    const bool done = named && restrict_this_thread(rules);
    close(rules);
    return done && others && open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC) < 0;
}

// The children look at the list of their threads.
bool restrict_files_of_zygote() {
    const int version = landlock_version();
    if (version < 1) return false;
    const int rules = empty_ruleset(version, LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR);
    if (rules < 0) return false;
    const bool done = restrict_this_thread(rules);
    close(rules);
    return done;
}

}  // namespace tex::reader
