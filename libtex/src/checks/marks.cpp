// SPDX-License-Identifier: Apache-2.0

#include "checks/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tex::inline v1 {
namespace {

// A texel as the rules see it. Channels that do not exist are 1.
struct MarkedTexel {
    float x, y, z, length;
    float red, blue, alpha;
    bool has_z, in_blocks;
};

using Speaks = bool (*)(const MarkedTexel&);

constexpr float kLeastUnit = 1.0f - kTwoCodes, kMostUnit = 1.0f + kTwoCodes;

bool is_not_unit(const MarkedTexel& t) { return t.has_z && (t.length < kLeastUnit || t.length > kMostUnit); }
bool points_away(const MarkedTexel& t) { return t.has_z && t.z < -0.1f; }
bool is_upright(const MarkedTexel& t) { return std::max(std::abs(t.x), std::abs(t.y)) < 1.5f / 127.5f; }
bool is_beyond(const MarkedTexel& t) {
    const float most = t.in_blocks ? 1.3f : kMostUnit;
    return t.x * t.x + t.y * t.y > most * most;
}

// `keeps` says that the rule looks at all texels, those under alpha 0 and of the background, too.
struct MarkRow {
    std::string_view id;
    Speaks speaks;
    bool keeps = false;
};

constexpr MarkRow kRows[] = {
    {"N201", is_not_unit},
    {"N202", [](const MarkedTexel& t) { return t.has_z && t.z < -kTwoCodes; }},
    {"N203", is_beyond},
    {"N204", [](const MarkedTexel& t) { return !std::isfinite(t.x + t.y + t.z); }},
    {"N205", [](const MarkedTexel& t) { return t.has_z && t.length < kNullLength; }},
    {"N208", is_upright},
    {"N211", [](const MarkedTexel& t) { return t.red < 1.0f; }, true},
    {"N212", [](const MarkedTexel& t) { return t.alpha < 1.0f; }, true},
    {"N213", points_away},
    {"N214", [](const MarkedTexel& t) { return t.has_z && std::abs(t.length - 1.0f) > 0.12f; }},
    {"N216", [](const MarkedTexel& t) { return t.blue < 8.5f / 255.0f || t.blue > 246.5f / 255.0f; }},
    {"N217", [](const MarkedTexel& t) { return t.alpha == 0.0f; }, true},
    {"N220", points_away},
    {"N303", [](const MarkedTexel& t) { return t.alpha > 0.1f && t.alpha < 0.9f; }, true},
    {"N311", is_beyond},
};

const MarkRow* mark_row_of(const Finding& finding) {
    const auto* const found = std::find_if(std::begin(kRows), std::end(kRows),
                                           [&](const MarkRow& row) { return row.id == finding.rule->id; });
    return found == std::end(kRows) ? nullptr : found;
}

class Marker {
public:
    explicit Marker(const CheckContext& context)
        : context_(context), stored_(context.stored), extent_(context.base.extent()), x_(stored_.channel(Component::x)),
          y_(stored_.channel(Component::y)), z_(stored_.channel(Component::z)) {}

    // The marks of a finding; nothing if no texel spoke, and none was left out.
    [[nodiscard]] std::optional<Marks> marks_of(const Finding& finding) const {
        Marks marks;
        const int longest = std::max(extent_.width, extent_.height);
        marks.side = (longest + context_.options.marks - 1) / context_.options.marks;
        marks.extent = {(extent_.width + marks.side - 1) / marks.side, (extent_.height + marks.side - 1) / marks.side};
        marks.squares.resize(static_cast<std::size_t>(marks.extent.texels()));
        std::vector<Mark> row(static_cast<std::size_t>(extent_.width));
        std::vector<std::array<std::int64_t, kMarkCount>> counts(static_cast<std::size_t>(marks.extent.width));
        for (int j = 0; j < extent_.height; ++j) {
            mark_row(finding, j, row);
            for (std::size_t i = 0; i < row.size(); ++i)
                ++counts[i / static_cast<std::size_t>(marks.side)][static_cast<std::size_t>(row[i])];
            if ((j + 1) % marks.side != 0 && j + 1 != extent_.height) continue;
            for (std::size_t i = 0; i < counts.size(); ++i) {
                const auto at = static_cast<std::size_t>(j / marks.side) * counts.size() + i;
                marks.squares[at] = mark_of(counts[i]);
                for (std::size_t k = 0; k < counts[i].size(); ++k) marks.texels[k] += counts[i][k];
                counts[i] = {};
            }
        }
        if (marks.count(Mark::none) == extent_.texels()) return std::nullopt;
        return marks;
    }

private:
    static Mark mark_of(const std::array<std::int64_t, kMarkCount>& counts) {
        if (counts[static_cast<std::size_t>(Mark::spoke)] > 0) return Mark::spoke;
        return static_cast<Mark>(std::max_element(counts.begin(), counts.end()) - counts.begin());
    }

