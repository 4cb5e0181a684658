// SPDX-License-Identifier: Apache-2.0
// seam_evidence.h: how far the normals on both sides of UV seams are apart, in degrees.

#pragma once

#include <vector>

#include <tex/check.h>

#include "checks/mesh_seams.h"

namespace tex::inline v1 {

// The angle between two unit normals with this difference.
double seam_degrees(Vector3 gap);

// The statistics of all gaps of the samples. `extent` is that of the map.
SeamEvidence seam_evidence(const SeamSamples& samples, const std::vector<Vector3>& gaps, Extent extent);

}  // namespace tex::inline v1
