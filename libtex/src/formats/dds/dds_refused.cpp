// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/dds_refused.h"

#include <algorithm>
#include <iterator>

#include "formats/bytes.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

// Texconv of Microsoft's DirectXTex reads all of these.
std::string refused(const std::string& what, const char* target) {
    return what + " is not supported; \"texconv -f " + target + "\" converts it";
}

constexpr const char* kBytes = "R8G8B8A8_UNORM";
constexpr const char* kSigned = "R8G8_SNORM";
constexpr const char* kHalves = "R16G16B16A16_FLOAT";

struct RefusedDxgi {
    std::uint32_t dxgi;
    const char* name;
    const char* target;
};

constexpr RefusedDxgi kRefusedDxgi[] = {
    {3, "R32G32B32A32_UINT", kHalves},
    {4, "R32G32B32A32_SINT", kHalves},
    {7, "R32G32B32_UINT", kHalves},
    {8, "R32G32B32_SINT", kHalves},
    {12, "R16G16B16A16_UINT", kHalves},
    {14, "R16G16B16A16_SINT", kHalves},
    {17, "R32G32_UINT", kHalves},
    {18, "R32G32_SINT", kHalves},
    {25, "R10G10B10A2_UINT", kHalves},
    {26, "R11G11B10_FLOAT", kHalves},
    {30, "R8G8B8A8_UINT", kBytes},
    {32, "R8G8B8A8_SINT", kBytes},
    {36, "R16G16_UINT", kHalves},
    {38, "R16G16_SINT", kHalves},
    {40, "D32_FLOAT", kHalves},
    {42, "R32_UINT", kHalves},
    {43, "R32_SINT", kHalves},
    {50, "R8G8_UINT", kBytes},
    {52, "R8G8_SINT", kBytes},
    {55, "D16_UNORM", kHalves},
    {57, "R16_UINT", kHalves},
    {59, "R16_SINT", kHalves},
    {62, "R8_UINT", kBytes},
    {64, "R8_SINT", kBytes},
    {66, "R1_UNORM", kBytes},
    {67, "R9G9B9E5_SHAREDEXP", kHalves},
    {68, "R8G8_B8G8_UNORM", kBytes},
    {69, "G8R8_G8B8_UNORM", kBytes},
    {89, "R10G10B10_XR_BIAS_A2_UNORM", kHalves},
    {100, "AYUV", kBytes},
    {101, "Y410", kHalves},
    {102, "Y416", kHalves},
    {103, "NV12", kBytes},
    {104, "P010", kHalves},
    {105, "P016", kHalves},
    {107, "YUY2", kBytes},
    {108, "Y210", kHalves},
    {109, "Y216", kHalves},
    {110, "NV11", kBytes},
    {111, "AI44", kBytes},
    {112, "IA44", kBytes},
    {113, "P8", kBytes},
    {114, "A8P8", kBytes},
};

struct RefusedCode {
    std::uint32_t code;
    const char* what;
};

constexpr RefusedCode kRefusedCodes[] = {
    {fourcc("RGBG"), "the pixel format RGBG, in which two texels share red and blue,"},
    {fourcc("GRGB"), "the pixel format GRGB, in which two texels share red and blue,"},
    {fourcc("UYVY"), "the pixel format UYVY, in which two texels share their colour,"},
    {fourcc("YUY2"), "the pixel format YUY2, in which two texels share their colour,"},
};

constexpr std::uint32_t kDdpfBumpLuminance = 0x40000, kDdpfPalette8 = 0x20;

}  // namespace

std::string refused_dxgi(std::uint32_t dxgi) {
    const auto* const found = std::find_if(std::begin(kRefusedDxgi), std::end(kRefusedDxgi),
                                           [&](const RefusedDxgi& row) { return row.dxgi == dxgi; });
    const std::string number = "DXGI format " + std::to_string(dxgi);
    if (found == std::end(kRefusedDxgi)) return number + " is not supported";
    return refused(number + " (" + found->name + ")", found->target);
}

std::string refused_legacy(const DdsPixelFormat& pixel_format) {
    constexpr std::uint32_t kMasked = kDdpfAlpha | kDdpfRgb | kDdpfLuminance | kDdpfBumpDudv;
    const std::uint32_t flags = pixel_format.flags, red = pixel_format.masks[0];
    if ((flags & kDdpfBumpDudv) != 0 && (red == 0x3ff || red == 0x3ff00000))
        return refused("the pixel format A2W10V10U10, signed with 10 bits,", kHalves);
    if ((flags & kMasked) != 0) return {};
    const auto* const found = std::find_if(std::begin(kRefusedCodes), std::end(kRefusedCodes),
                                           [&](const RefusedCode& row) { return row.code == pixel_format.four_cc; });
    if (found != std::end(kRefusedCodes)) return refused(found->what, kBytes);
    if ((flags & kDdpfBumpLuminance) != 0) {
        const char* const name = pixel_format.bit_count == 16 ? "L6V5U5" : "X8L8V8U8";
        return refused("the pixel format " + std::string(name) + ", signed x and y with luminance,", kSigned);
    }
    return (flags & kDdpfPalette8) != 0 ? refused("a palette of 8 bits", kBytes) : "";
}

}  // namespace tex::inline v1
