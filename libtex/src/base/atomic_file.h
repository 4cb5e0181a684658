// SPDX-License-Identifier: Apache-2.0
// atomic_file.h: files that appear whole or not at all.
//
// The bytes go to a nameless file (O_TMPFILE) in the target's directory, which is then linked into place; a target that exists already needs a
// detour, since the system has no call that links over a name: link to a temporary name, then rename. Where there are no nameless files (some network and
// FUSE file systems), the temporary has its name from the beginning.
//
// Temporary names are .NAME.tex-tmp0, 1, 2 ... beside the target. While its writer lives, it holds a lock on the file (flock). Whoever finds a
// name taken and can get its lock knows that the writer was killed, and sweeps the file; so a crash leaves at most
// one file behind, until the next write to the same target.

#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <tex/result.h>

namespace tex {

struct AtomicFileOptions {
    bool sync = true;         // fdatasync before the name appears
    bool no_clobber = false;  // an existing file is an error
};

// Writes `bytes` to `path` as write_file() (container.h) promises. Errors: io, out_of_memory.
Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes, const AtomicFileOptions& options);

}  // namespace tex
