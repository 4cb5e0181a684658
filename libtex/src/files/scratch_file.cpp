// SPDX-License-Identifier: Apache-2.0

#include "files/scratch_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "files/system_error.h"

namespace tex::inline v1 {
namespace {

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

Result<ScratchFile> ScratchFile::open(const std::string& output) {
    Descriptor file(::open(folder_of(output).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (!file) file = Descriptor(memfd_create("scratch", MFD_CLOEXEC));
    if (!file) return system_error(output, errno);
    return ScratchFile(std::move(file), output);
}

Result<void> ScratchFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return system_error(output_, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        offset += static_cast<std::uint64_t>(count);
    }
    return {};
}

Result<std::vector<std::byte>> ScratchFile::read_at(std::uint64_t offset, std::size_t count) const {
    std::vector<std::byte> bytes(count);
    for (std::size_t done = 0; done < count;) {
        const ssize_t got = pread(file_.get(), bytes.data() + done, count - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return system_error(output_, errno);
        if (got == 0) return Error{ErrorCode::io, output_, "a temporary file is shorter than what was written to it"};
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

}  // namespace tex::inline v1
