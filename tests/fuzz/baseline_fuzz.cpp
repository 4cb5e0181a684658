// SPDX-License-Identifier: Apache-2.0
// A baseline of any bytes is read or refused; what is read is written and read again as the same.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "reports/baseline.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto baseline = tex::cli::Baseline::parse("base.json", {reinterpret_cast<const char*>(data), size});
    if (!baseline) {
        if (baseline.error().code != tex::ErrorCode::bad_data || baseline.error().reason.empty()) std::abort();
        return 0;
    }
    const auto again = tex::cli::Baseline::parse("again.json", baseline->text());
    if (!again || again->text() != baseline->text()) std::abort();
    return 0;
}
