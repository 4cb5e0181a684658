// SPDX-License-Identifier: Apache-2.0
// kind_rules.h: the rules that say what a picture holds, if it is not normals in tangent space: N210, N213, N214, N216,
// N220 to N223.

#pragma once

#include <optional>

#include <tex/height.h>

#include "checks/findings.h"

namespace tex::inline v1 {

struct FoundKind {
    PictureKind kind = PictureKind::normals;
    std::optional<HeightChannel> height_bytes = {};  // CheckReport::height_bytes
};
FoundKind check_kind_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
