// SPDX-License-Identifier: Apache-2.0

#include "files/file_rights.h"

#include <unistd.h>

#include "files/file_acl.h"

namespace tex::inline v1 {

void keep_rights(int fd, int folder, const std::string& name, const struct stat& old) {
    mode_t mode = old.st_mode & 07777;
    struct stat now {};
    if (fstat(fd, &now) != 0) return;
    const bool owner_kept = now.st_uid == old.st_uid || fchown(fd, old.st_uid, static_cast<gid_t>(-1)) == 0;
    const bool group_kept = now.st_gid == old.st_gid || fchown(fd, static_cast<uid_t>(-1), old.st_gid) == 0;
    mode = keep_acl(fd, folder, name, mode, owner_kept && group_kept);
    if (!owner_kept) mode &= ~static_cast<mode_t>(S_ISUID);
    if (!group_kept) mode = (mode & ~static_cast<mode_t>(S_ISGID | S_IRWXG)) | (mode & S_IRWXO) << 3;
    static_cast<void>(fchmod(fd, mode));  // if this fails, only its writer can read the file
}

}  // namespace tex::inline v1
