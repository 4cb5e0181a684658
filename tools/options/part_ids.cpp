// SPDX-License-Identifier: Apache-2.0

#include "options/part_ids.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

constexpr std::size_t kMostLines = 24;  // of the legend on standard output

using Color = std::array<int, 3>;  // of 255

// Hues a golden angle apart, so that neighbours differ however many there are, in four steps of brightness and
// saturation. None is black, which is the background.
Color color_of(std::int32_t id) {
    constexpr std::uint32_t kGolden = 0x9e3779b9U;  // of a turn, in 2^32
    const std::uint32_t hue = static_cast<std::uint32_t>(id) * kGolden;
    const int most = id % 2 == 0 ? 255 : 180, least = (id / 2) % 2 == 0 ? 30 : 90;
    const auto sixth = static_cast<int>((static_cast<std::uint64_t>(hue) * 6) >> 32);
    const auto within = static_cast<int>((static_cast<std::uint64_t>(hue) * 6 >> 24) & 0xff);
    const int rising = least + (most - least) * within / 255, falling = most + least - rising;
    constexpr int kOrder[6][3] = {{0, 1, 2}, {3, 0, 2}, {2, 0, 1}, {2, 3, 0}, {1, 2, 0}, {0, 2, 3}};
    const int values[4] = {most, rising, least, falling};
    Color color{};
    for (std::size_t k = 0; k < 3; ++k) color[k] = values[kOrder[sixth][k]];
    return color;
}

}  // namespace

void PartIds::add(Command& command, const FileOptions& files) {
    output_.add(command, files, "--id-out", "write a colour for each part of the high mesh, and what colours mean");
    command.choice(by_, "--id-by", "I", kIdByNames, "what has a colour of its own in --id-out");
    command.check([&command] {
        if (command.given("--id-by") && !command.given("--id-out")) throw UsageError("--id-by needs --id-out");
    });
}

std::string PartIds::name_of_part(const HighParts& high, std::size_t part) const {
    switch (by_) {
        case IdBy::part: return high.name_of(part);
        case IdBy::material: return high.materials[high.part_of(part)];
        case IdBy::mesh: break;
    }
    return high.names[static_cast<std::size_t>(high.files[high.part_of(part)])];
}

std::vector<std::string> PartIds::names_of(const HighParts& high) const {
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (std::size_t k = 0; k < high.standing(); ++k) {
        std::string name = name_of_part(high, k);
        if (seen.insert(name).second) names.push_back(std::move(name));
    }
    return names;
}

void PartIds::number(const HighParts& high, TransferInputs& inputs) const {
    if (!output_.is_given()) return;
    std::map<std::string, std::int32_t> numbers;
    for (std::size_t k = 0; k < high.standing(); ++k) {
        const auto next = static_cast<std::int32_t>(numbers.size());
        inputs.high_ids.push_back(numbers.emplace(name_of_part(high, k), next).first->second);
    }
}

Result<void> PartIds::write(Job& job, const HighParts& high, const TransferredMaps& maps) const {
    if (!output_.is_given()) return {};
    const Extent extent = maps.ids.extent();
    Image image;
    for (const char* const name : {"R", "G", "B"}) {
        image.planes.emplace_back(extent);
        image.names.emplace_back(name);
    }
    const std::vector<std::string> names = names_of(high);
    std::vector<std::int64_t> texels(names.size());
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const std::int32_t id = maps.ids.at(i, j);
            const Color color = id == kNoId ? Color{} : color_of(id);
            for (std::size_t k = 0; k < 3; ++k) image.planes[k].at(i, j) = static_cast<float>(color[k]) / 255.0f;
            if (maps.origin.at(i, j) == TexelOrigin::hit) ++texels[static_cast<std::size_t>(id)];
        }
    }
    Json legend = Json::array();
    std::string lines;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const Color c = color_of(static_cast<std::int32_t>(k));
        const std::string color = fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
        legend.push_back({{"name", names[k]}, {"color", color}, {"texels", texels[k]}});
        if (k < kMostLines)
            lines += fmt::format("  {} {} ({} texels)\n", color, names[k].empty() ? "no name" : printable(names[k]),
                                 texels[k]);
    }
    if (names.size() > kMostLines)
        lines += fmt::format("  and {} more, which --json lists\n", names.size() - kMostLines);
    Json report = {{"by", name_of(kIdByNames, by_)}, {"legend", std::move(legend)}};
    if (auto done = output_.write(job, image, report); !done) return done;
    if (job.task.output != "-") job.say(fmt::format("{}:\n{}", printable(report["output"].get<std::string>()), lines));
    job.report["ids"] = std::move(report);
    return {};
}

}  // namespace tex::cli