    void mark_row(const Finding& finding, int j, std::vector<Mark>& marks) const {
        std::fill(marks.begin(), marks.end(), Mark::none);
        const RuleFamily family = finding.rule->family;
        const MarkRow* const row = mark_row_of(finding);
        if (family == RuleFamily::values || family == RuleFamily::damage || family == RuleFamily::convention) {
            if (row == nullptr || !row->keeps) leave_out(j, marks);
            if (context_.mixed_y && finding.rule->id == "N402")
                mark_regions(context_.mixed_y->streaks, j, Mark::padding, marks);
        }
        if (finding.rule->id == "N215") return mark_background(j, marks);
        if (row != nullptr) return mark_speakers(*row, j, marks);
        const bool is_one_texel = finding.has_texel && finding.regions.size() == 1;
        if (!is_one_texel) mark_regions(finding.regions, j, Mark::spoke, marks);
    }

    void leave_out(int j, std::vector<Mark>& marks) const {
        if (!context_.background) return;
        const Background& background = *context_.background;
        for (int i = 0; i < extent_.width; ++i) {
            if (!background.holds(i, j)) continue;
            marks[static_cast<std::size_t>(i)] = background.is_transparent(i, j) ? Mark::transparent : Mark::background;
        }
    }

    void mark_background(int j, std::vector<Mark>& marks) const {
        if (!context_.background) return;
        const Background& background = *context_.background;
        for (int i = 0; i < extent_.width; ++i) {
            if (background.holds(i, j) && !background.is_transparent(i, j) && !background.is_mixed(i, j))
                marks[static_cast<std::size_t>(i)] = Mark::spoke;
        }
    }

    void mark_speakers(const MarkRow& row, int j, std::vector<Mark>& marks) const {
        if (x_ < 0 || y_ < 0) return;
        for (int i = 0; i < extent_.width; ++i) {
            Mark& mark = marks[static_cast<std::size_t>(i)];
            if (mark == Mark::none && row.speaks(texel(i, j))) mark = Mark::spoke;
        }
    }

    static void mark_regions(const std::vector<Region>& regions, int j, Mark mark, std::vector<Mark>& marks) {
        for (const Region& region : regions) {
            if (region.level != 0 || j < region.y || j >= region.y + region.height) continue;
            const auto end = std::min(marks.size(), static_cast<std::size_t>(region.x + region.width));
            for (auto i = static_cast<std::size_t>(std::max(0, region.x)); i < end; ++i) {
                if (marks[i] == Mark::none || marks[i] == Mark::padding) marks[i] = mark;
            }
        }
    }

    [[nodiscard]] MarkedTexel texel(int i, int j) const {
        const auto channel = [&](std::size_t c) {
            return c < context_.base.planes.size() ? context_.base.planes[c].at(i, j) : 1.0f;
        };
        MarkedTexel t{stored_.component(x_, i, j),
                      stored_.component(y_, i, j),
                      0.0f,
                      0.0f,
                      channel(0),
                      channel(2),
                      channel(3),
                      z_ >= 0,
                      stored_.in_blocks};
        if (z_ >= 0) t.z = stored_.component(z_, i, j);
        t.length = std::sqrt(t.x * t.x + t.y * t.y + t.z * t.z);
        return t;
    }

    const CheckContext& context_;
    const Stored& stored_;
    const Extent extent_;
    const int x_, y_, z_;
};

}  // namespace

void mark_texels(const CheckContext& context, std::vector<Finding>& findings) {
    if (context.base.planes.empty()) return;
    const Marker marker(context);
    for (Finding& finding : findings) finding.marks = marker.marks_of(finding);
}

}  // namespace tex::inline v1
