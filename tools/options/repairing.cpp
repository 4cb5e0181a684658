// SPDX-License-Identifier: Apache-2.0

#include "options/repairing.h"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/file.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"

namespace tex::cli {

void RepairingOptions::add(Command& command) {
    command.group("Repairs");
    command.text(material_, "--material", "NAME", "of models, only the maps of this material, or of its number from 0");
    const auto rules_into = [](std::vector<std::string>& names) {
        return [&names](const std::string& text) {
            for (const std::string& name : split(text, ',')) {
                if (find_rule(name) == nullptr) throw UsageError(fmt::format("there is no rule '{}'", printable(name)));
                names.push_back(name);
            }
        };
    };
    command.flag(options_.likely, "--likely", "also undo faults that the texels do not prove beyond doubt")
        .often(3, "also undo faults that the texels do not prove");
    command
        .option("--only", "ID[,ID...]", "repair the faults of these rules alone (ids or names)",
                rules_into(options_.only))
        .repeatable = true;
    command.option("--skip", "ID[,ID...]", "leave the faults of these rules as they are", rules_into(options_.skip))
        .repeatable = true;
    command
        .text(height_file_, "--height", "FILE",
              "the height map that the (single) input was made from, which decides whether green or red is mirrored")
        .completes = Completes::files;
    command.choice(options_.mirrored, "--mirrored", "CHANNEL", kMirroredChannelNames,
                   "which channel is the other way round, where slopes show that green or red is");
    command.choice(options_.turned, "--turned", "WAY", kTurnedPictureNames,
                   "which way a picture was turned whose vectors were not");
    command.option("--bumpiness", "B", "bake heights that stand in place of normals; white is B texel widths high",
                   [this](const std::string& text) {
                       options_.bumpiness = static_cast<float>(
                           parse_double(text, {.least = 1e-20, .greatest = 1e20, .of_magnitude = true}));
                   });
    Option& layout =
        command.option("--swizzle", "S", "which channels hold what: a word, or the channels of x, y and z, such as abg",
                       [this](const std::string& text) { options_.checks.swizzle = parse_swizzle(text); });
    layout.words = swizzle_words();
    layout.preset = "auto";
    layout.completes = Completes::words;
    add_length_in(command, length_in_);
}

Result<void> RepairingOptions::read_heights(const ReadOptions& read) {
    if (height_file_.empty()) return {};
    const auto image = read_image(height_file_, read);
    if (!image) return image.error();
    auto field = height_field(*image, {});
    if (!field) return field.error().of(height_file_);
    height_ = std::move(*field);
    options_.checks.height = &*height_;
    return {};
}

RepairOptions RepairingOptions::options(std::optional<YAxis> y, Effort effort) const {
    RepairOptions options = options_;
    options.effort = effort;
    options.checks.require.y = y;
    options.checks.any_length = length_in_.has_value();
    return options;
}

}  // namespace tex::cli
