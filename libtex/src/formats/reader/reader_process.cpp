// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_process.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "files/nameless_file.h"
#include "files/system_error.h"
#include "formats/reader/reader.h"

namespace tex::inline v1 {
namespace {

// The reason that the reader gives, which may contain anything, as one printable line without the name that the reader
// has for the file.
std::string clean_reason(const ReaderHeader& header) {
    std::string reason(header.reason, strnlen(header.reason, sizeof header.reason));
    if (const std::size_t line = reason.find('\n'); line != std::string::npos) reason.erase(line);
    for (const char* name : {"\"/proc/self/fd/4\"", "/proc/self/fd/4", "\"\""}) {
        for (std::size_t at; (at = reason.find(name)) != std::string::npos;)
            reason.replace(at, std::strlen(name), "the file");
    }
    std::erase_if(reason, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
    while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
    return reason.empty() ? "the decoder gave no reason" : reason;
}

}  // namespace

std::string worker_of(const ReaderJob& job) { return job.verb == "encode" ? "the encoder" : "the decoder"; }

Error reported_error(const ReaderJob& job, const ReaderHeader& header) {
    ErrorCode code = ErrorCode::bad_data;
    for (const ErrorCode known : {ErrorCode::io, ErrorCode::unsupported, ErrorCode::out_of_memory}) {
        if (header.error == static_cast<std::uint32_t>(known)) code = known;
    }
    return {code, job.path, clean_reason(header)};
}

Error invalid_answer(const std::string& path) {
    return {ErrorCode::bad_data, path, "the decoder returned invalid data"};
}

bool read_exactly(int fd, std::uint64_t offset, std::byte* to, std::size_t count) {
    while (count > 0) {
        const std::ptrdiff_t n = read_some_at(fd, offset, to, count);
        if (n <= 0) return false;
        to += n;
        offset += static_cast<std::uint64_t>(n);
        count -= static_cast<std::size_t>(n);
    }
    return true;
}

Result<std::vector<std::byte>> answered_bytes(const std::string& path, int result, const ReaderHeader& header) {
    const std::optional<FileStatus> status = FileStatus::of(result);
    const auto held = status ? static_cast<std::uint64_t>(status->version.size) : 0;
    if (held < kReaderDataOffset || header.bytes > held - kReaderDataOffset) return invalid_answer(path);
    std::vector<std::byte> bytes(header.bytes);
    if (!read_exactly(result, kReaderDataOffset, bytes.data(), bytes.size())) return invalid_answer(path);
    return bytes;
}

bool write_exactly(int fd, std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const std::ptrdiff_t n = write_some_at(fd, offset, bytes.data(), bytes.size());
        if (n <= 0) return false;
        offset += static_cast<std::uint64_t>(n);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

Result<int> descriptor_of(InputFile& file, const ReadOptions& options, Descriptor& copy) {
    if (const std::optional<int> whole = file.whole_file()) return *whole;
    const Result<std::vector<std::byte>> bytes = file.read_rest(std::min(largest_file(options), options.reader_memory));
    if (!bytes) return bytes.error();
    Result<Descriptor> memory = memory_file(file.path());
    if (!memory) return memory.error();
    if (!write_exactly(memory->get(), 0, *bytes)) return system_error(file.path(), errno, "a file in memory");
    copy = std::move(*memory);
    return copy.get();
}

Result<Descriptor> memory_file(const std::string& path) {
    Descriptor file = file_in_memory();
    if (!file) return system_error(path, errno, "a file in memory");
    return file;
}

Result<ReaderHeader> run_reader(const ReaderJob& job, const ReadOptions& options) {
    Result<ReaderProcess> process = ReaderProcess::start(job, options);
    if (!process) return process.error();
    return process->finish();
}

}  // namespace tex::inline v1
