// SPDX-License-Identifier: Apache-2.0
// file_rights.h: what a file that replaces another one takes over from it besides its name.

#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <sys/stat.h>

namespace tex {

// Gives the new file `fd` the owner, group, mode, POSIX ACL and user.* attributes of the file `name` in `folder`, whose
// status is `old`, as far as this user may; never more rights to anybody. What cannot be copied is left out: the file
// may end with fewer rights. `fd` must be readable by its writer alone until then.
void keep_rights(int fd, int folder, const std::string& name, const struct stat& old);

// The mode that gives nobody more rights than `mode` with this ACL (as Linux stores it in system.posix_acl_access),
// whose mask is in the group bits of `mode`. Everything but the owner's rights is taken away where `acl` is not
// understood.
mode_t mode_without_acl(mode_t mode, std::span<const std::byte> acl);

}  // namespace tex
