// SPDX-License-Identifier: Apache-2.0

#include "files/system_error.h"

#include <cerrno>

namespace tex::inline v1 {

Error system_error(const std::string& file, int number, const char* doing) {
    const bool exhausted = number == ENOMEM || number == EMFILE || number == ENFILE;
    std::string reason = doing;
    if (!reason.empty()) reason += ": ";
    return {exhausted ? ErrorCode::out_of_memory : ErrorCode::io, file, reason + system_reason(number),
            is_no_space(number) ? ErrorDetail::no_space : ErrorDetail::none};
}

}  // namespace tex::inline v1
