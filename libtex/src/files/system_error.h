// SPDX-License-Identifier: Apache-2.0
// system_error.h: what the system said, as an Error.

#pragma once

#include <cerrno>
#include <cstring>
#include <string>

#include <tex/result.h>

namespace tex {

// The message of errno value `number`, as a clause: "no such file or directory". Thread-safe, the same in every locale.
// (Here, so that the commands have it too: libtex exports what its public headers declare.)
inline std::string system_reason(int number) {
    switch (number) {  // where the system's own words puzzle
        case EISDIR: return "is a directory";
        case ENOSPC: return "no space left on the disk";
        case EROFS: return "the file system is read-only";
        case EDQUOT: return "the disk quota is used up";
        case EFBIG: return "the file would be larger than the system allows";
        case ELOOP: return "too many symbolic links, or a loop of them";
        default: break;
    }
    const char* text = strerrordesc_np(number);
    if (text == nullptr) return "system error " + std::to_string(number);
    std::string reason = text;
    // "No such file" becomes "no such file", "RFS specific error" stays.
    const auto upper = [&](std::size_t k) { return k < reason.size() && reason[k] >= 'A' && reason[k] <= 'Z'; };
    if (upper(0) && !upper(1)) reason[0] = static_cast<char>(reason[0] - 'A' + 'a');
    return reason;
}

// An Error for `file`: out_of_memory where the system ran out of memory or descriptors (ENOMEM, EMFILE, ENFILE), else
// io. `doing` comes first in the reason where it is not empty: "cannot be renamed: permission denied".
Error system_error(const std::string& file, int number, const char* doing = "");

}  // namespace tex
