// SPDX-License-Identifier: Apache-2.0
// statvfs.h: what libc++'s std::filesystem uses, and WASI does not have: how much room is left, and modes. These fail.
// Names without symbolic links come from realpath.c.

#ifndef TEX_STATVFS
#define TEX_STATVFS

#include <dirent.h>
#include <errno.h>
#include <sys/types.h>

struct statvfs {
    unsigned long f_frsize, f_blocks, f_bfree, f_bavail;
};

inline int absent_from_wasi() {
    errno = ENOSYS;
    return -1;
}
inline int statvfs(const char*, struct statvfs*) { return absent_from_wasi(); }
inline int fchmod(int, mode_t) { return absent_from_wasi(); }
inline int fchmodat(int, const char*, mode_t, int) { return absent_from_wasi(); }
extern "C" char* realpath(const char*, char*);

#define DT_SOCK 255  // no file is one

#endif  // TEX_STATVFS
