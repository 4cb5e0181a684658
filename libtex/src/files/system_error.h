// SPDX-License-Identifier: Apache-2.0
// system_error.h: errors of the system, as an Error.

#pragma once

#include <cerrno>
#include <cstring>
#include <string>

#include <tex/types.h>

namespace tex::inline v1 {

// What the C library says about an error. glibc has a function that is the same in every locale. (A template, so that
// the name need not exist.)
template <class Number>
const char* text_of_errno(Number number) {
    if constexpr (requires { strerrordesc_np(number); }) {
        return strerrordesc_np(number);
    } else {
        return std::strerror(number);
    }
}

// The message for errno value `number`, as a clause: "no such file or directory". Thread-safe, the same in every
// locale. (Inline, so that the commands can use it too: libtex exports only what its public headers declare.)
inline std::string system_reason(int number) {
    switch (number) {  // replaces messages of the system that are hard to understand
        case EISDIR: return "is a directory";
        case ENOSPC: return "no space left on the disk";
        case EROFS: return "the file system is read-only";
#ifdef EDQUOT
        case EDQUOT: return "the disk quota is used up";
#else  // Windows
        case EBUSY: return "another program has the file open";
#endif
        case EFBIG: return "the file would be larger than the system allows";
        case ELOOP: return "too many symbolic links, or a loop of them";
        default: break;
    }
    const char* const text = text_of_errno(number);
    if (text == nullptr) return "system error " + std::to_string(number);
    std::string reason = text;
    // "No such file" becomes "no such file", but "RFS specific error" does not change.
    const auto upper = [&](std::size_t k) { return k < reason.size() && reason[k] >= 'A' && reason[k] <= 'Z'; };
    if (upper(0) && !upper(1)) reason[0] = static_cast<char>(reason[0] - 'A' + 'a');
    return reason;
}

// Whether this error means that the disk is full (ErrorDetail::no_space).
inline bool is_no_space(int number) {
#ifdef EDQUOT
    if (number == EDQUOT) return true;
#endif
    return number == ENOSPC;
}

// An Error for `file`: out_of_memory if the system ran out of memory or descriptors (ENOMEM, EMFILE, ENFILE), otherwise
// io. If `doing` is not empty, the reason begins with it: "cannot be renamed: permission denied".
Error system_error(const std::string& file, int number, const char* doing = "");

}  // namespace tex::inline v1
