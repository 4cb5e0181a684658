// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_texels.h"

#include <string>
#include <utility>

#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

// KHR_DF_CHANNEL_UASTC_... and KHR_DF_CHANNEL_ETC1S_...
constexpr std::uint32_t kUastcRgb = 0, kUastcRrr = 4, kUastcRrrg = 5, kUastcRg = 6;
constexpr std::uint32_t kEtc1sRgb = 0, kEtc1sRrr = 3, kEtc1sGgg = 4;

constexpr Swizzle kRgb = {Component::x, Component::y, Component::z, Component::one};
// One value: heights, or an x without a y.
constexpr Swizzle kRrr = {Component::other, Component::zero, Component::zero, Component::one};

Error refused(ErrorCode code, std::string reason) { return {code, {}, std::move(reason)}; }

// Other kinds of Basis Universal, which its own tool converts.
Error unpack_first(const std::string& kind) {
    return refused(ErrorCode::unsupported, kind + " is not supported; \"basisu -unpack\" makes files that are");
}

BasisTexels uastc_texels(const Ktx2Descriptor& descriptor) {
    switch (descriptor.channels[0].value_or(kUastcRgb)) {
        case kUastcRgb: return {Format::uastc_4x4_unorm, kRgb, true};
        case kUastcRrr: return {Format::uastc_4x4_unorm, kRrr, true};
        case kUastcRrrg: return {Format::uastc_4x4_unorm, kSwizzleXxxy, true};
        case kUastcRg: return {Format::uastc_4x4_unorm, kSwizzleXy, true};
        default: return {Format::uastc_4x4_unorm, kSwizzleXyz, false};
    }
}

BasisTexels etc1s_texels(const Ktx2Descriptor& descriptor) {
    const std::uint32_t first = descriptor.channels[0].value_or(kEtc1sRgb);
    if (!descriptor.channels[1]) return {Format::etc1s_rgb_unorm, first == kEtc1sRrr ? kRrr : kRgb, true};
    if (first == kEtc1sRrr || descriptor.channels[1] == kEtc1sGgg)
        return {Format::etc1s_rgba_unorm, kSwizzleXxxy, true};
    return {Format::etc1s_rgba_unorm, kSwizzleXyz, false};
}

}  // namespace

Result<BasisTexels> basis_texels(const std::optional<Ktx2Descriptor>& descriptor, Supercompression supercompression) {
    constexpr std::uint32_t kUastcHdr = 167, kUastcHdr6x6 = 168, kXuastc = 169, kXubc7 = 170;
    const bool is_lz = supercompression == Supercompression::basis_lz;
    if (!descriptor || descriptor->model == 0)
        return refused(ErrorCode::unsupported,
                       "neither VkFormat nor a data format descriptor says what its texels are; export the "
                       "texture again");
    switch (descriptor->model) {
        case kKhrUastc:
            if (is_lz) return refused(ErrorCode::bad_data, "UASTC is not compressed with BasisLZ; export it again");
            return uastc_texels(*descriptor);
        case kKhrEtc1s:
            if (!is_lz) return refused(ErrorCode::bad_data, "ETC1S is stored with BasisLZ alone; export it again");
            return etc1s_texels(*descriptor);
        case kUastcHdr:
        case kUastcHdr6x6: return unpack_first("UASTC of high dynamic range");
        case kXuastc: return unpack_first("XUASTC");
        case kXubc7: return unpack_first("XUBC7");
        default: break;
    }
    return refused(ErrorCode::unsupported, "its data format descriptor says " + khr_model_text(descriptor->model) +
                                               ", but VkFormat is 0, undefined; export the texture with a VkFormat");
}

Error unknown_scheme(std::uint32_t scheme) {
    constexpr std::uint32_t kUastcHdr6x6 = 4, kXuastc = 5, kXubc7 = 6;
    switch (scheme) {
        case kUastcHdr6x6: return unpack_first("UASTC of high dynamic range");
        case kXuastc: return unpack_first("XUASTC");
        case kXubc7: return unpack_first("XUBC7");
        default:
            return refused(ErrorCode::unsupported,
                           "supercompression scheme " + std::to_string(scheme) + " is not supported");
    }
}

Error unknown_vk_format(std::uint32_t vk) {
    constexpr std::uint32_t kFirstAstcHdr = 1000066000, kLastAstcHdr = 1000066013;
    if (vk >= kFirstAstcHdr && vk <= kLastAstcHdr) return unpack_first("ASTC of high dynamic range (UASTC HDR)");
    return refused(ErrorCode::unsupported, "VkFormat " + std::to_string(vk) + " is not supported");
}

}  // namespace tex::inline v1
