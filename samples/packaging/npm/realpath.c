// SPDX-License-Identifier: Apache-2.0
// realpath.c: which wasi-libc does not have. Folders are followed one by one, so that "link/.." is what Linux means.

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { kMostLinks = 40 };  // Linux's limit

// Puts `name` and "/" and `rest` into `to`, which has PATH_MAX bytes. Returns false if they are too long.
static int join(char* to, const char* name, const char* rest) {
    char joined[PATH_MAX];
    const size_t length = strlen(name);
    if (length + 1 + strlen(rest) >= PATH_MAX) return errno = ENAMETOOLONG, 0;
    memcpy(joined, name, length);
    joined[length] = '/';
    strcpy(joined + length + 1, rest);
    strcpy(to, joined);
    return 1;
}

char* realpath(const char* path, char* resolved) {
    char done[PATH_MAX] = "", left[PATH_MAX], link[PATH_MAX], folder[PATH_MAX];
    int links = 0;
    if (*path == '\0') return errno = ENOENT, NULL;
    if (*path == '/' ? strlen(path) >= PATH_MAX : getcwd(folder, sizeof folder) == NULL) return NULL;
    if (*path == '/') {
        strcpy(left, path);
    } else if (!join(left, folder, path)) {
        return NULL;
    }
    while (*left != '\0') {
        const size_t skipped = strspn(left, "/"), length = strcspn(left + skipped, "/");
        char name[PATH_MAX], next[PATH_MAX];
        memcpy(name, left + skipped, length);
        name[length] = '\0';
        memmove(left, left + skipped + length, strlen(left + skipped + length) + 1);
        if (length == 0 || strcmp(name, ".") == 0) continue;
        if (strcmp(name, "..") == 0) {
            char* const slash = strrchr(done, '/');
            if (slash != NULL) *slash = '\0';
            continue;
        }
        strcpy(next, done);
        if (!join(next, next, name)) return NULL;
        const ssize_t n = readlink(next, link, sizeof link - 1);
        if (n < 0 && errno != EINVAL) return NULL;
        if (n < 0) {  // no link
            strcpy(done, next);
            continue;
        }
        if (++links > kMostLinks) return errno = ELOOP, NULL;
        link[n] = '\0';
        if (!join(left, link, left)) return NULL;
        if (link[0] == '/') done[0] = '\0';
    }
    const char* const result = *done == '\0' ? "/" : done;
    return resolved == NULL ? strdup(result) : strcpy(resolved, result);
}
