// SPDX-License-Identifier: Apache-2.0
// atomic_file.h: files that appear whole or not at all.
//
// The bytes go to a nameless file (O_TMPFILE) in the target's directory, which is then linked into place; a target that
// exists already needs a detour, since the system has no call that links over a name: link to a temporary name, then
// rename. Where there are no nameless files (some network and FUSE file systems), the temporary has its name from the
// beginning.
//
// Temporary names are .NAME.tex-tmp0, 1, 2 ... beside the target. While its writer lives, it holds a lock on the file
// (flock). Whoever finds a name taken and can get its lock knows that the writer was killed, and sweeps the file; so a
// crash leaves at most one file behind, until the next write to the same target. A process that ends itself leaves
// none: see unfinished_files.h.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <tex/result.h>

namespace tex {

struct AtomicFileOptions {
    bool sync = true;         // fdatasync before the name appears
    bool no_clobber = false;  // an existing file is an error
};

class AtomicFile {
public:
    // Finds the target and opens the temporary. Errors: io, out_of_memory.
    static Result<AtomicFile> open(const std::string& path, const AtomicFileOptions& options);
    AtomicFile(AtomicFile&& other) noexcept;
    ~AtomicFile();  // a file that was not committed leaves nothing behind

    // Places bytes, in any order; what is never written is 0. Any number of threads may call at once. For what is
    // written through (standard output, FIFOs, devices) bytes wait in memory until commit(). Errors: io, out_of_memory.
    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);

    // Puts the file into place. To be called once, after all writing. Errors: io, out_of_memory.
    Result<void> commit();

private:
    friend Result<void> write_atomically(const std::string&, std::span<const std::byte>, const AtomicFileOptions&);
    struct State;
    explicit AtomicFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// All at once: writes `bytes` to `path` as write_file() (container.h) promises. Errors: io, out_of_memory.
Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes,
                              const AtomicFileOptions& options);

}  // namespace tex
