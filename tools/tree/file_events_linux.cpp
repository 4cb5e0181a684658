// SPDX-License-Identifier: Apache-2.0

#include "tree/file_events.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/system_error.h"

namespace tex::cli {
namespace {

constexpr std::uint32_t kWatched =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE | IN_ONLYDIR | IN_EXCL_UNLINK;

FileEventKind kind_of(std::uint32_t mask) {
    if ((mask & IN_ISDIR) != 0) return FileEventKind::folder;
    if ((mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0) return FileEventKind::saved;
    return (mask & IN_CREATE) != 0 ? FileEventKind::created : FileEventKind::gone;
}

}  // namespace

FileEvents::~FileEvents() {
    if (fd_ >= 0) close(fd_);
}

Result<void> FileEvents::open() {
    fd_ = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (fd_ >= 0) return {};
    if (errno == EMFILE) {
        return Error{ErrorCode::io,
                     {},
                     "too many programs of this user watch files; end one, or raise fs.inotify.max_user_instances "
                     "with sysctl"};
    }
    return Error{ErrorCode::io, {}, "cannot watch files: " + system_reason(errno)};
}

Result<bool> FileEvents::add(const std::string& folder, const std::string& name) {
    const int watch = inotify_add_watch(fd_, folder.c_str(), kWatched);
    if (watch < 0) {
        if (errno == ENOSPC) {
            return Error{ErrorCode::io, folder,
                         "the system watches no more folders for this user; raise fs.inotify.max_user_watches with "
                         "sysctl"};
        }
        if (errno == ENOMEM) return Error{ErrorCode::out_of_memory, folder, system_reason(errno)};
        return false;
    }
    std::vector<std::string>& names = new_names_[watch];
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    return true;
}

void FileEvents::end(bool complete) {
    for (auto& [watch, names] : names_) {
        if (new_names_.contains(watch)) continue;
        if (complete) {
            inotify_rm_watch(fd_, watch);
        } else {
            new_names_[watch] = std::move(names);
        }
    }
    names_ = std::move(new_names_);
    new_names_.clear();
}

bool FileEvents::wait(int milliseconds, std::vector<FileEvent>& events) const {
    pollfd ready{fd_, POLLIN, 0};
    if (poll(&ready, 1, milliseconds) <= 0) return true;
    bool all_came = true;
    alignas(inotify_event) char buffer[1 << 16];
    while (true) {
        const ssize_t count = read(fd_, buffer, sizeof buffer);
        if (count <= 0) return all_came;  // no more for now
        for (std::size_t at = 0; at < static_cast<std::size_t>(count);) {
            inotify_event event{};
            std::memcpy(&event, buffer + at, sizeof event);
            const char* const file = buffer + at + sizeof event;
            at += sizeof event + event.len;
            if ((event.mask & (IN_Q_OVERFLOW | IN_UNMOUNT)) != 0) all_came = false;
            const auto folder = names_.find(event.wd);
            if (folder == names_.end() || event.len == 0) continue;
            for (const std::string& name : folder->second) events.push_back({kind_of(event.mask), name + file});
        }
    }
}

bool is_complete(const std::string& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0) return false;
    if (S_ISLNK(status.st_mode) || status.st_nlink > 1) return true;
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0) return false;
    // The system grants a lease for reading only if nobody has the file open for writing. If somebody opens it now, the
    // holder of the lease gets a signal; this one is ignored by default.
    const bool is_free = fcntl(fd, F_SETSIG, SIGURG) == 0 && fcntl(fd, F_SETLEASE, F_RDLCK) == 0;
    if (is_free) fcntl(fd, F_SETLEASE, F_UNLCK);
    close(fd);
    return is_free;
}

}  // namespace tex::cli
