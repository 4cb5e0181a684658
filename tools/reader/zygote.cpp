// SPDX-License-Identifier: Apache-2.0
// The zygote: loads OpenImageIO once, and forks a reader for each request (reader_zygote.h in libtex says who ends
// whom). It has one thread, because a forked process has only the thread that forked: a lock that another thread held
// would stay locked in it.

#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "reader.h"

namespace tex::reader {
namespace {

// The descriptors of the protocol are taken, so that those of requests have other numbers.
constexpr int kSignals = kFirstDescriptor + 1;
constexpr int kSpare = kFirstDescriptor + 2;
static_assert(kRequestsDescriptor == kFirstDescriptor && kProgressDescriptor == kSpare);

constexpr int kParentEnded = SIGUSR1;
constexpr int kNotAlone = 4;  // exit status: this process cannot get rid of threads

struct Received {
    ReaderRequest request;
    int descriptors[kRequestDescriptors] = {-1, -1, -1, -1};  // the socket, the result, the input, the pipe
    bool is_whole = false;
};

// A process that has been forked, and the socket of its request.
struct Reader {
    pid_t process = -1;
    int socket = -1;
    bool must_end = false;
};

sigset_t signals_of_zygote() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGCHLD);
    sigaddset(&signals, kParentEnded);
    return signals;
}

// Loads what a decoder or an encoder would load first, and creates static tables.
void warm_up() {
    calm_openimageio();
    for (const char* format : {"tiff", "jpeg", "targa", "bmp", "psd", "hdr"}) {
        static_cast<void>(OIIO::ImageInput::create(format));
        static_cast<void>(OIIO::ImageOutput::create(format));
    }
}

// Ends the threads that libraries start while they are loaded. On Debian 12 that is log4cplus, which comes with
// OpenVDB, if it is loaded because there is no stand-in for it (main.cpp). This program does not link it.
void stop_threads_of_libraries() {
    using Stop = void();
    if (void* const stop = dlsym(RTLD_DEFAULT, "_ZN9log4cplus18shutdownThreadPoolEv"); stop != nullptr)
        reinterpret_cast<Stop*>(stop)();
}

// Libraries fill 30 MB of heap while they are loaded. In large pages, if the kernel has them, it is forked faster. If
// not, nothing is lost.
void enlarge_pages_of_heap() {
    constexpr int kCollapse = 25;  // MADV_COLLAPSE, from Linux 6.1 on
    constexpr std::uintptr_t kLargePage = std::uintptr_t{1} << 21;
    malloc_trim(0);
    auto* const top = static_cast<std::byte*>(sbrk(0));
    const auto top_address = reinterpret_cast<std::uintptr_t>(top);
    const std::uintptr_t end = top_address / kLargePage * kLargePage;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        if (!line.ends_with("[heap]")) continue;
        const auto begin = (std::strtoull(line.c_str(), nullptr, 16) + kLargePage - 1) / kLargePage * kLargePage;
        if (begin < end) madvise(top - (top_address - begin), end - begin, kCollapse);
    }
}

// Whether this is the only thread, after those that are about to end. Without /proc there is no answer.
bool is_alone() {
    for (int tries = 0; tries < 100; ++tries) {
        std::error_code error;
        const std::filesystem::directory_iterator threads("/proc/self/task", error);
        if (!error && std::distance(begin(threads), end(threads)) == 1) return true;
        usleep(5000);
    }
    return false;
}

// Sets up the process: descriptors, signals, the end of its parent. False if the parent has ended.
bool prepare(pid_t parent) {
    const sigset_t signals = signals_of_zygote();
    sigprocmask(SIG_BLOCK, &signals, nullptr);
    prctl(PR_SET_PDEATHSIG, kParentEnded);
    const int news = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
    const bool placed = news >= 0 && (news == kSignals || dup3(news, kSignals, O_CLOEXEC) == kSignals) &&
                        dup3(STDIN_FILENO, kSpare, O_CLOEXEC) == kSpare;
    // The folder that it was started in may be removed or unmounted while it waits.
    return placed && chdir("/") == 0 && getppid() == parent;
}

// Takes the descriptors from a message.
void take_descriptors(msghdr& message, Received& received) {
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
        if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
        const std::size_t bytes = std::min(part->cmsg_len - CMSG_LEN(0), sizeof received.descriptors);
        std::memcpy(received.descriptors, CMSG_DATA(part), bytes);
    }
}

// False if no more requests will come.
bool receive(Received& received) {
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof received.descriptors)] = {};
    iovec data{&received.request, sizeof received.request};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t n = recvmsg(kRequestsDescriptor, &message, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    if (n == 0) return false;
    take_descriptors(message, received);
    received.is_whole = n == static_cast<ssize_t>(sizeof received.request) && received.request.magic == kReaderMagic &&
                        (message.msg_flags & MSG_CTRUNC) == 0;
    return true;
}

