// SPDX-License-Identifier: Apache-2.0

#include "options/mips.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "tasks/engines.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

std::pair<Wrap, Wrap> parse_wraps(const std::string& text) {
    const auto [first, second] = cut(text, ',');
    const Wrap x = parse_word(first, kWrapNames);
    return {x, text.find(',') == std::string::npos ? x : parse_word(second, kWrapNames)};
}

void WrapOptions::add(Command& command, std::string help) {
    Option& row = command.option("--wrap", "W[,W]", std::move(help),
                                 [this](const std::string& text) { std::tie(x, y) = parse_wraps(text); });
    row.often(7, "what lies beyond the border: repeat, clamp or mirror").words = words_of(kWrapNames);
    row.completes = Completes::words;
    row.preset = name_of(kWrapNames, x);
}

void MipChainOptions::add(Command& command, bool with_keep, std::string levels_default) {
    with_keep_ = with_keep;
    command.group("Mip chain");
    Option& row = command.option(
        "--mips", "N", "levels, counting the base level: a number, or a word",
        [this, with_keep](const std::string& text) {
            keep = with_keep && text == "keep";
            if (text == "all" || keep) {
                levels = 0;
            } else if (text == "none") {
                levels = 1;
            } else {
                try {
                    levels = parse_int(text, 1, std::numeric_limits<int>::max());
                } catch (const UsageError&) {
                    throw UsageError(fmt::format("must be all, {}none or a number of at least 1, not '{}'{}",
                                                 with_keep ? "keep, " : "", printable(text),
                                                 text == "0" ? ": all builds every level, as 0 does elsewhere" : ""));
                }
            }
        });
    row.words = {{"all", "down to 1x1"}, {"none", "one level, the base level"}};
    if (with_keep) row.words.insert(row.words.begin() + 1, {"keep", "those of the source"});
    row.completes = Completes::words;
    row.often(4, with_keep ? "levels: all, keep, none or a number" : "levels: all, none or a number").preset =
        std::move(levels_default);

    command
        .number(mip.max_side, "--max-size", "N", 1, kMaxExtent,
                "halve the map until no side has more than N texels; smaller levels follow")
        .preset = "no limit";
    command.choice(mip.filter, "--mip-filter", "F", kMipFilterNames, "the filter from level to level");
    command.choice(mip.domain, "--mip-domain", "D", kMipDomainNames, "what is averaged");
    command.option("--fade", "FIRST,LAST", "fade to flat from level FIRST on; from LAST on all is flat",
                   [this](const std::string& text) {
                       const auto [first, last] = cut(text, ',');
                       Fade fade;
                       fade.first = parse_int(first, 0, 1000);
                       fade.last = parse_int(last, 0, 1000);
                       if (fade.first >= fade.last)
                           throw UsageError(fmt::format("{} is not less than {}", fade.first, fade.last));
                       mip.fade = fade;
                   });
}

void MipChainOptions::check_builds(const Command& command, const std::vector<Task>& tasks) const {
    const auto has_engine = [](const Task& task) { return task.engine != nullptr; };
    if (!keep && (levels || std::any_of(tasks.begin(), tasks.end(), has_engine))) return;
    const std::vector<std::string> idle = command.given_of({"--mip-filter", "--mip-domain", "--fade", "--wrap"});
    if (idle.empty()) return;
    throw UsageError(fmt::format("{} does nothing if levels are kept; --mips all builds them", idle.front()));
}

void MipChainOptions::check(const std::vector<Task>& tasks) const {
    if (!levels || *levels == 1 || keep) return;
    for (const Task& task : tasks) {
        if (can_hold_levels(task.container) || has_level(task.output)) continue;
        throw UsageError(
            fmt::format("{}: {} files hold one level; --mips needs .dds, .ktx2 or .exr, or a name with {{level}}",
                        printable(task.output), name_of(kContainerNames, task.container)));
    }
}

int MipChainOptions::levels_for(const Task& task) const {
    if (levels) return *levels;
    if (task.engine != nullptr && !has_level(task.output))
        return task.engine->has_mips && can_hold_levels(task.container) ? 0 : 1;
    return can_hold_blocks(task.container) || has_level(task.output) ? 0 : 1;
}

MipOptions MipChainOptions::options(int count, const WrapOptions& wrap) const {
    MipOptions with = mip;
    with.levels = count;
    with.wrap_x = wrap.x;
    with.wrap_y = wrap.y;
    return with;
}

}  // namespace tex::cli
