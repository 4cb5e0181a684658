// SPDX-License-Identifier: Apache-2.0

#include "reference/detection.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <tex/check.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "reference/planting.h"
#include "reference/real_maps.h"

namespace tex::reference {
namespace {

bool found(const CheckReport& report, const std::string& ids) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return ids.find(finding.rule->id) != std::string::npos; });
}

// The base level as unit vectors, y as the file has it.
Result<NormalMap> vectors(Texture texture) {
    texture.levels.resize(1);
    const auto swizzle = guess_swizzle(texture);
    if (!swizzle) return swizzle.error();
    UnpackOptions options;
    options.swizzle = *swizzle;
    options.y_axis = YAxis::up;
    auto chain = unpack(texture, options);
    if (!chain) return chain.error();
    return std::move(chain->levels.front());
}

Result<void> detect_in(const RealMap& map, const NormalMap& normals, bool blocks, Detection& detection) {
    const std::size_t half = sets_thresholds(map) ? 0 : 1;
    // Textures without a damage are shared by several damages: each is checked once for each requirement.
    std::map<std::pair<const Texture*, bool>, CheckReport> intact;
    for (const Planted& planted : plant_all(normals, map.y, map.tiles, blocks)) {
        CheckOptions options;
        options.require.y = planted.y;
        options.require.tiles = planted.tiles;
        Score score;
        score.intact = 1;
        const auto key = std::make_pair(planted.intact.get(), planted.tiles);
        if (intact.find(key) == intact.end()) {
            CheckOptions all_required = options;
            all_required.require.y = map.y;
            auto report = check("", *planted.intact, all_required);
            if (!report) return report.error();
            intact[key] = std::move(*report);
        }
        if (found(intact[key], planted.rules)) {
            score.alarms = 1;
            detection.alarmed.push_back(planted.damage + ": " + map.path);
        }
        const auto report = check("", planted.damaged, options);
        if (!report) return report.error();
        (planted.visible ? score.planted : score.hidden) = 1;
        score.detected = planted.visible && found(*report, planted.rules) ? 1 : 0;
        if (score.detected < score.planted) detection.missed.push_back(planted.damage + ": " + map.path);
        detection.by_damage[planted.damage][half].add(score);
        detection.total[half].add(score);
    }
    return {};
}

std::string line_of(const std::string& name, const std::array<Score, 2>& halves) {
    char line[160];
    int length = std::snprintf(line, sizeof line, "%-28s", name.c_str());
    for (const Score& s : halves) {
        length += std::snprintf(line + length, sizeof line - static_cast<std::size_t>(length),
                                "   %4d/%-4d %6d %5d/%-4d", s.detected, s.planted, s.hidden, s.alarms, s.intact);
    }
    return std::string(line) + "\n";
}

}  // namespace

void Score::add(const Score& other) {
    planted += other.planted;
    detected += other.detected;
    hidden += other.hidden;
    intact += other.intact;
    alarms += other.alarms;
}

std::string Detection::text() const {
    char head[256];
    std::snprintf(head, sizeof head, "%-28s   %-27s   %-27s\n%-28s   %9s %6s %10s   %9s %6s %10s\n", "",
                  "half that set thresholds", "half held out", "damage", "detected", "hidden", "alarms", "detected",
                  "hidden", "alarms");
    std::string text = head;
    for (const auto& [damage, halves] : by_damage) text += line_of(damage, halves);
    text += line_of("all", total);
    for (const std::string& what : missed) text += "  missed: " + what + "\n";
    for (const std::string& what : alarmed) text += "  alarm:  " + what + "\n";
    return text;
}

Result<Detection> detect_planted(const std::string& data) {
    Detection detection;
    for (const RealMap& map : real_maps()) {
        if (!map.intact) continue;
        auto texture = read_texture(data + map.path);
        if (!texture) return texture.error();
        const bool blocks = format_info(texture->format).has_blocks();
        auto normals = vectors(std::move(*texture));
        if (!normals) return normals.error();
        if (auto done = detect_in(map, *normals, blocks, detection); !done) return done.error();
    }
    return detection;
}

}  // namespace tex::reference
