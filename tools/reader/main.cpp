// SPDX-License-Identifier: Apache-2.0
// tex-reader: decodes and encodes pictures with OpenImageIO for libtex, which starts it. Do not run it by hand, except
//
//     tex-reader --version      prints OpenImageIO's version, and whether the kernel supports the restriction of files
//                               and the filter of system calls

#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
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

}  // namespace

void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count) {
    if (!write_result(offset, data, count)) throw std::bad_alloc();
}

void put_header(const ReaderHeader& header) {
    if (!write_result(0, &header, sizeof header)) _exit(kNoRoom);
}

void put_progress() {
    const char strip = 0;
    if (write(kProgressDescriptor, &strip, 1) != 1) _exit(1);  // the parent has ended
}

bool refuse(ReaderHeader& header, ErrorCode code, const std::string& reason) {
    header.state = ReaderState::refused;
    header.error = static_cast<std::uint32_t>(code);
    std::strncpy(header.reason, reason.c_str(), sizeof header.reason - 1);
    put_header(header);
    return false;
}

namespace {

template <class T>
bool parse(const char* text, T& value) {
    const char* end = text + std::strlen(text);
    const auto [last, error] = std::from_chars(text, end, value);
    return error == std::errc() && last == end;
}

int version() {
    const bool restricted = restrict_files();
    const bool filtered = filter_calls();
    std::printf("OpenImageIO %s, files %s, system calls %s\n", OIIO_VERSION_STRING,
                restricted ? "restricted" : "not restricted", filtered ? "filtered" : "not filtered");
    return std::fflush(stdout) == 0 ? 0 : 1;
}

// Turns off what a decoder could use besides its input file: threads and plug-ins. (The process has no environment.)
void calm_openimageio() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("plugin_searchpath", "");
    OIIO::attribute("tiff:half", 1);
    OIIO::attribute("limits:channels", kMaxReaderChannels);
}

std::string in_units(std::int64_t bytes) {
    constexpr std::int64_t kMany = std::int64_t{8} << 20;
    return bytes < kMany ? std::to_string(bytes >> 10) + " KiB" : std::to_string(bytes >> 20) + " MiB";
}

// Refuses because of the limit of --reader-memory, or because of a lower limit that this process inherited.
void refuse_memory(ReaderHeader& header, const Task& task) {
    const std::int64_t most = memory_limit();
    refuse(header, most < task.memory ? ErrorCode::out_of_memory : ErrorCode::unsupported,
           "needs more memory than the " + in_units(std::min(most, task.memory)) + " that a decoder may have");
}

// The system also refuses a thread if there is no room for its stack, and reports the same error in both cases.
bool has_room_for_a_thread() {
    constexpr std::size_t kStack = std::size_t{9} << 20;
    void* const stack = mmap(nullptr, kStack, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) return false;
    munmap(stack, kStack);
    return true;
}

int run(const std::string_view verb, const Task& task) {
    ReaderHeader header;
    try {
        static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));  // a result that is too large is then an error of pwrite()
        limit_process(task);
        calm_openimageio();
        header.landlock = static_cast<std::uint32_t>(landlock_version());
        if (restrict_files()) header.sandboxed |= kFilesRestricted;
        if (filter_calls()) header.sandboxed |= kCallsFiltered;
        put_header(header);  // from here on, an error concerns the file
        if (verb == "describe") {
            std::strncpy(header.reason, OIIO_VERSION_STRING, sizeof header.reason - 1);
        } else if (!(verb == "decode" ? decode(task, header) : encode(task, header))) {
            return 0;
        }
        header.state = ReaderState::done;
        put_header(header);
    } catch (const std::bad_alloc&) {
        refuse_memory(header, task);
    } catch (const std::system_error& thrown) {  // the system refused threads
        if (!has_room_for_a_thread()) return refuse_memory(header, task), 0;
        refuse(header, ErrorCode::out_of_memory, std::string("the decoder gets no threads: ") + thrown.what());
    } catch (const std::exception& thrown) {
        refuse(header, ErrorCode::bad_data, thrown.what());
    }
    return 0;
}

}  // namespace
}  // namespace tex::reader

int main(int argc, char** argv) {
    using namespace tex::reader;
    const std::string_view verb = argc > 1 ? argv[1] : "";
    // The process always ends without running destructors: those of OpenImageIO's libraries take a tenth of a second,
    // and the sandbox makes no allowance for them.
    if (argc == 2 && verb == "--version") _exit(version());
    Task task;
    if (argc != 7 || (verb != "decode" && verb != "encode" && verb != "describe") || !parse(argv[3], task.max_texels) ||
        !parse(argv[4], task.memory) || !parse(argv[5], task.seconds) || !parse(argv[6], task.parent)) {
        static_cast<void>(std::fputs("tex-reader: started by libtex, not by hand\n", stderr));
        return 2;
    }
    task.format = argv[2];
    _exit(run(verb, task));
}
