// SPDX-License-Identifier: Apache-2.0

#include "options/layers.h"

#include <tuple>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "fields/blend_fields.h"
#include "options/mips.h"

namespace tex::cli {
namespace {

constexpr Range kTilingRange{0.0, kMaxTiling, false};
constexpr Range kOffsetRange{-kMaxTiling, kMaxTiling};

// Parses "X" or "X,Y". Without a comma, Y equals X if `square`; else it is an error.
std::pair<float, float> parse_pair(const std::string& text, Range range, bool square) {
    const auto [first, second] = cut(text, ',');
    const float x = parse_float(first, range);
    if (square && text.find(',') == std::string::npos) return {x, x};
    return {x, parse_float(second, range)};
}

}  // namespace

void LayerOptions::add(Command& command) {
    command.group("Layers (each option once for all details, or once for each)");
    Option& detail =
        command.option("--detail", "FILE", "a detail map; all inputs are then bases", [this](const std::string& text) {
            if (text.empty()) throw UsageError("needs a value that is not empty");
            details_.push_back(text);
        });
    detail.often(2, "a detail map; all inputs are then bases").completes = Completes::files;
    detail.repeatable = true;
    command
        .option(
            "--detail-scale", "S", "make the detail steeper or flatter",
            [this](const std::string& text) { scale_.values.push_back(parse_float(text, range_of(&Layer::scale))); })
        .often(2, "make the detail steeper or flatter")
        .repeatable = true;
    add_placement(command);
    Option& mask =
        command.option("--mask", "FILE[:CHANNEL]", "a mask for the detail: white shows all of it",
                       [this](const std::string& text) { mask_.values.push_back(parse_channel_file(text)); });
    mask.often(2, "a mask for the detail: white shows all of it").completes = Completes::files;
    mask.repeatable = true;
    command
        .option("--strength", "T", "how much of the detail shows, 0 to 1",
                [this](const std::string& text) {
                    strength_.values.push_back(parse_float(text, range_of(&Layer::strength)));
                })
        .repeatable = true;
    Option& y = add_y_in(command, "--detail-y-in", "which way green points in the detail",
                         [this](YIn given) { y_in_.values.emplace_back(given); });
    y.preset = "as the file says, else as --y-in";
    y.repeatable = true;
}

void LayerOptions::add_placement(Command& command) {
    Option& tiling = command.option(
        "--tiling", "X[,Y]", "how often the detail repeats across the base",
        [this](const std::string& text) { tiling_.values.push_back(parse_pair(text, kTilingRange, true)); });
    tiling.often(2, "how often the detail repeats across the base").preset = "1,1";
    tiling.repeatable = true;
    Option& offset = command.option(
        "--offset", "X,Y", "move the detail, in its own widths and heights; y is up",
        [this](const std::string& text) { offset_.values.push_back(parse_pair(text, kOffsetRange, false)); });
    offset.preset = "0,0";
    offset.repeatable = true;
    command
        .option("--rotate", "DEGREES", "turn the detail counter-clockwise, its vectors too",
                [this](const std::string& text) { rotation_.values.push_back(parse_float(text)); })
        .repeatable = true;
    Option& wrap = command.option("--detail-wrap", "W[,W]", "what lies beyond the detail's border",
                                  [this](const std::string& text) { wrap_.values.push_back(parse_wraps(text)); });
    wrap.words = words_of(kWrapNames);
    wrap.completes = Completes::words;
    wrap.preset = name_of(kWrapNames, Layer{}.wrap_x);
    wrap.repeatable = true;
}

void LayerOptions::check(std::size_t count) const {
    const auto fits = [count](const char* name, std::size_t given) {
        if (given > 0 && count == 0) throw UsageError(fmt::format("{} is for a detail, and there is none", name));
        if (given <= 1 || given == count) return;
        throw UsageError(
            fmt::format("{} is given {} times for {} detail{}", name, given, count, count == 1 ? "" : "s"));
    };
    fits("--detail-scale", scale_.values.size());
    fits("--tiling", tiling_.values.size());
    fits("--offset", offset_.values.size());
    fits("--rotate", rotation_.values.size());
    fits("--detail-wrap", wrap_.values.size());
    fits("--mask", mask_.values.size());
    fits("--strength", strength_.values.size());
    fits("--detail-y-in", y_in_.values.size());
}

std::vector<std::string> LayerOptions::files() const {
    std::vector<std::string> files = details_;
    for (const ChannelFile& mask : mask_.values) files.push_back(mask.file);
    return files;
}

std::vector<LayerFile> LayerOptions::layers(Job& job, const std::vector<std::string>& names,
                                            const NormalsReader& normals) const {
    std::vector<LayerFile> files;
    for (std::size_t k = 0; k < names.size(); ++k) {
        LayerFile& layer = files.emplace_back();
        layer.input = names[k];
        layer.source = normals.options(job, {false, true, y_in_.of(k, std::nullopt), {}, true});
        layer.scale = scale_.of(k, layer.scale);
        std::tie(layer.tiling_x, layer.tiling_y) = tiling_.of(k, {layer.tiling_x, layer.tiling_y});
        std::tie(layer.offset_x, layer.offset_y) = offset_.of(k, {layer.offset_x, layer.offset_y});
        layer.rotation = rotation_.of(k, layer.rotation);
        std::tie(layer.wrap_x, layer.wrap_y) = wrap_.of(k, {layer.wrap_x, layer.wrap_y});
        layer.strength = strength_.of(k, layer.strength);
        const ChannelFile mask = mask_.of(k, {});
        if (mask.file.empty()) continue;
        layer.mask = [&job, mask] {
            return read_only_channel(
                job, mask, fmt::format("name the one that is the mask, such as --mask {}:r", shell_file(mask.file)));
        };
    }
    return files;
}

}  // namespace tex::cli
