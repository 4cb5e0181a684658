// SPDX-License-Identifier: Apache-2.0
// pending_file.h: what the system does for an AtomicFile: a file beside its target, without a name or with a temporary
// one, until it takes the target's place.

#pragma once

#include <memory>
#include <string>

#include <tex/types.h>

namespace tex::inline v1 {

struct AtomicFileOptions;

class PendingFile {
public:
    // Finds the target and opens the file. Errors: io.
    static Result<PendingFile> open(const std::string& path, const AtomicFileOptions& options);
    PendingFile(PendingFile&& other) noexcept;
    ~PendingFile();  // unless the file was put into place, nothing is left behind

    [[nodiscard]] int descriptor() const;
    // Gives the file the rights of the one that it replaces and, with `sync`, waits until its bytes are on the disk.
    // Errors: io.
    Result<void> settle(bool sync);
    // A path under which the bytes can be read.
    [[nodiscard]] std::string complete_path() const;
    // Once, after settle(). Errors: io.
    Result<void> put_into_place(bool no_clobber);

private:
    struct State;
    explicit PendingFile(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace tex::inline v1
