// SPDX-License-Identifier: Apache-2.0

#include "base/system_error.h"

#include <cerrno>
#include <cstring>

namespace tex {

std::string system_reason(int number) {
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

Error system_error(const std::string& file, int number, const char* doing) {
    const bool exhausted = number == ENOMEM || number == EMFILE || number == ENFILE;
    std::string reason = doing;
    if (!reason.empty()) reason += ": ";
    return {exhausted ? ErrorCode::out_of_memory : ErrorCode::io, file, reason + system_reason(number)};
}

}  // namespace tex
