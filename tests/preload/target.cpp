// SPDX-License-Identifier: Apache-2.0
// target: loaded before a command (LD_PRELOAD), lets its kernels use one instruction set alone: TEX_TARGET, as Highway
// names it ("SSE2"). A processor that does not have it ends the process with status 99.

#include <hwy/targets.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace {

[[gnu::constructor]] void choose_target() {
    const char* name = getenv("TEX_TARGET");
    if (name == nullptr) return;
    std::int64_t left = hwy::SupportedTargets();
    while (left != 0) {
        const std::int64_t target = left & -left;
        left &= left - 1;
        if (std::strcmp(hwy::TargetName(target), name) != 0) continue;
        hwy::SetSupportedTargetsForTest(target);
        return;
    }
    _exit(99);
}

}  // namespace
