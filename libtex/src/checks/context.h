// SPDX-License-Identifier: Apache-2.0
// context.h: measures what the rules of a check examine.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Decodes the base level of context.texture and fills the members of the context that follow from it.
// Errors: cancelled, out_of_memory.
Result<void> measure(CheckContext& context);

// Whether no rule judges the lengths of vectors: the options say so, or the format is one whose encoders look at
// directions alone, as BC7 here.
bool has_free_lengths(const CheckContext& context);

// True if a channel varies that holds no component and is no copy of one.
bool has_more_data(const Stored& stored, const TexelCounts& counts);

}  // namespace tex::inline v1
