// SPDX-License-Identifier: Apache-2.0
// Without access control lists: a replacement has the mode of the file that it replaces.

#include "files/file_acl.h"

namespace tex::inline v1 {

mode_t keep_acl(int, int, const std::string&, mode_t mode, bool) { return mode; }

}  // namespace tex::inline v1
