// SPDX-License-Identifier: Apache-2.0

#include <dlfcn.h>
#include <link.h>

#include "formats/reader/reader_spawn.h"

namespace tex::inline v1 {

std::string own_binary() {
    Dl_info info{};
    link_map* map = nullptr;
    static const char anchor = 0;
    if (dladdr1(&anchor, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0 && map != nullptr &&
        map->l_name != nullptr && map->l_name[0] != '\0') {
        return map->l_name;
    }
    return "/proc/self/exe";
}

int close_others(posix_spawn_file_actions_t& actions, int first) {
    return posix_spawn_file_actions_addclosefrom_np(&actions, first);
}

short flags_that_close_others() { return 0; }

}  // namespace tex::inline v1
