// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_child.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "formats/reader/reader_spawn.h"

namespace tex {
namespace {

// The zygote answers at once. If it does not, someone has stopped it.
constexpr std::chrono::seconds kPatience(30);

Ending collect(pid_t child) {
    kill(-child, SIGKILL);  // no effect on a process that has ended; ends a process that only closed its pipe
    int status = 0;
    pid_t got = -1;
    do {
        got = waitpid(child, &status, 0);
    } while (got < 0 && errno == EINTR);
    if (got != child) return {};
    return {WIFSIGNALED(status) ? WTERMSIG(status) : 0, WIFEXITED(status) ? WEXITSTATUS(status) : 0};
}

}  // namespace

ReaderChild::ReaderChild(ReaderChild&& other) noexcept
    : id_(std::exchange(other.id_, -1)), news_(std::move(other.news_)), zygote_(std::move(other.zygote_)) {}

ReaderChild& ReaderChild::operator=(ReaderChild&& other) noexcept {
    if (this != &other) {
        end();
        id_ = std::exchange(other.id_, -1);
        news_ = std::move(other.news_);
        zygote_ = std::move(other.zygote_);
    }
    return *this;
}

ReaderChild::~ReaderChild() { end(); }

Ending ReaderChild::end() {
    const pid_t id = std::exchange(id_, -1);
    if (id <= 0) return {};
    if (!news_) return collect(id);
    // Only its parent may signal the process: it knows whether the id is still that of the process.
    const Descriptor socket = std::move(news_);
    const std::shared_ptr<const void> zygote = std::move(zygote_);
    shutdown(socket.get(), SHUT_WR);
    ReaderNews news;
    Ending ending;
    ending.is_unknown = !receive_news(socket.get(), news, ReaderClock::now() + kPatience);
    if (!ending.is_unknown) ending = {news.signal, news.status};
    return ending;
}

int start_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits,
                 ReaderChild& child) {
    const int descriptors[] = {job.result, job.input, progress};
    pid_t id = -1;
    const int failed =
        spawn_reader(program,
                     {job.verb, job.format, std::to_string(limits.max_texels), std::to_string(limits.memory),
                      std::to_string(limits.seconds), std::to_string(getpid())},
                     descriptors, id);
    if (failed == 0) child = ReaderChild(id);
    return failed;
}

bool receive_news(int socket, ReaderNews& news, ReaderClock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - ReaderClock::now()).count();
        if (left <= 0) return false;
        pollfd poll_for{socket, POLLIN, 0};
        const int ready = poll(&poll_for, 1, static_cast<int>(std::min<long long>(left + 1, 60'000)));
        if (ready < 0 && errno != EINTR) return false;
        if (ready <= 0) continue;
        const ssize_t n = recv(socket, &news, sizeof news, MSG_DONTWAIT);
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        return n == static_cast<ssize_t>(sizeof news) && news.magic == kReaderMagic;
    }
}

}  // namespace tex
