// SPDX-License-Identifier: Apache-2.0

#include "files/scratch_file.h"

#include <cerrno>
#include <utility>

#include "files/nameless_file.h"
#include "files/path_names.h"
#include "files/system_error.h"

namespace tex::inline v1 {
namespace {

std::string folder_of(const std::string& path) {
    const std::size_t name = name_begin(path);
    if (name == 0) return ".";
    return name == 1 ? path.substr(0, 1) : path.substr(0, name - 1);
}

}  // namespace

Result<ScratchFile> ScratchFile::open(const std::string& output) {
    Descriptor file = scratch_file(folder_of(output));
    if (!file) return system_error(output, errno);
    return ScratchFile(std::move(file), output);
}

Result<void> ScratchFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const std::ptrdiff_t count = write_some_at(file_.get(), offset, bytes.data(), bytes.size());
        if (count < 0) return system_error(output_, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        offset += static_cast<std::uint64_t>(count);
    }
    return {};
}

Result<std::vector<std::byte>> ScratchFile::read_at(std::uint64_t offset, std::size_t count) const {
    std::vector<std::byte> bytes(count);
    for (std::size_t done = 0; done < count;) {
        const std::ptrdiff_t got = read_some_at(file_.get(), offset + done, bytes.data() + done, count - done);
        if (got < 0) return system_error(output_, errno);
        if (got == 0) return Error{ErrorCode::io, output_, "a temporary file is shorter than what was written to it"};
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

}  // namespace tex::inline v1
