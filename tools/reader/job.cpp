// SPDX-License-Identifier: Apache-2.0

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "reader.h"

namespace tex::reader {
namespace {

bool write_result(std::uint64_t offset, const void* data, std::uint64_t count) {
    const auto* from = static_cast<const char*>(data);
    while (count > 0) {
        const ssize_t n = pwrite(kResultDescriptor, from, count, static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        from += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

std::string in_units(std::int64_t bytes) {
    constexpr std::int64_t kMany = std::int64_t{8} << 20;
    return bytes < kMany ? std::to_string(bytes >> 10) + " KiB" : std::to_string(bytes >> 20) + " MiB";
}

// Tells the parent that rows have arrived.
void put_progress() {
    const char strip = 0;
    if (write(kProgressDescriptor, &strip, 1) != 1) _exit(1);  // the parent has ended
}

bool parse_task(int argc, char** argv, Task& task) {
    if (argc != 7 || !parse_number(argv[3], task.max_texels) || !parse_number(argv[4], task.memory) ||
        !parse_number(argv[5], task.seconds) || !parse_number(argv[6], task.parent))
        return false;
    task.verb = argv[1];
    task.format = argv[2];
    return true;
}

int print_version(const char* version) {
    const bool restricted = restrict_files();
    const bool filtered = filter_calls();
    std::printf("%s, files %s, system calls %s\n", version, restricted ? "restricted" : "not restricted",
                filtered ? "filtered" : "not filtered");
    return std::fflush(stdout) == 0 ? 0 : 1;
}

// The system also refuses a thread if there is no room for its stack, and reports the same error in both cases.
bool has_room_for_a_thread() {
    constexpr std::size_t kStack = std::size_t{9} << 20;
    void* const stack = mmap(nullptr, kStack, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) return false;
    munmap(stack, kStack);
    return true;
}

void run(const Task& task, Work work) {
    ReaderHeader header;
    try {
        static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));  // a result that is too large is then an error of pwrite()
        limit_process(task);
        header.landlock = static_cast<std::uint32_t>(landlock_version());
        if (restrict_files()) header.sandboxed |= kFilesRestricted;
        if (filter_calls()) header.sandboxed |= kCallsFiltered;
        put_header(header);  // from here on, an error concerns the file
        if (!work(task, header)) return;
        header.state = ReaderState::done;
        put_header(header);
    } catch (const std::bad_alloc&) {
        refuse_memory(header, task);
    } catch (const std::system_error& thrown) {  // the system refused threads
        if (!has_room_for_a_thread()) return static_cast<void>(refuse_memory(header, task));
        refuse(header, ErrorCode::out_of_memory, std::string("the decoder gets no threads: ") + thrown.what());
    } catch (const std::exception& thrown) {
        refuse(header, ErrorCode::bad_data, thrown.what());
    }
}

}  // namespace

int run_program(const char* name, const char* version, int argc, char** argv, Work work) {
    if (argc == 2 && std::string_view(argv[1]) == "--version") _exit(print_version(version));
    Task task;
    if (!parse_task(argc, argv, task)) {
        static_cast<void>(std::fprintf(stderr, "%s: started by libtex, not by hand\n", name));
        return 2;
    }
    run(task, work);
    // Without destructors: those of large libraries take a tenth of a second, and need calls that are filtered.
    _exit(0);
}

bool begin_picture(const Task& task, ReaderHeader& header) {
    if (header.width < 1 || header.height < 1 || header.channels < 1)
        return refuse(header, ErrorCode::bad_data, "holds no texels");
    if (header.channels > kMaxReaderChannels)
        return refuse(header, ErrorCode::unsupported, std::to_string(header.channels) + " channels");
    if (std::int64_t{header.width} * header.height > task.max_texels) {
        return refuse(header, ErrorCode::unsupported,
                      std::to_string(header.width) + "x" + std::to_string(header.height) +
                          " texels are more than the limit of " + std::to_string(task.max_texels));
    }
    put_header(header);
    reserve_result(row_bytes(header) * static_cast<std::uint64_t>(header.height));
    return true;
}

void reserve_result(std::uint64_t bytes) {
    if (mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) == MAP_FAILED)
        throw std::bad_alloc();
}

void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count) {
    if (!write_result(offset, data, count)) throw std::bad_alloc();
}

void put_header(const ReaderHeader& header) {
    if (!write_result(0, &header, sizeof header)) _exit(kNoRoom);
}

void put_rows(ReaderHeader& header, const void* rows, int count) {
    const std::uint64_t row = row_bytes(header);
    put_bytes(kReaderDataOffset + header.rows_done * row, rows, static_cast<std::uint64_t>(count) * row);
    header.rows_done += static_cast<std::uint64_t>(count);
    put_header(header);
    put_progress();
}

bool put_file(ReaderHeader& header, const void* data, std::uint64_t bytes) {
    header.bytes = bytes;
    reserve_result(bytes);
    put_bytes(kReaderDataOffset, data, bytes);
    return true;
}

bool read_input(std::uint64_t offset, void* to, std::uint64_t count) {
    auto* at = static_cast<char*>(to);
    while (count > 0) {
        const ssize_t n = pread(kInputDescriptor, at, count, static_cast<off_t>(offset));
        if (n <= 0) return false;
        at += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::uint64_t>(n);
    }
    return true;
}

bool refuse(ReaderHeader& header, ErrorCode code, const std::string& reason) {
    header.state = ReaderState::refused;
    header.error = static_cast<std::uint32_t>(code);
    std::strncpy(header.reason, reason.c_str(), sizeof header.reason - 1);
    put_header(header);
    return false;
}

// Because of the limit of --reader-memory, or because of a lower limit that this process inherited.
bool refuse_memory(ReaderHeader& header, const Task& task) {
    const std::int64_t most = memory_limit();
    return refuse(header, most < task.memory ? ErrorCode::out_of_memory : ErrorCode::unsupported,
                  "needs more memory than the " + in_units(std::min(most, task.memory)) + " that a decoder may have");
}

}  // namespace tex::reader
