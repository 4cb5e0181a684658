// SPDX-License-Identifier: Apache-2.0
// What libtex does with the answers of its reader process: whatever that hands over, at whatever moment and however it
// ends, becomes a picture or one sentence.
//
// No process is started: the system calls that libtex makes for one are defined here, and a script plays it.
//
// Input: 12 bytes, which choose a header that is nearly sound (see Script), then steps of the process, of 4 bytes and
// more: what it does, the offset (2 bytes), a length, and for those that write that many bytes. A step is taken each
// time that libtex waits.

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "formats/reader/reader.h"
#include "formats/reader/reader_protocol.h"
#include "formats/reader/reader_rows.h"

namespace {

constexpr pid_t kChild = 0x7ffffff0;  // more than any process has

struct Script {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
    bool active = false;
    int status = 0;  // as of waitpid()
    int result = -1;
    int progress = -1;  // the end that the process would have

    bool takes(std::size_t count) const { return size >= count; }
    const std::uint8_t* take(std::size_t count) {
        const std::uint8_t* from = data;
        data += count;
        size -= count;
        return from;
    }
    void put(std::uint64_t offset, const void* bytes, std::size_t count) const {
        static_cast<void>(!pwrite(result, bytes, count, static_cast<off_t>(offset)));
    }
    // A process whose words nobody reads waits, and is killed; a script goes on.
    void say() const { static_cast<void>(!send(progress, "", 1, MSG_DONTWAIT | MSG_NOSIGNAL)); }
    void end() {
        if (progress >= 0) close(progress);
        progress = -1;
    }
};
Script script;

void begin_script(const std::uint8_t* choices) {
    tex::ReaderHeader header;
    header.width = choices[0];
    header.height = choices[1];
    header.channels = choices[2] % 8;
    header.type = static_cast<tex::ReaderType>(choices[3] % 9);
    header.bits = choices[4] % 40;
    header.rows_done = choices[5];
    header.state = static_cast<tex::ReaderState>(choices[6] % 4);
    header.error = choices[7] % 8;
    header.bytes = choices[8];
    script.status = choices[9] % 4 == 0 ? choices[10] % 65 : choices[10] << 8;  // a signal, or an exit
    script.put(0, &header, sizeof header);
}

// Takes the next step. False where there is none.
bool take_step() {
    constexpr std::size_t kStep = 4;
    if (!script.takes(kStep)) return false;
    const std::uint8_t* step = script.take(kStep);
    const std::size_t offset = std::size_t{step[1]} + 256 * std::size_t{step[2]};
    const std::size_t count = std::min<std::size_t>(step[3], script.size);
    switch ((step[0] & 0x7f) % 5) {
        case 0: script.put(offset % sizeof(tex::ReaderHeader), script.take(count), count); break;
        case 1: script.put(tex::kReaderDataOffset + offset, script.take(count), count); break;
        case 2:
            static_cast<void>(!ftruncate(script.result, static_cast<off_t>(offset * 8)));
            break;  // larger: it cannot shrink
        case 3: {
            const std::uint64_t rows = step[3];
            script.put(offsetof(tex::ReaderHeader, rows_done), &rows, sizeof rows);
            break;
        }
        default: script.end(); return true;
    }
    if ((step[0] & 0x80) == 0) script.say();
    return true;
}

}  // namespace

// Under names of their own here: headers declare some of them otherwise.
#define TEX_CALL(result, name, ...)                           \
    extern "C" result tex_##name(__VA_ARGS__) __asm__(#name); \
    extern "C" result tex_##name(__VA_ARGS__)

TEX_CALL(int, posix_spawn_file_actions_adddup2, posix_spawn_file_actions_t*, int from, int to) {
    if (to == tex::kResultDescriptor) script.result = from;
    if (to == tex::kProgressDescriptor) script.progress = from;
    return 0;
}
TEX_CALL(int, posix_spawn_file_actions_addclosefrom_np, posix_spawn_file_actions_t*, int) { return 0; }

TEX_CALL(int, posix_spawn, pid_t* child, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*,
         char* const*, char* const*) {
    script.result = fcntl(script.result, F_DUPFD_CLOEXEC, 0);
    script.progress = fcntl(script.progress, F_DUPFD_CLOEXEC, 0);
    script.active = true;
    *child = kChild;
    begin_script(script.take(12));
    return 0;
}

TEX_CALL(int, poll, pollfd* list, nfds_t count, int timeout) {
    timespec wait{timeout / 1000, timeout % 1000 * 1'000'000L};
    if (script.active) {
        while (script.progress >= 0 && syscall(SYS_ppoll, list, count, &(wait = {}), nullptr, 0L) == 0) {
            if (!take_step()) script.end();
        }
    }
    return static_cast<int>(syscall(SYS_ppoll, list, count, timeout < 0 ? nullptr : &wait, nullptr, 0L));
}

TEX_CALL(pid_t, waitpid, pid_t child, int* status, int options) {
    if (child != kChild) return static_cast<pid_t>(syscall(SYS_wait4, child, status, options, nullptr));
    while (take_step()) {  // what it still does while nobody waits
    }
    script.end();
    close(script.result);
    script.active = false;
    *status = script.status;
    return kChild;
}

namespace {

void check_error(const tex::Error& error) {
    if (error.reason.empty() || error.reason.size() > 1200) std::abort();
    for (const char c : error.reason) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) std::abort();
    }
}

void check_decoding(const tex::ReadOptions& options) {
    const char mark[] = "II*";
    const auto* bytes = reinterpret_cast<const std::byte*>(mark);
    auto file = tex::InputFile::from_memory("fuzz.tif", {bytes, bytes + sizeof mark});
    if (!file) std::abort();
    const auto image = tex::read_all(tex::open_reader_rows(*file, options));
    if (!image) return check_error(image.error());
    if (image->extent().texels() > options.max_texels || image->planes.empty() ||
        image->planes.size() != image->names.size())
        std::abort();
    for (const std::string& name : image->names) {
        if (name.empty()) std::abort();
    }
    for (const auto& plane : image->planes) {
        const bool in_range = image->sample != tex::SampleKind::floating;
        for (int j = 0; j < plane.extent().height; ++j) {
            for (int i = 0; i < plane.extent().width; ++i) {
                if (in_range && !(plane.at(i, j) >= -1.0f && plane.at(i, j) <= 1.0f)) std::abort();
            }
        }
    }
}

void check_encoding(const tex::ReadOptions& options) {
    tex::Texture texture;
    texture.format = tex::Format::rgba8_unorm;
    texture.levels.push_back({{2, 2}, std::vector<std::byte>(16)});
    tex::WriteOptions write;
    write.reader = options;
    const auto bytes = tex::encode_with_reader(texture, tex::Container::tiff, write);
    if (!bytes)
        check_error(bytes.error());
    else if (bytes->size() > 1 << 20)
        std::abort();  // more than any script makes
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kChoices = 12;
    if (size < kChoices) return 0;
    script = {};
    script.data = data;
    script.size = size;
    tex::ReadOptions options;
    options.max_texels = 1 << 14;
    options.reader = "played";
    data[11] % 4 == 0 ? check_encoding(options) : check_decoding(options);
    if (script.active || script.progress >= 0) std::abort();  // every process is waited for
    return 0;
}
