// SPDX-License-Identifier: Apache-2.0
// By paths, because not every system opens files relative to an open folder. Links are looked for before, so that
// whoever may write to the folder could still put one there in between.

#include "tree/removal.h"

#include <filesystem>

#include "cli/file_status.h"
#include "files/path_names.h"
#include "tree/state.h"

namespace tex::cli {

Removal remove_output(const std::string& folder, const std::string& name, const Digest& digest, bool is_dry_run) {
    std::filesystem::path path = folder;
    const std::filesystem::path below(name);
    for (const std::filesystem::path& part : below.parent_path()) {
        path /= part;
        const auto status = status_of_link(slashed(path));
        if (!status) return Removal::missing;
        if (status->kind != FileKind::folder) return Removal::changed;
    }
    const std::string file = slashed(path / below.filename());
    const auto status = status_of_link(file);
    if (!status) return Removal::missing;
    const auto sum = status->is_regular() ? digest_of_file(file) : Result<Digest>(Error{});
    if (!sum || *sum != digest) return Removal::changed;
    return is_dry_run || remove_file(file) ? Removal::removed : Removal::failed;
}

}  // namespace tex::cli
