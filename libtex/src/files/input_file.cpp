// SPDX-License-Identifier: Apache-2.0

#include "files/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "files/system_error.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Calls `once(data, count, done)` (a read) until all `count` bytes are there, the file ends, or a call fails.
template <class Once>
Result<std::size_t> read_fully(const std::string& path, std::byte* data, std::size_t count, const Once& once) {
    std::size_t done = 0;
    while (done < count) {
        const std::ptrdiff_t n = once(data + done, count - done, done);
        if (n == 0) break;
        if (n < 0) return system_error(path, errno, "cannot be read");
        done += static_cast<std::size_t>(n);
    }
    return done;
}

Result<Descriptor> open_descriptor(const std::string& path) {
    if (path.find('\0') != std::string::npos) {
        return Error{ErrorCode::io, path, "the name holds a zero byte"};
    }
    Descriptor file = open_for_reading(path);
    if (!file) return system_error(path, errno);
    return file;
}

}  // namespace

Result<InputFile> InputFile::open(const std::string& path) {
    return no_throw([&]() -> Result<InputFile> {
        InputFile file;
        file.path_ = path;
        Result<Descriptor> fd = open_descriptor(path);
        if (!fd) return std::move(fd).error();
        file.fd_ = std::move(*fd);

        const std::optional<FileStatus> status = FileStatus::of(file.fd_.get());
        if (!status) return system_error(path, errno);
        if (status->kind == FileKind::folder) return Error{ErrorCode::io, path, "is a directory; name its files"};
        // /dev/zero has no end, and a disk is not a picture. A user who connects standard input to a terminal or
        // /dev/null does so on purpose.
        if (path != "-" && status->kind == FileKind::device && path != "/dev/stdin") {
            return Error{ErrorCode::io, path, "is a device, not a file"};
        }
        // Files of /proc and /sys are regular, but state a size of 0: their size is known only after reading.
        if (status->kind == FileKind::regular && status->version.size > 0) {
            const std::int64_t at = position_of(file.fd_.get());
            if (at >= 0) {
                file.start_ = at;
                file.size_ = std::max<std::int64_t>(0, status->version.size - at);
            }
        }
        if (Result<void> head = file.read_head(); !head) return head.error();
        return file;
    });
}

Result<void> InputFile::read_head() {
    std::byte head[kHeadBytes];
    const Result<std::size_t> got = read(head, kHeadBytes);
    if (!got) return got.error();
    if (*got == 0) return Error{ErrorCode::bad_data, path_, "is empty"};
    head_.assign(head, head + *got);
    return {};
}

Result<InputFile> InputFile::from_descriptor(const std::string& name, Descriptor fd, std::int64_t start) {
    return no_throw([&]() -> Result<InputFile> {
        InputFile file;
        file.path_ = name;
        file.fd_ = std::move(fd);
        file.start_ = start;
        const std::optional<FileStatus> status = FileStatus::of(file.fd_.get());
        if (!status || !set_position(file.fd_.get(), start)) return system_error(name, errno);
        file.size_ = std::max<std::int64_t>(0, status->version.size - start);
        if (Result<void> head = file.read_head(); !head) return head.error();
        return file;
    });
}

Result<InputFile> InputFile::from_memory(const std::string& name, std::vector<std::byte> bytes) {
    return no_throw([&]() -> Result<InputFile> {
        return from_memory(name, std::make_shared<const std::vector<std::byte>>(std::move(bytes)));
    });
}

Result<InputFile> InputFile::from_memory(const std::string& name, std::shared_ptr<const std::vector<std::byte>> bytes) {
    return no_throw([&]() -> Result<InputFile> {
        if (bytes->empty()) return Error{ErrorCode::bad_data, name, "is empty"};
        InputFile file;
        file.path_ = name;
        file.size_ = static_cast<std::int64_t>(bytes->size());
        file.head_.assign(bytes->begin(),
                          bytes->begin() + static_cast<std::ptrdiff_t>(std::min(bytes->size(), kHeadBytes)));
        file.memory_ = std::move(bytes);
        return file;
    });
}

std::optional<int> InputFile::whole_file() const {
    if (!size_ || memory_ || start_ != 0) return std::nullopt;
    return fd_.get();
}

Result<void> InputFile::settle(std::int64_t limit) {
    if (size_) return {};
    Result<std::vector<std::byte>> bytes = read_rest(limit);
    if (!bytes) return std::move(bytes).error();
    fd_.reset();
    size_ = static_cast<std::int64_t>(bytes->size());
    memory_ = std::make_shared<const std::vector<std::byte>>(std::move(*bytes));
    position_ = 0;
    return {};
}

Result<std::size_t> InputFile::read(std::byte* data, std::size_t count) {
    if (memory_) {
        Result<std::size_t> got = read_at(static_cast<std::int64_t>(position_), data, count);
        position_ += *got;
        return got;
    }
    const std::size_t known = std::min(count, head_.size() - position_);
    if (known > 0) std::memcpy(data, head_.data() + position_, known);
    position_ += known;
    Result<std::size_t> more =
        read_fully(path_, data + known, count - known,
                   [&](std::byte* at, std::size_t n, std::size_t) { return read_some(fd_.get(), at, n); });
    if (!more) return more;
    return known + *more;
}

Result<void> InputFile::rewind() {
    position_ = 0;
    const auto after_head = start_ + static_cast<std::int64_t>(head_.size());
    if (!memory_ && !set_position(fd_.get(), after_head)) return system_error(path_, errno);
    return {};
}

Result<std::size_t> InputFile::read_at(std::int64_t offset, std::byte* data, std::size_t count) const {
    if (memory_) {
        const std::size_t from = std::min(static_cast<std::size_t>(offset), memory_->size());
        const std::size_t n = std::min(count, memory_->size() - from);
        if (n > 0) std::memcpy(data, memory_->data() + from, n);
        return n;
    }
    return read_fully(path_, data, count, [&](std::byte* at, std::size_t n, std::size_t done) {
        return read_some_at(fd_.get(), static_cast<std::uint64_t>(start_ + offset) + done, at, n);
    });
}

Result<std::vector<std::byte>> InputFile::read_rest(std::int64_t limit) {
    return no_throw([&]() -> Result<std::vector<std::byte>> {
        const Error too_large{ErrorCode::unsupported, path_,
                              "larger than " + std::to_string(limit) + " bytes, the most that is read"};
        if (size_ && *size_ > limit) return too_large;
        // With room for one more byte, the end of the file is found without enlarging the buffer.
        std::vector<std::byte> bytes(size_ ? static_cast<std::size_t>(*size_) + 1 : std::size_t{1} << 16);
        std::size_t filled = 0;
        for (;;) {
            const Result<std::size_t> got = read(bytes.data() + filled, bytes.size() - filled);
            if (!got) return got.error();
            filled += *got;
            if (static_cast<std::int64_t>(filled) > limit) return too_large;
            if (filled < bytes.size()) break;
            bytes.resize(bytes.size() * 2);
        }
        bytes.resize(filled);
        return bytes;
    });
}

Result<InputFile> open_input(const std::string& path, const ReadOptions& options) {
    return options.bytes ? InputFile::from_memory(path, options.bytes) : InputFile::open(path);
}

std::int64_t largest_file(const ReadOptions& options) {
    constexpr std::int64_t kHeader = 1 << 20;
    const std::int64_t texels = std::max<std::int64_t>(options.max_texels, 0);
    if (texels > std::numeric_limits<std::int64_t>::max() / 64) return std::numeric_limits<std::int64_t>::max();
    return texels * 16 / 3 * 4 + kHeader;
}

}  // namespace tex::inline v1
