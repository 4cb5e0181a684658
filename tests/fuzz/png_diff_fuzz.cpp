// SPDX-License-Identifier: Apache-2.0
// A PNG of any bytes is read as libpng reads it: with the same texels, or refused for the same reason. A plain file is
// one that libpng reads, too, in the same way.

#include <cstdlib>

#include "fuzz/png_mutator.h"
#include "unit/png_judge.h"

namespace {

// A place for each number of rows, bits and channels, and for plain files. The library that inflates is not
// instrumented.
[[gnu::section("__libfuzzer_extra_counters")]] std::uint8_t counters[64];

void count(const tex::Verdict& verdict, bool plain) {
    std::size_t place = verdict.refused.empty() ? verdict.names.size() * 6 : 0;
    place += plain ? 1 : 0;
    place += verdict.bits == 16 ? 2 : verdict.bits == 8 ? 4 : 0;
    counters[place] = 1;
    if (verdict.extent.height > 15) counters[40 + place % 20] = 1;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    return mutate_png(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const tex::Verdict ours = tex::our_verdict(bytes);
    if (!(ours == tex::libpng_verdict(bytes))) std::abort();
    count(ours, tex::is_plain_png(bytes));
    return 0;
}
