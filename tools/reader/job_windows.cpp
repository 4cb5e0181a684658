// SPDX-License-Identifier: Apache-2.0
// Decoders in the process of their caller: what they share is kept for each thread.

#include <cstddef>
#include <limits>
#include <new>

#include "files/descriptor.h"
#include "formats/reader/reader_here.h"
#include "here_windows.h"

namespace tex::reader {
namespace {

struct Left {};  // thrown by leave()

thread_local Here* this_job = nullptr;

}  // namespace

Here& here() { return *this_job; }

bool write_result(std::uint64_t offset, const void* data, std::uint64_t count) {
    const auto* from = static_cast<const std::byte*>(data);
    while (count > 0) {
        const std::ptrdiff_t n = write_some_at(here().result, offset, from, count);
        if (n <= 0) return false;
        from += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

void put_progress() { (*here().progress)(); }

bool has_room_for_a_thread() { return true; }

void leave(int) { throw Left(); }

// The result is in a file, but counts as memory.
void reserve_result(std::uint64_t bytes) {
    const auto most = static_cast<std::uint64_t>(here().memory);
    if (bytes > most || here().reserved > most - bytes) throw std::bad_alloc();
    here().reserved += bytes;
}

bool Here::read(std::uint64_t offset, void* to, std::uint64_t count) const {
    auto* at = static_cast<std::byte*>(to);
    while (count > 0) {
        const std::ptrdiff_t n = read_some_at(input, offset, at, count);
        if (n <= 0) return false;
        at += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

std::uint64_t Here::size() const {
    const auto status = FileStatus::of(input);
    return status ? static_cast<std::uint64_t>(status->version.size) : 0;
}

bool read_input(std::uint64_t offset, void* to, std::uint64_t count) { return here().read(offset, to, count); }

void limit_process(const Task&) {}
std::int64_t memory_limit() { return std::numeric_limits<std::int64_t>::max(); }
int landlock_version() { return 0; }
bool restrict_files() { return false; }
bool filter_calls() { return false; }

}  // namespace tex::reader

namespace tex::inline v1 {

bool read_here(const ReaderJob& job, const ReaderLimits& limits, const std::function<void()>& progress) {
    reader::Here here{job.input, job.result, limits.memory, &progress};
    reader::this_job = &here;
    bool sound = true;
    try {
        reader::Task task{job.verb, job.format, limits.max_texels, limits.memory, limits.seconds, 0};
        reader::run_task(task, reader::read_or_write);
    } catch (const reader::Left&) {  // after a refusal
    } catch (...) {
        sound = false;
    }
    reader::this_job = nullptr;
    return sound;
}

}  // namespace tex::inline v1
