// SPDX-License-Identifier: Apache-2.0
// picture_kind.h: what a picture holds, as a checked texture shows it.

#pragma once

#include <tex/check.h>

#include "checks/findings.h"

namespace tex::inline v1 {

// Sets CheckReport::kind and its confidence. `found` is what check_kind_rules() returned.
void set_kind(const CheckContext& context, PictureKind found, CheckReport& report);

}  // namespace tex::inline v1
