// SPDX-License-Identifier: Apache-2.0
// reader_process.h: runs the reader program once, under a time limit, and says how it ended.

#pragma once

#include <string>

#include <tex/image_io.h>
#include <tex/result.h>

#include "base/input_file.h"
#include "containers/reader_protocol.h"

namespace tex {

// A file in memory that other processes can grow and fill, but not shorten. Errors: out_of_memory.
Result<Descriptor> memory_file(const std::string& path);

// One run of the reader: what it does, on which descriptor, and where the result goes.
struct ReaderJob {
    std::string path;  // for messages
    std::string verb;  // "decode" or "encode"
    std::string format;
    int input = -1;
    int result = -1;  // a memory_file()
};

// Runs the reader to its end. Returns its header, in which magic and state are checked and nothing else.
//
// Errors: io (cannot be started), bad_data (crash, time limit, no result), and what the reader itself reported; out_of_memory.
Result<ReaderHeader> run_reader(const ReaderJob& job, const ReadOptions& options);

}  // namespace tex
