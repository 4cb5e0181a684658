// SPDX-License-Identifier: Apache-2.0

#include "reader.h"

namespace tex::reader {

void settle_memory() {}

}  // namespace tex::reader
