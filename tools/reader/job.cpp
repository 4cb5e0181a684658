// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "reader.h"

namespace tex::reader {
namespace {

std::string in_units(std::int64_t bytes) {
    constexpr std::int64_t kMany = std::int64_t{8} << 20;
    return bytes < kMany ? std::to_string(bytes >> 10) + " KiB" : std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

void run_task(const Task& task, Work work) {
    ReaderHeader header;
    try {
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

void put_bytes(std::uint64_t offset, const void* data, std::uint64_t count) {
    if (!write_result(offset, data, count)) throw std::bad_alloc();
}

void put_header(const ReaderHeader& header) {
    if (!write_result(0, &header, sizeof header)) leave(kNoRoom);
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
