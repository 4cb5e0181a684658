// SPDX-License-Identifier: Apache-2.0

#include "formats/layers.h"

#include <charconv>

namespace tex::inline v1 {
namespace {

std::string content_of(const LayerCount& count) {
    constexpr std::uint64_t kFaces = 6;
    const std::string layers = std::to_string(count.layers);
    if (!count.has_faces) return count.layers == 1 ? "one layer" : "a texture array of " + layers + " layers";
    if (count.layers <= kFaces) return "a cube map of " + layers + " faces";
    return "cube maps with " + layers + " faces";
}

std::string numbers_of(const LayerCount& count) {
    const std::string faces = count.has_faces ? " for +X, -X, +Y, -Y, +Z, -Z" : "";
    return "--layer 0 to " + std::to_string(count.layers - 1) + " reads one" + faces;
}

}  // namespace

Result<std::uint64_t> chosen_layer(const LayerCount& count, const std::string& name, const ReadOptions& options) {
    const std::string& text = options.layer;
    if (text.empty()) {
        if (count.layers == 1) return std::uint64_t{0};
        return Error{ErrorCode::unsupported, name, content_of(count) + "; " + numbers_of(count)};
    }
    std::uint64_t layer = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), layer);
    if (error == std::errc() && stop == text.data() + text.size() && layer < count.layers) return layer;
    return Error{ErrorCode::bad_option, name,
                 "has no layer \"" + text + "\": it holds " + content_of(count) +
                     (count.layers > 1 ? "; " + numbers_of(count) : "")};
}

}  // namespace tex::inline v1
