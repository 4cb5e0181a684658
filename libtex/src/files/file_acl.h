// SPDX-License-Identifier: Apache-2.0
// file_acl.h: access control lists and attributes, which each system stores in its own way.

#pragma once

#include <string>

#include <sys/types.h>

namespace tex::inline v1 {

// Gives the new file `fd`, whose mode will be `mode`, the ACL and the user's attributes of the file `name` in `folder`,
// as far as this user may. `owners_kept`: both files have the same owner and group. Returns the mode that then gives
// nobody more rights than before.
mode_t keep_acl(int fd, int folder, const std::string& name, mode_t mode, bool owners_kept);

}  // namespace tex::inline v1
