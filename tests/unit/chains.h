// SPDX-License-Identifier: Apache-2.0
// chains.h: mip chains of copies, for the tests of build_mip_chain().

#pragma once

#include <utility>

#include <tex/mip.h>

#include "unit/normal_maps.h"

namespace tex {

inline constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
inline constexpr MipDomain kDomains[] = {MipDomain::vector, MipDomain::slope};

inline MipChain chain_of(const NormalMap& base, const MipOptions& options = {}, int threads = 1) {
    return std::move(build_mip_chain(copy_of(base), options, {threads, {}}).value());
}

inline MipOptions options_of(MipFilter filter, MipDomain domain, Wrap wrap) {
    MipOptions options;
    options.filter = filter;
    options.domain = domain;
    options.wrap_x = options.wrap_y = wrap;
    return options;
}

}  // namespace tex
