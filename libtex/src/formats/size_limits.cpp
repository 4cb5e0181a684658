// SPDX-License-Identifier: Apache-2.0

#include "formats/size_limits.h"

#include <cstddef>
#include <limits>
#include <utility>

namespace tex::inline v1 {
namespace {

std::string by(std::int64_t width, std::int64_t height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

Result<Extent> claimed_extent(const std::string& path, std::int64_t width, std::int64_t height,
                              const ReadOptions& options) {
    if (width < 1 || height < 1) {
        return Error{ErrorCode::bad_data, path, "claims " + by(width, height) + " texels"};
    }
    if (width > kMaxExtent || height > kMaxExtent) {
        return Error{ErrorCode::unsupported, path,
                     by(width, height) + " texels: a side is longer than " + std::to_string(kMaxExtent)};
    }
    if (width * height > options.max_texels) {
        return Error{ErrorCode::unsupported, path,
                     by(width, height) + " texels are more than the limit of " + std::to_string(options.max_texels)};
    }
    // Where addresses have 32 bits, sizes of planes and levels would not fit std::size_t.
    constexpr double kMostOfTexel = 32.0;  // bytes: four floats, twice
    if (static_cast<double>(width * height) * kMostOfTexel >
        static_cast<double>(std::numeric_limits<std::size_t>::max())) {
        return Error{ErrorCode::out_of_memory, path, by(width, height) + " texels are more than fit memory"};
    }
    return Extent{static_cast<int>(width), static_cast<int>(height)};
}

Result<void> check_claim(const std::string& path, Extent extent, double decoded, std::int64_t size, double ratio) {
    if (decoded <= static_cast<double>(size) * ratio) return {};
    return Error{ErrorCode::bad_data, path,
                 "claims " + by(extent.width, extent.height) + " texels, more than its " + std::to_string(size) +
                     " bytes can hold"};
}

Image make_image(Extent extent, std::vector<std::string> names) {
    Image image;
    image.names = std::move(names);
    image.planes.reserve(image.names.size());
    for (std::size_t k = 0; k < image.names.size(); ++k) image.planes.emplace_back(extent);
    return image;
}

std::vector<std::string> channel_names(int channels) {
    if (channels == 1) return {"Y"};
    if (channels == 2) return {"Y", "A"};
    if (channels == 3) return {"R", "G", "B"};
    return {"R", "G", "B", "A"};
}

}  // namespace tex::inline v1
