// SPDX-License-Identifier: Apache-2.0
// roughness_options.h: how lost variance becomes roughness: see roughness.h.

#pragma once

#include <tex/names.h>

#pragma GCC visibility push(default)
namespace tex {

enum class RoughnessModel { toksvig, vmf };

inline constexpr Named<RoughnessModel> kRoughnessModelNames[] = {
    {RoughnessModel::toksvig, "toksvig", "all of the lost variance (Toksvig 2005)"},
    {RoughnessModel::vmf, "vmf", "a quarter of it, as in The Order: 1886 (von Mises-Fisher)"},
};

}  // namespace tex
#pragma GCC visibility pop
