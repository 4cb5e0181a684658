// SPDX-License-Identifier: Apache-2.0
// For a module with the libraries inside (TEX_STATIC), which must run with older C libraries than that of the build.

#include <sys/random.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

// What Debian's static libstdc++ (std::random_device) and Expat take from glibc 2.36. Seen inside the module alone.
extern "C" {
[[gnu::visibility("hidden")]] void arc4random_buf(void* to, std::size_t count);
[[gnu::visibility("hidden")]] unsigned arc4random();

void arc4random_buf(void* to, std::size_t count) {
    auto* at = static_cast<unsigned char*>(to);
    while (count > 0) {
        const ssize_t got = getrandom(at, count, 0);
        if (got < 0 && errno != EINTR) std::abort();
        if (got <= 0) continue;
        at += got;
        count -= static_cast<std::size_t>(got);
    }
}

unsigned arc4random() {
    unsigned number = 0;
    arc4random_buf(&number, sizeof number);
    return number;
}
}
