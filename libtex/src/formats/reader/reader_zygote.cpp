// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_zygote.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "formats/reader/reader_spawn.h"

namespace tex {
namespace {

struct Sockets {
    Descriptor ours, theirs;
};

std::optional<Sockets> socket_pair() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return std::nullopt;
    return Sockets{Descriptor(ends[0]), Descriptor(ends[1])};
}

class Zygote {
public:
    // nullptr if it cannot be started.
    static std::shared_ptr<Zygote> start(const std::string& program) {
        std::optional<Sockets> sockets = socket_pair();
        if (!sockets) return nullptr;
        auto zygote = std::make_shared<Zygote>();
        const int descriptors[] = {sockets->theirs.get()};
        if (spawn_reader(program, {"zygote", std::to_string(getpid())}, descriptors, zygote->id_) != 0) return nullptr;
        zygote->program_ = program;
        zygote->owner_ = getpid();
        zygote->requests_ = std::move(sockets->ours);
        return zygote;
    }
    Zygote() = default;
    Zygote(const Zygote&) = delete;
    Zygote& operator=(const Zygote&) = delete;
    ~Zygote() {
        if (id_ <= 0 || !is_ours()) return;
        kill(id_, SIGKILL);
        while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    [[nodiscard]] pid_t id() const { return id_; }
    // A forked copy of this process must not use its parent's.
    [[nodiscard]] bool is_ours() const { return owner_ == getpid(); }
    [[nodiscard]] bool runs(const std::string& program) const { return program_ == program; }
    // Never waits. Returns 0 or an errno.
    [[nodiscard]] int send(const ReaderRequest& request, const int (&descriptors)[kRequestDescriptors]) const;

private:
    std::string program_;
    pid_t owner_ = -1;
    pid_t id_ = -1;
    Descriptor requests_;
};

int Zygote::send(const ReaderRequest& request, const int (&descriptors)[kRequestDescriptors]) const {
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof descriptors)] = {};
    iovec data{const_cast<ReaderRequest*>(&request), sizeof request};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof descriptors);
    std::memcpy(CMSG_DATA(rights), descriptors, sizeof descriptors);
    for (;;) {
        if (sendmsg(requests_.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0) return 0;
        if (errno != EINTR) return errno;
    }
}

// The zygote of this process.
class Keeper {
public:
    // The zygote for one more job; nullptr if the program has to be started for it.
    std::shared_ptr<Zygote> zygote(const std::string& program) {
        const std::lock_guard lock(mutex_);
        if (zygote_ && zygote_->is_ours() && zygote_->runs(program)) return zygote_;
        zygote_.reset();
        if (vain_starts_ >= kMostVainStarts) return nullptr;
        ++vain_starts_;
        zygote_ = Zygote::start(program);
        return zygote_;
    }
    [[nodiscard]] bool is_first_job() {
        const std::lock_guard lock(mutex_);
        return !std::exchange(has_had_jobs_, true);
    }
    void has_forked() {
        const std::lock_guard lock(mutex_);
        vain_starts_ = 0;
    }
    // The zygote does not answer. It ends with the last of its children.
    void give_up(const std::shared_ptr<Zygote>& zygote) {
        const std::lock_guard lock(mutex_);
        if (zygote_ == zygote) zygote_.reset();
    }
    pid_t id() {
        const std::lock_guard lock(mutex_);
        return zygote_ && zygote_->is_ours() ? zygote_->id() : -1;
    }

private:
    static constexpr int kMostVainStarts = 2;
    std::mutex mutex_;
    std::shared_ptr<Zygote> zygote_;
    int vain_starts_ = 0;  // since a zygote has last forked
    bool has_had_jobs_ = false;
};

// Never destroyed: threads may still read when the process ends. The zygote then notices it.
Keeper& keeper() {
    static Keeper& only = *new Keeper;
    return only;
}

std::optional<ReaderRequest> request_for(const ReaderJob& job, const ReaderLimits& limits) {
    ReaderRequest request;
    if (job.verb.size() >= sizeof request.verb || job.format.size() >= sizeof request.format) return std::nullopt;
    request.seconds = limits.seconds;
    request.max_texels = limits.max_texels;
    request.memory = limits.memory;
    job.verb.copy(request.verb, sizeof request.verb - 1);
    job.format.copy(request.format, sizeof request.format - 1);
    return request;
}

}  // namespace

ReaderChild fork_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits) {
    const std::optional<ReaderRequest> request = request_for(job, limits);
    if (!request || job.verb == "describe" || keeper().is_first_job()) return {};
    for (int tries = 0; tries < 2; ++tries) {
        std::shared_ptr<Zygote> zygote = keeper().zygote(program);
        std::optional<Sockets> sockets = zygote ? socket_pair() : std::nullopt;
        if (!sockets) return {};
        const int failed = zygote->send(*request, {sockets->theirs.get(), job.result, job.input, progress});
        if (failed != 0 && failed != EPIPE && failed != ECONNRESET) return {};
        sockets->theirs.reset();
        ReaderNews news;
        if (failed == 0 && receive_news(sockets->ours.get(), news, limits.deadline)) {
            if (news.error != 0 || news.process <= 0) return {};
            keeper().has_forked();
            return {news.process, std::move(sockets->ours), std::move(zygote)};
        }
        keeper().give_up(zygote);
        if (ReaderClock::now() >= limits.deadline) return {};
    }
    return {};
}

pid_t zygote_id() { return keeper().id(); }

}  // namespace tex
