// SPDX-License-Identifier: Apache-2.0

#include <dlfcn.h>

#include "formats/reader/reader_spawn.h"

namespace tex::inline v1 {

std::string own_binary() {
    Dl_info info{};
    static const char anchor = 0;
    return dladdr(&anchor, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
}

// All of libtex's own descriptors close themselves; macOS closes those of others, too.
int close_others(posix_spawn_file_actions_t&, int) { return 0; }

short flags_that_close_others() {
#ifdef POSIX_SPAWN_CLOEXEC_DEFAULT
    return POSIX_SPAWN_CLOEXEC_DEFAULT;
#else
    return 0;
#endif
}

}  // namespace tex::inline v1
