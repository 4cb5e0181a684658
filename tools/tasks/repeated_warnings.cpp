// SPDX-License-Identifier: Apache-2.0

#include "tasks/repeated_warnings.h"

#include <fmt/format.h>

namespace tex::cli {

void RepeatedWarnings::print(Console& console) const {
    for (const auto& [sentence, files] : files_) {
        const std::string more = files.count > 1 ? fmt::format(" and {} more", files.count - 1) : std::string();
        console.warning(fmt::format("{}{}: {}", files.first, more, sentence));
    }
}

}  // namespace tex::cli
