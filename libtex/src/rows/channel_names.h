// SPDX-License-Identifier: Apache-2.0
// channel_names.h: what the channels of a picture hold, as far as their names say. All readers of heights, normals and
// colours ask here.
//
// EXR files name channels LAYER.CHANNEL, and the layer's name may contain dots too: "N.R", "ViewLayer.Normal.X". Names
// are compared without regard to case.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

// The part of a channel's name after the last dot, and the part before it.
[[nodiscard]] std::string_view channel_word(std::string_view name);
[[nodiscard]] std::string_view layer_of(std::string_view name);

// Whether a channel is called A or alpha, in whatever layer.
[[nodiscard]] bool is_alpha(std::string_view name);

// The channels of one layer that belong together: R, G, B; red, green, blue; X, Y, Z; and of layers without any of
// these, R, G; red, green; X, Y; U, V.
struct ChannelGroup {
    std::string layer;
    bool is_colour = false;             // neither X, Y, Z nor U, V
    std::vector<std::size_t> channels;  // two or three, in this order, as places in the list of names
    std::vector<std::size_t> alpha;     // of the same layer: one or none
};

// The group of each layer that has one, in the order of the names.
[[nodiscard]] std::vector<ChannelGroup> channel_groups(const std::vector<std::string>& names);

// The group of three colours without a layer, or of the only layer that has them; else null.
[[nodiscard]] const ChannelGroup* colour_group(const std::vector<ChannelGroup>& groups);

// The channels of normals: those of the group without a layer, of the only group, or of the only one whose layer is
// called normal (N, Normal, ViewLayer.Normal ...).
struct NormalChannels {
    std::vector<std::size_t> channels;  // x, y, z, alpha; empty if no names say what the channels hold
    std::string remark;                 // if other layers have such channels too
};

// Errors: bad_option (several layers, and it is not clear which).
[[nodiscard]] Result<NormalChannels> normal_channels(const std::vector<std::string>& names);

// The channels of a layer, which may be given by the end of its name: "Normal" for "ViewLayer.Normal". Errors:
// bad_option (no layer, or several, have this name).
[[nodiscard]] Result<std::vector<std::size_t>> layer_channels(const std::vector<std::string>& names,
                                                              const std::string& layer);

// The place of the channel with this whole name; names.size() if there is none.
[[nodiscard]] std::size_t find_channel(const std::vector<std::string>& names, std::string_view name);

// The names as a list for messages: plain text, and not all if there are many.
[[nodiscard]] std::string list_of_names(const std::vector<std::string>& names);

}  // namespace tex::inline v1
