// SPDX-License-Identifier: Apache-2.0
// integrator.h: heights from a map of normals, in texel widths, by one solution or by several.

#pragma once

#include <cstdint>

#include <tex/surface.h>
#include <tex/types.h>

#include "rows/bake_rows.h"
#include "surface/divergence.h"
#include "surface/poisson.h"

namespace tex::inline v1 {

// From heights in texel widths, whose mean is 0, to those of the field, in place. Returns the highest; the lowest is 0.
// Errors: bad_data (a height is too large for a float), out_of_memory, cancelled.
[[nodiscard]] Result<float> settle_heights(Plane<float>& heights, float larger, const Execution& execution);

class Integrator {
public:
    // `map` and `options` must outlive this object.
    Integrator(const NormalMap& map, const IntegrateOptions& options);

    // Counts the texels whose slope is unknown, and those that face away from the viewer.
    struct Count {
        std::int64_t unused = 0;
        std::int64_t behind = 0;
    };
    [[nodiscard]] Result<Count> count(const Execution& execution) const;

    // The heights times the larger bumpiness. `unused`: from count(). Adds the number of solutions to `steps`.
    [[nodiscard]] Result<Plane<float>> heights(std::int64_t unused, const Execution& execution, ProgressSpan span,
                                               int& steps) const;

private:
    [[nodiscard]] Result<void> divergence(const SlopesOf& slopes, Plane<float>& out, const Execution& execution,
                                          ProgressSpan span) const;
    [[nodiscard]] Result<void> refine(Plane<float>& heights, const Execution& execution, ProgressSpan span,
                                      int& steps) const;
    [[nodiscard]] Result<void> excess(const Plane<float>& heights, Plane<float>& p, Plane<float>& q,
                                      const Execution& execution) const;
    [[nodiscard]] bool is_exact() const;

    const NormalMap& map_;
    const IntegrateOptions& options_;
    Extent extent_;
    Gradient gradient_;
    HeightFieldHead head_;  // of heights in texel widths
    SurfaceAxis x_, y_;
    PoissonSolver solver_;
};

// Whether a map has no slopes: z is below 0 in more than one of sixteen texels, or no slope is known.
[[nodiscard]] bool is_unusable(const Integrator::Count& count, Extent extent);

}  // namespace tex::inline v1
