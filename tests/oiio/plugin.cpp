// SPDX-License-Identifier: Apache-2.0

#include "oiio/plugin.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tex::oiio {
namespace {

const std::string kFolder = TEX_BINARY_DIR "/oiio";

}  // namespace

std::unique_ptr<OIIO::ImageInput> new_input() {
    OIIO::attribute("plugin_searchpath", kFolder);
    return OIIO::ImageInput::create("tex");
}

std::unique_ptr<OIIO::ImageOutput> new_output() {
    OIIO::attribute("plugin_searchpath", kFolder);
    return OIIO::ImageOutput::create("tex");
}

cli::Ran shell(const Scratch& scratch, const std::string& script) {
    return cli::shell(scratch, "export OIIO_LIBRARY_PATH='" + kFolder + "'\n" + script);
}

MipChain bumpy_chain(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float x = 0.5f * std::sin(0.3f * static_cast<float>(i) + 0.1f * static_cast<float>(j));
            const float y = 0.4f * std::cos(0.2f * static_cast<float>(j) - 0.05f * static_cast<float>(i));
            map.x.at(i, j) = x;
            map.y.at(i, j) = y;
            map.z.at(i, j) = reconstruct_z(x, y);
        }
    }
    auto chain = build_mip_chain(std::move(map));
    EXPECT_TRUE(chain);
    return std::move(*chain);
}

std::vector<float> pixels_of(OIIO::ImageInput& input, int level) {
    const OIIO::ImageSpec spec = input.spec(0, level);
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    if (pixels.empty() || !input.read_image(0, level, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
        return {};
    return pixels;
}

}  // namespace tex::oiio
