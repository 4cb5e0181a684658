// SPDX-License-Identifier: Apache-2.0

#include "tree/height_traits.h"

#include <cstddef>
#include <memory>
#include <vector>

#include <tex/pipeline.h>

#include "options/heights.h"

namespace tex::cli {

HeightTraits traits_of(const std::string& path, const CheckReport& report, const ReadOptions& read) {
    if (const auto image = read_image(path, read); !image || image->ground) return {bool(image), false};
    BakeFileOptions options;
    options.read = read;
    options.heights.channel = report.height_bytes.value_or(options.heights.channel);
    options.auto_strength = true;
    options.pack.encoding = Encoding::rgb8;
    options.write.into = std::make_shared<std::vector<std::byte>>();
    const auto baked = bake_file(path, "", Container::bmp, options, {1, {}});  // without a name: into memory alone
    return {false, baked && baked->border_ratio > kWallRatio};
}

}  // namespace tex::cli
