// SPDX-License-Identifier: Apache-2.0
// green_search.h: finds the endpoints of DXT5nm's green with the least squared error of all.
//
// The search is that of bc4_search.h, with 4 entries and endpoints of 6 bits. Widened to 8 bits, neighbouring endpoints
// are 4 or 5 codes apart. Thresholds, which lie on a grid of 1/6 code, are therefore looked up one by one.

#pragma once

#include "blocks/bc1.h"
#include "kernels/clusters.h"

namespace tex::inline v1 {

void search_green_blocks(const BlockTexels* blocks, const ClusterBounds* bounds, int count, GreenEndpoints* endpoints);

}  // namespace tex::inline v1
