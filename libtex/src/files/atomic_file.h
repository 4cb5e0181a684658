// SPDX-License-Identifier: Apache-2.0
// atomic_file.h: files that appear whole or not at all.
//
// The bytes go to a nameless file (O_TMPFILE) in the target's directory, which is then linked into place. If the target
// already exists, another step is needed, because the system has no call that links over an existing name: the file is
// linked to a temporary name, then renamed. If there are no nameless files (some network and FUSE file systems), the
// temporary file has its name from the beginning.
//
// Temporary names are .NAME.tex-tmp0, 1, 2 ... beside the target. As long as a writer lives, it holds a lock on its
// temporary file (flock). A process that finds a name taken and can get the lock knows that the writer was killed, and
// removes the file. A crash therefore leaves at most one file behind, until the next write to the same target. A
// process that ends by itself leaves none: see unfinished_files.h.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

struct WriteOptions;

// The fields mean what they mean in WriteOptions (file.h).
struct AtomicFileOptions {
    bool sync = true;
    bool no_clobber = false;
    bool follow_links = true;
    std::function<Result<void>(const std::string& path, const std::string& complete)> before_replacing = {};
    std::function<void(const std::string& path)> replaced = {};
    std::shared_ptr<std::vector<std::byte>> into = {};

    [[nodiscard]] static AtomicFileOptions of(const WriteOptions& options);
};

class AtomicFile {
public:
    // Finds the target and opens the temporary file. Errors: io, out_of_memory.
    static Result<AtomicFile> open(const std::string& path, const AtomicFileOptions& options);
    AtomicFile(AtomicFile&& other) noexcept;
    ~AtomicFile();  // unless the file was committed, nothing is left behind

    // Writes bytes at an offset, in any order; bytes that are never written are 0. Any number of threads may call this
    // at once. If the output is written directly (standard output, FIFOs, devices), the bytes wait in memory until
    // commit().
    // Errors: io, out_of_memory.
    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);

    // Puts the file into place. Call it once, after all writing. Errors: io, out_of_memory, those of
    // options.before_replacing.
    Result<void> commit();

private:
    friend Result<void> write_atomically(const std::string&, std::span<const std::byte>, const AtomicFileOptions&);
    struct State;
    explicit AtomicFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// In one step: writes `bytes` to `path` as write_file() (file.h) describes. Errors: io, out_of_memory.
Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes,
                              const AtomicFileOptions& options);

}  // namespace tex::inline v1
