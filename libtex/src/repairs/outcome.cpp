// SPDX-License-Identifier: Apache-2.0

#include "repairs/outcome.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>

namespace tex::inline v1 {
namespace {

constexpr double kLeftOfLengths = 0.7;  // of the share of vectors that levels had made longer

}  // namespace

const Finding* find_finding(const CheckReport& report, std::string_view id) {
    for (const Finding& finding : report.findings) {
        if (finding.rule->id == id) return &finding;
    }
    return nullptr;
}

bool is_gone(const CheckReport& report, const RepairStep& step, double figure) {
    const std::string_view id = step.rule->id;
    if (id == "N214" || id == "N213") return find_finding(report, id) == nullptr;
    // Channels go back first where levels were changed, too, and where x and y were exchanged beside z.
    constexpr std::string_view kTones[] = {"N301", "N302", "N313", "N314"};
    // What levels cut off stays so, and leaves some vectors off unit length.
    if (step.kind == RepairKind::undo_tone && (id == "N201" || id == "N205")) {
        const Finding* const left = find_finding(report, id);
        return left == nullptr || (!left->tone && left->figure < kLeftOfLengths * figure);
    }
    // What leaves another curve behind was not the one that the map went through, unless channels are exchanged, too.
    const bool leaves_curve = std::any_of(std::begin(kTones), std::end(kTones),
                                          [&](std::string_view tone) { return find_finding(report, tone) != nullptr; });
    if (takes_curve_back(step.kind) && leaves_curve && find_finding(report, "N308") == nullptr) return false;
    const bool is_of_z = id == "N308" && step.certainty == RepairClass::safe && step.kind == RepairKind::exchange;
    return std::none_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
        if (finding.rule->id == id) return !is_of_z || finding.unit == "component";
        if (is_of_z && std::find(std::begin(kTones), std::end(kTones), finding.rule->id) != std::end(kTones))
            return false;
        return finding.severity == Severity::error && finding.rule->explains.find(id) != std::string_view::npos;
    });
}

bool proves(RepairKind kind) {
    return kind != RepairKind::bake_heights && kind != RepairKind::straighten && kind != RepairKind::fill_background &&
           kind != RepairKind::normalize && kind != RepairKind::rebuild_levels;
}

bool takes_curve_back(RepairKind kind) {
    return kind == RepairKind::undo_tone || kind == RepairKind::encode_srgb || kind == RepairKind::decode_srgb;
}

Result<double> mean_change(const Texture& before, const Texture& after, const Execution& execution) {
    // Bands of rows need little memory, and are whole rows of blocks in every format. Of large maps, evenly spread ones
    // tell the mean: all of 4096x4096 texels cost a tenth of the whole repair.
    constexpr int kBand = 120;
    constexpr std::int64_t kEnough = 1 << 22;  // texels
    const Extent extent = before.levels.front().extent;
    const int step = kBand * static_cast<int>(std::max<std::int64_t>(1, extent.texels() / kEnough));
    const auto band = [&](const Texture& from, int y, int height) -> Result<NormalMap> {
        const std::size_t begin = y > 0 ? level_bytes(from.format, {extent.width, y}) : 0;
        const std::size_t size = level_bytes(from.format, {extent.width, height});
        const std::byte* const bytes = from.levels.front().bytes.data() + begin;
        Texture one;
        one.format = from.format;
        one.levels.push_back({{extent.width, height}, std::vector<std::byte>(bytes, bytes + size)});
        one.swizzle = from.swizzle;
        one.y_axis = from.y_axis;
        one.normal_encoding = from.normal_encoding;
        auto chain = unpack(one, {}, execution);
        if (!chain) return chain.error();
        return std::move(chain->levels.front());
    };
    double sum = 0.0, rows = 0.0;
    for (int y = 0; y < extent.height; y += step) {
        const int height = std::min(kBand, extent.height - y);
        const auto a = band(before, y, height), b = band(after, y, height);
        if (!a || !b) return 0.0;
        const auto compared = compare(*a, *b, execution);
        if (!compared) return compared.error();
        sum += compared->error.mean * height;
        rows += height;
    }
    return sum / rows;
}

}  // namespace tex::inline v1