void send_news(int socket, const ReaderNews& news) {
    static_cast<void>(send(socket, &news, sizeof news, MSG_NOSIGNAL | MSG_DONTWAIT));
}

// In the new process. It leads its own process group, as a reader does that was started from its program.
[[noreturn]] void become_reader(const Received& received, pid_t zygote) {
    setpgid(0, 0);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != zygote) _exit(1);
    ReaderNews begun;
    begun.process = getpid();
    send_news(received.descriptors[0], begun);
    const bool placed = dup2(received.descriptors[1], kResultDescriptor) >= 0 &&
                        dup2(received.descriptors[2], kInputDescriptor) >= 0 &&
                        dup2(received.descriptors[3], kProgressDescriptor) >= 0;
    if (!placed) _exit(1);
    closefrom(kProgressDescriptor + 1);  // the sockets of other readers among them
    const ReaderRequest& request = received.request;
    Task task;
    task.verb.assign(request.verb, strnlen(request.verb, sizeof request.verb));
    task.format.assign(request.format, strnlen(request.format, sizeof request.format));
    task.max_texels = request.max_texels;
    task.memory = request.memory;
    task.seconds = request.seconds;
    task.parent = zygote;
    _exit(run(task, kPictures));
}

class Zygote {
public:
    explicit Zygote(pid_t parent) : parent_(parent) {}

    // Until there is nobody to serve.
    void serve() {
        while (serve_once()) {
        }
        for (const Reader& reader : readers_) end(reader);
    }

private:
    bool serve_once() {
        std::vector<pollfd> waits = {{kRequestsDescriptor, POLLIN, 0}, {kSignals, POLLIN, 0}};
        for (const Reader& reader : readers_) {
            waits.push_back({reader.must_end ? -1 : reader.socket, POLLIN | POLLRDHUP, 0});
        }
        if (poll(waits.data(), waits.size(), -1) < 0) return errno == EINTR;
        for (std::size_t k = 0; k < readers_.size(); ++k) {
            if (waits[k + 2].revents == 0) continue;
            readers_[k].must_end = true;
            end(readers_[k]);
        }
        signalfd_siginfo info{};
        while (read(kSignals, &info, sizeof info) > 0) {
        }
        collect();
        if (getppid() != parent_) return false;
        return waits[0].revents == 0 || take_request();
    }

    bool take_request() {
        Received received;
        const bool more = receive(received);
        const int socket = received.descriptors[0];
        if (received.is_whole && received.descriptors[kRequestDescriptors - 1] >= 0) {
            readers_.reserve(readers_.size() + 1);  // before there is a process that nobody would know of
            const pid_t self = getpid();
            // Without the handlers that libraries have for fork(): they take care of the locks of other threads.
            const pid_t process = _Fork();
            if (process == 0) become_reader(received, self);
            if (process > 0) readers_.push_back({process, socket, false});
            if (process < 0) refuse(socket, errno);
        } else if (socket >= 0) {
            refuse(socket, EMFILE);
        }
        for (int k = 1; k < kRequestDescriptors; ++k) {
            if (received.descriptors[k] >= 0) close(received.descriptors[k]);
        }
        return more;
    }

    static void refuse(int socket, int error) {
        ReaderNews news;
        news.error = error;
        send_news(socket, news);
        close(socket);
    }

    static void end(const Reader& reader) {
        kill(reader.process, SIGKILL);
        kill(-reader.process, SIGKILL);  // and any process that it has started
    }

    // Reports readers that have ended, if nobody needs their ids any more.
    void collect() {
        std::erase_if(readers_, [](const Reader& reader) {
            int status = 0;
            if (!reader.must_end || waitpid(reader.process, &status, WNOHANG) != reader.process) return false;
            ReaderNews news;
            news.process = reader.process;
            news.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
            news.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
            send_news(reader.socket, news);
            close(reader.socket);
            return true;
        });
    }

    pid_t parent_;
    std::vector<Reader> readers_;
};

}  // namespace

int serve(int parent) {
    if (!prepare(parent)) return 1;
    stop_threads_of_libraries();
    warm_up();
    enlarge_pages_of_heap();
    if (!is_alone()) return kNotAlone;
    // What the kernel refuses stays allowed. The readers report what it grants to them.
    static_cast<void>(restrict_files_of_zygote());
    static_cast<void>(filter_calls_of_zygote());
    Zygote(parent).serve();
    return 0;
}

}  // namespace tex::reader
