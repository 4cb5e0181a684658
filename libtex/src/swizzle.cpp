// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include <tex/pack.h>

#include "checks/channel_order.h"
#include "rows/swizzle_evidence.h"
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
        if (texture.order_open) {
            const Result<std::optional<Swizzle>> order = shown_order(texture, execution);
            if (!order) return order.error();
            return order->value_or(texture.swizzle);
        }
        if (texture.swizzle_known || format_info(texture.format).channels < 4) return texture.swizzle;
        const auto image = decode(texture, 0, execution);
        if (!image) return image.error();
        SwizzleEvidence evidence(image->extent(), texture);
        for (int j = 0; j < image->extent().height; ++j) {
            const auto row = [&](std::size_t c) { return image->planes[c].row(j); };
            evidence.add_row(j, {row(0), row(1), row(2), row(3)});
        }
        return evidence.layout();
    });
}

}  // namespace tex::inline v1
