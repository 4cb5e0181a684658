// SPDX-License-Identifier: Apache-2.0
// deband_options.h: when heights regain the bits that rounding took away, and what was found: see deband.h.

#pragma once

#include <cstdint>

#include <tex/names.h>

#pragma GCC visibility push(default)
namespace tex {

enum class Deband { off, automatic, on };

inline constexpr Named<Deband> kDebandNames[] = {
    {Deband::off, "off", "heights stay as they are"},
    {Deband::automatic, "auto", "if heights lie on steps, and at least a tenth of the texels on terraces"},
    {Deband::on, "on", "if heights lie on steps"},
};

// What deband() found. A texel lies on a terrace if it has the height of both of its neighbours, along x or along y.
struct DebandReport {
    bool applied = false;             // whether heights were changed
    float step = 0.0f;                // the height of a step; 0: heights lie on no steps
    int codes = 0;                    // the number of steps from the lowest height to the highest, both counted; or 0
    std::int64_t terrace_texels = 0;  // texels on terraces; 0 if heights lie on no steps
};

}  // namespace tex
#pragma GCC visibility pop
