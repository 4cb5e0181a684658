// SPDX-License-Identifier: Apache-2.0

#include "tree/height_traits.h"

#include <cstddef>
#include <memory>
#include <vector>

#include <tex/pipeline.h>

#include "options/heights.h"

namespace tex::cli {

HeightTraits traits_of(const std::string& path, const CheckReport& report, const ReadOptions& read) {
    BakeFileOptions options;
    options.read = read;
    options.heights.channel = report.height_bytes.value_or(options.heights.channel);
    options.auto_strength = true;
    options.pack.encoding = Encoding::rgb8;
    options.write.into = std::make_shared<std::vector<std::byte>>();
    const auto baked = bake_file(path, path, Container::bmp, options, {1, {}});
    if (!baked) return {};
    return {baked->heights.ground.has_value(), baked->border_ratio > kWallRatio};
}

}  // namespace tex::cli
