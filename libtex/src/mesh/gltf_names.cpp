// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_names.h"

#include <algorithm>
#include <array>
#include <utility>

#include "mesh/gltf_buffers.h"

namespace tex::inline v1 {
namespace {

template <class Found>
void find_uris(JsonValue value, const Found& found) {
    for (std::size_t k = 0; k < value.size(); ++k) find_uris(value[k], found);
    for (const std::string& key : value.keys()) {
        const JsonValue part = value[key];
        if (const auto uri = part.text(); uri && key == "uri") found(*uri);
        find_uris(part, found);
    }
}

// Where the extension of the last name in a path begins: its dot, or the end.
std::size_t extension_begin(std::string_view path) {
    const std::size_t slash = path.rfind('/'), first = slash == std::string_view::npos ? 0 : slash + 1;
    const std::size_t dot = path.rfind('.');
    return dot == std::string_view::npos || dot <= first ? path.size() : dot;
}

}  // namespace

std::string uri_of_path(std::string_view path) {
    constexpr std::string_view kHex = "0123456789ABCDEF", kPlain = "-._~/";
    std::string uri;
    for (const char c : path) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (is_letter || kPlain.find(c) != std::string_view::npos) {
            uri += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        uri += {'%', kHex[byte / 16], kHex[byte % 16]};
    }
    return uri;
}

GltfNames::GltfNames(JsonValue root, ModelPlace place) : place_(std::move(place)) {
    find_uris(root, [&](const std::string& uri) {
        if (uri.empty() || is_data_uri(uri)) return;
        auto path = path_of_uri(uri);
        path ? void(++named_[std::move(*path)]) : outside_.push_back(uri);
    });
}

void GltfNames::forget(const std::string& path) {
    const auto found = named_.find(path);
    if (found != named_.end() && --found->second == 0) named_.erase(found);
}

std::string GltfNames::name_for(const std::string& path, std::string_view extension) {
    const std::size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
    const std::string stem = path.substr(folder.size(), extension_begin(path) - folder.size());
    const auto is_free = [&](const std::string& name) {
        return !named_.contains(name) && !given_.contains(name) && name != place_.name;
    };
    std::string name = folder + stem + std::string(extension);
    if (place_.is_same_folder || !is_free(name)) {
        const std::string begin = folder + place_.name.substr(0, extension_begin(place_.name)) + "_" + stem;
        name = begin + std::string(extension);
        for (int k = 2; !is_free(name); ++k) name = begin + "_" + std::to_string(k) + std::string(extension);
    }
    given_.insert(name);
    return name;
}

std::vector<std::string> GltfNames::kept() const {
    std::vector<std::string> paths;
    for (const auto& [path, count] : named_) paths.push_back(path);
    return paths;
}

bool GltfNames::is_usual(std::string_view path) {
    constexpr std::array<std::string_view, 16> kUsual = {".bin",  ".glbin", ".png", ".jpg",  ".jpeg",  ".webp",
                                                         ".ktx2", ".ktx",   ".dds", ".avif", ".basis", ".bmp",
                                                         ".tga",  ".gif",   ".tif", ".tiff"};
    std::string extension(path.substr(extension_begin(path)));
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return std::find(kUsual.begin(), kUsual.end(), extension) != kUsual.end();
}

}  // namespace tex::inline v1
