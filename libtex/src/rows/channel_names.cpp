// SPDX-License-Identifier: Apache-2.0

#include "rows/channel_names.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

namespace tex::inline v1 {
namespace {

// Words that belong together. Those with three members come first.
struct WordGroup {
    std::array<std::string_view, 3> words;
    bool is_colour;
};

constexpr WordGroup kWordGroups[] = {
    {{"r", "g", "b"}, true}, {{"red", "green", "blue"}, true}, {{"x", "y", "z"}, false},
    {{"r", "g"}, true},      {{"red", "green"}, true},         {{"x", "y"}, false},
    {{"u", "v"}, false},
};

std::vector<std::string> layers_of(const std::vector<std::string>& names) {
    std::vector<std::string> layers;
    for (const std::string& name : names) {
        std::string layer(layer_of(name));
        if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(std::move(layer));
    }
    return layers;
}

std::optional<std::size_t> find_word(const std::vector<std::string>& names, std::string_view layer,
                                     std::string_view word) {
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (layer_of(names[k]) == layer && same_word(channel_word(names[k]), word)) return k;
    }
    return std::nullopt;
}

std::optional<ChannelGroup> group_of(const std::vector<std::string>& names, const std::string& layer) {
    for (const WordGroup& words : kWordGroups) {
        ChannelGroup group{layer, words.is_colour, {}, {}};
        for (const std::string_view word : words.words) {
            if (const auto found = find_word(names, layer, word); found && !word.empty())
                group.channels.push_back(*found);
        }
        const auto wanted = words.words.back().empty() ? std::size_t{2} : std::size_t{3};
        if (group.channels.size() != wanted) continue;
        for (std::size_t k = 0; k < names.size() && group.alpha.empty(); ++k) {
            if (layer_of(names[k]) == layer && is_alpha(names[k])) group.alpha.push_back(k);
        }
        return group;
    }
    return std::nullopt;
}

bool ends_in(std::string_view name, std::string_view end) {
    if (name.size() <= end.size() || name[name.size() - end.size() - 1] != '.') return false;
    return same_word(name.substr(name.size() - end.size()), end);
}

// Whether a layer is called N, nrm, normal, Normals, shadingNormal ...
bool is_called_normal(std::string_view layer) {
    const std::string_view word = channel_word(layer);
    for (const std::string_view name : {"n", "nrm", "norm", "nml"}) {
        if (same_word(word, name)) return true;
    }
    constexpr std::string_view kNormal = "normal";
    for (std::size_t k = 0; k + kNormal.size() <= word.size(); ++k) {
        if (same_word(word.substr(k, kNormal.size()), kNormal)) return true;
    }
    return false;
}

std::vector<std::string> layers_of(const std::vector<ChannelGroup>& groups) {
    std::vector<std::string> layers;
    layers.reserve(groups.size());
    for (const ChannelGroup& group : groups) layers.push_back(group.layer);
    return layers;
}

// The group of normals; nothing if that is not clear.
const ChannelGroup* group_of_normals(const std::vector<ChannelGroup>& groups) {
    if (groups.size() == 1) return &groups.front();
    const ChannelGroup* normals = nullptr;
    for (const ChannelGroup& group : groups) {
        if (group.layer.empty()) return &group;
        if (!is_called_normal(group.layer)) continue;
        if (normals != nullptr) return nullptr;
        normals = &group;
    }
    return normals;
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char p, char q) { return lower(p) == lower(q); });
}

std::string_view channel_word(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

std::string_view layer_of(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
}

bool is_alpha(std::string_view name) {
    const std::string_view word = channel_word(name);
    return same_word(word, "a") || same_word(word, "alpha");
}

std::vector<ChannelGroup> channel_groups(const std::vector<std::string>& names) {
    std::vector<ChannelGroup> groups;
    for (const std::string& layer : layers_of(names)) {
        if (std::optional<ChannelGroup> group = group_of(names, layer)) groups.push_back(std::move(*group));
    }
    return groups;
}

const ChannelGroup* colour_group(const std::vector<ChannelGroup>& groups) {
    const ChannelGroup* colours = nullptr;
    int layers = 0;
    for (const ChannelGroup& group : groups) {
        if (!group.is_colour || group.channels.size() != 3) continue;
        if (group.layer.empty()) return &group;
        colours = &group;
        ++layers;
    }
    return layers == 1 ? colours : nullptr;
}

Result<NormalChannels> normal_channels(const std::vector<std::string>& names) {
    const std::vector<ChannelGroup> groups = channel_groups(names);
    if (groups.empty()) return NormalChannels{};
    const ChannelGroup* const group = group_of_normals(groups);
    if (group == nullptr) {
        return Error{ErrorCode::bad_option,
                     {},
                     "which layer holds the normals is not clear; its layers are " + list_of_names(layers_of(groups))};
    }
    NormalChannels found{group->channels, {}};
    if (group->channels.size() == 3)
        found.channels.insert(found.channels.end(), group->alpha.begin(), group->alpha.end());
    if (groups.size() > 1) {
        found.remark = group->layer.empty() ? "the channels without a layer are read"
                                            : "the layer " + list_of_names({group->layer}) + " is read";
        found.remark += ", of several that could hold normals";
    }
    return found;
}

Result<std::vector<std::size_t>> layer_channels(const std::vector<std::string>& names, const std::string& layer) {
    std::vector<std::string> layers = layers_of(names);
    std::vector<std::string> found;
    std::copy_if(layers.begin(), layers.end(), std::back_inserter(found),
                 [&](const std::string& name) { return name == layer; });
    for (const auto fits : {same_word, ends_in}) {
        if (!found.empty()) break;
        std::copy_if(layers.begin(), layers.end(), std::back_inserter(found),
                     [&](const std::string& name) { return fits(name, layer); });
    }
    if (found.size() != 1 || layer.empty()) {
        const std::string what = found.size() > 1 ? "several layers are called \"" : "the picture has no layer \"";
        std::erase(layers, std::string());
        const std::string there =
            layers.empty() ? "its channels are " + list_of_names(names) : "its layers are " + list_of_names(layers);
        return Error{ErrorCode::bad_option, {}, what + layer + "\"; " + there};
    }
    std::vector<std::size_t> channels;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (layer_of(names[k]) == found.front()) channels.push_back(k);
    }
    return channels;
}

std::size_t find_channel(const std::vector<std::string>& names, std::string_view name) {
    const auto exact = std::find(names.begin(), names.end(), name);
    const auto found = exact != names.end() ? exact : std::find_if(names.begin(), names.end(), [&](const auto& other) {
        return same_word(other, name);
    });
    return static_cast<std::size_t>(found - names.begin());
}

std::string list_of_names(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 16;
    std::string list;
    for (std::size_t k = 0; k < std::min(names.size(), kMost); ++k) list += (k == 0 ? "" : ", ") + names[k];
    std::erase_if(list, [](char c) { return c < 0x20 || c > 0x7e; });
    if (names.size() > kMost) list += " and " + std::to_string(names.size() - kMost) + " more";
    return list;
}

}  // namespace tex::inline v1
