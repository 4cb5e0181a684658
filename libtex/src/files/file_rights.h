// SPDX-License-Identifier: Apache-2.0
// file_rights.h: what a replacement takes over from the file that it replaces, besides the name.

#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <sys/stat.h>

namespace tex::inline v1 {

// Gives the new file `fd` the owner, group, mode, POSIX ACL and user.* attributes of the file `name` in `folder`, whose
// status is `old`, as far as this user may. Nobody ever gets more rights. What cannot be copied is left out, so the
// file may end with fewer rights. Until this call, `fd` must be readable by its writer alone.
void keep_rights(int fd, int folder, const std::string& name, const struct stat& old);

// The mode without an ACL that gives nobody more rights than `mode` with this ACL (as Linux stores it in
// system.posix_acl_access). The group bits of `mode` hold the ACL's mask. If `acl` cannot be understood, all rights
// except the owner's are removed.
mode_t mode_without_acl(mode_t mode, std::span<const std::byte> acl);

}  // namespace tex::inline v1
