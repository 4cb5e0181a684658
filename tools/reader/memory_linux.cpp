// SPDX-License-Identifier: Apache-2.0

#include <malloc.h>

#include "reader.h"

namespace tex::reader {

void settle_memory() {
#ifdef M_PERTURB
    mallopt(M_PERTURB, 0xff);  // new memory holds zeros
    mallopt(M_ARENA_MAX, 1);   // each arena takes address space
#endif
}

}  // namespace tex::reader
