// SPDX-License-Identifier: Apache-2.0
// reader_process.h: runs a reader for one file, under a time limit, follows its rows, and says how it ended.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/reader/reader_child.h"
#include "formats/reader/reader_protocol.h"

namespace tex::inline v1 {

// A file in memory that other processes can enlarge and fill, but not shorten. Errors: out_of_memory.
Result<Descriptor> memory_file(const std::string& path);

// Read or write all the bytes at an offset; false if the file ends or the system refuses.
bool read_exactly(int fd, std::uint64_t offset, std::byte* to, std::size_t count);
bool write_exactly(int fd, std::uint64_t offset, std::span<const std::byte> bytes);

// The file as a descriptor that another process can open again. A stream is first copied to memory, which `copy` then
// owns. Errors: as InputFile::read_rest().
Result<int> descriptor_of(InputFile& file, const ReadOptions& options, Descriptor& copy);

// The bytes that a process has handed over at kReaderDataOffset. Errors: bad_data (they are not there).
Result<std::vector<std::byte>> answered_bytes(const std::string& path, int result, const ReaderHeader& header);

// "the encoder" or "the decoder", for messages.
std::string worker_of(const ReaderJob& job);

// The Error that a reader reports in its header.
Error reported_error(const ReaderJob& job, const ReaderHeader& header);

// The Error for a result that is impossible.
Error invalid_answer(const std::string& path);

class ReaderProcess {
public:
    // Errors: io (cannot be started), out_of_memory.
    static Result<ReaderProcess> start(const ReaderJob& job, const ReadOptions& options);
    ReaderProcess(ReaderProcess&& other) noexcept;
    ReaderProcess& operator=(ReaderProcess&& other) noexcept;
    ~ReaderProcess();  // ends the process

    // Waits until this number of rows is there, or until the process has ended. The returned header gives the number of
    // rows, which may be smaller. Errors: as finish().
    Result<ReaderHeader> wait_for_rows(std::uint64_t rows);

    // Waits for the process to end. Returns its header, of which only magic and state have been checked.
    //
    // Errors: bad_data (crash, time limit, no result), and what the reader itself reported; out_of_memory.
    Result<ReaderHeader> finish();

private:
    struct State;
    explicit ReaderProcess(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Runs a reader from start to end. Errors: those of start() and finish().
Result<ReaderHeader> run_reader(const ReaderJob& job, const ReadOptions& options);

}  // namespace tex::inline v1
