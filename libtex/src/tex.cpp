// SPDX-License-Identifier: Apache-2.0

#include <tex/tex.h>

namespace tex {

const char* version() { return TEX_VERSION; }

}  // namespace tex
