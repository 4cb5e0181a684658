// SPDX-License-Identifier: Apache-2.0
// A plan or a report of any text is read or refused with a usage error of one line. A plan that was read is dealt, and
// its text is read again as the same plan.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "cli/usage_error.h"
#include "tree/farm_plan.h"
#include "tree/shard_report.h"

namespace {

template <class Read>
void try_reading(const Read& read) {
    try {
        read();
    } catch (const tex::cli::UsageError& error) {
        const std::string message = error.what();
        if (!message.starts_with("f.jsonl: ") || message.find('\n') != std::string::npos) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try_reading([&] {
        const tex::cli::FarmPlan plan = tex::cli::parse_farm_plan("f.jsonl", text);
        if (plan.dealt(3).size() != 3) std::abort();
        const std::string written = plan.text();
        if (tex::cli::parse_farm_plan("f.jsonl", written).text() != written) std::abort();
    });
    try_reading([&] { static_cast<void>(tex::cli::parse_shard_report("f.jsonl", text)); });
    return 0;
}
