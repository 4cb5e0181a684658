// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

#include <algorithm>
#include <iterator>

#include <tex/pack.h>

#include "checks/channel_order.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr Component kNormalComponents[] = {Component::x, Component::y, Component::z};

}  // namespace

std::string layout_name(const Swizzle& swizzle) {
    const auto place = [](const Swizzle& in, Component component) {
        return std::find(in.begin(), in.end(), component) - in.begin();
    };
    for (const Named<Swizzle>& row : kSwizzleNames) {
        const bool same = std::all_of(std::begin(kNormalComponents), std::end(kNormalComponents),
                                      [&](Component c) { return place(row.value, c) == place(swizzle, c); });
        if (same) return std::string(row.name);
    }
    return to_string(swizzle);
}

Result<Swizzle> guess_swizzle(const Texture& texture, const Execution& execution) {
    return no_throw([&]() -> Result<Swizzle> {
        if (!needs_texels_for_layout(texture)) return texture.swizzle;
        const auto image = decode(texture, 0, execution);
        if (!image) return image.error();
        return layout_shown(texture, *image);
    });
}

}  // namespace tex::inline v1
