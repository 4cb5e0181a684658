// SPDX-License-Identifier: Apache-2.0

#include "options/pair.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/text.h"
#include "options/magnified.h"

namespace tex::cli {

void PairOptions::add(Command& command) {
    command.group("What is compared");
    command.choice(y_[0], "--y-a", "Y", kYAxisNames, "which way green points in A, instead of what the file says");
    command.choice(y_[1], "--y-b", "Y", kYAxisNames, "which way green points in B")
        .often(1, "which way green points in B: up or down");
    command.choice(as_, "--as", "F", kGpuFormatNames,
                   "B is UASTC or ETC1S: compare what a loader makes of it for a GPU that reads F");
    command.flag(magnifies_, "--magnify",
                 "of maps of unequal extents, enlarge the smaller one as a shader does from near");
    command
        .option("--level", "N", "the level, 0 being the base level, or all that both have",
                [this](const std::string& text) {
                    all_levels_ = text == "all";
                    if (!all_levels_) level_ = parse_int(text, 0, 31);
                })
        .often(2, "the level, from 0, or all")
        .preset = std::to_string(level_);
    command.group("Limits");
    const auto add_limit = [&](std::optional<double>& limit, const char* name, const char* figure, int rank) {
        const std::string help = fmt::format("fail (exit 1) if the {} is greater", figure);
        Option& row = command.option(name, "DEGREES", help, [&limit](const std::string& text) {
            limit = parse_double(text, {0.0, 180.0});
        });
        if (rank > 0) row.often(rank, help);
    };
    add_limit(max_mean_, "--max-mean", "mean", 2);
    add_limit(max_p99_, "--max-p99", "99th percentile", 0);
    add_limit(max_p999_, "--max-p999", "99.9th percentile", 6);
    add_limit(max_, "--max", "largest angle", 2);
}

Result<Texture> PairOptions::read(const ComparedMap& map, int which, const ReadOptions& read, Console& console,
                                  const Execution& execution) {
    const std::string& path = map.path();
    const auto opened = map.open(read);
    if (!opened) return opened.error();
    auto texture = read_texture(path, *opened);
    if (!texture) return texture.error();
    const auto silent = [&console](double) { return console.host().interruption().empty(); };
    const auto swizzle = guess_swizzle(*texture, {execution.threads, silent});
    if (!swizzle) return swizzle.error().of(path);
    if (*swizzle != texture->swizzle && warned_of_.insert(path).second) {
        warn(console, path, fmt::format("layout not stated; guessed {} from the texels", layout_name(*swizzle)));
    }
    texture->swizzle = *swizzle;
    texture->y_axis = y_[which].value_or(texture->y_axis);
    if (which == 0 || !as_) return texture;
    auto shown = transcode(*texture, *as_, {execution.threads, silent});
    return shown ? std::move(shown) : shown.error().of(path);
}

Result<MipChain> PairOptions::read_levels(const ComparedMap& map, int which, const ReadOptions& read_options,
                                          Console& console, const Execution& execution) {
    const std::string& path = map.path();
    if (which == 1 && as_) {
        const auto texture = read(map, which, read_options, console, execution);
        if (!texture) return texture.error();
        info_[which].y_axis = texture->y_axis;
        return unpack(*texture, {}, execution);
    }
    auto opened = map.open(read_options);
    if (!opened) return opened.error();
    SourceOptions options;
    options.read = std::move(*opened);
    options.unpack.y_axis = y_[which];
    options.doubt_y = options.inspect = true;
    auto source = read_normals(path, options, false, execution);
    if (!source) return source.error();
    info_[which] = std::move(source->info);
    const SourceInfo& info = info_[which];
    if (info.guessed && warned_of_.insert(path).second)
        warn(console, path, fmt::format("layout not stated; guessed {} from the texels", layout_name(info.swizzle)));
    return std::move(source->chain);
}

void PairOptions::warn_of_doubts(const std::vector<std::string>& names, Console& console) {
    const char* const options[] = {"--y-a", "--y-b"};
    if (!y_[0] && !y_[1] && info_[0].y_axis != info_[1].y_axis) {
        warn(console, names[1],
             fmt::format("green points {} here, and {} in {}: the normals are compared, not their codes",
                         name_of(kYAxisNames, info_[1].y_axis), name_of(kYAxisNames, info_[0].y_axis), names[0]));
    }
    const bool differ = info_[0].y_doubtful != info_[1].y_doubtful;
    for (std::size_t k = 0; k < 2; ++k) {
        const SourceInfo& info = info_[k];
        if (info.y_doubtful && differ) {
            const char* const other = info.y_axis == YAxis::up ? "down" : "up";
            warn(console, names[k],
                 fmt::format("green is taken to point {}, but the texels show the other direction: {} {}",
                             name_of(kYAxisNames, info.y_axis), options[k], other));
        }
        if (info.object_space && !info_[1 - k].object_space)
            warn(console, names[k], "its vectors face all directions, as in object space");
    }
}

std::pair<std::size_t, std::size_t> PairOptions::levels(const MipChain& a, const MipChain& b,
                                                        const std::vector<std::string>& names, Console& console) {
    const auto first = static_cast<std::size_t>(level_);
    if (!all_levels_) return {first, first + 1};
    if (a.levels.size() != b.levels.size()) {
        const std::size_t counts[] = {a.levels.size(), b.levels.size()};
        const std::size_t more = counts[0] > counts[1] ? 0 : 1;
        warn(console, names[more],
             fmt::format("has {} levels, {} has {}; only those that both have are compared", counts[more],
                         names[1 - more], counts[1 - more]));
    }
    return {0, std::min(a.levels.size(), b.levels.size())};
}

void PairOptions::magnify(MipChain& a, MipChain& b) const {
    if (!magnifies_ || a.levels.empty() || b.levels.empty()) return;
    const Extent p = a.levels.front().extent(), q = b.levels.front().extent();
    if (p.width < q.width || p.height < q.height) a.levels.front() = magnified(a.levels.front(), q);
    if (q.width < p.width || q.height < p.height) b.levels.front() = magnified(b.levels.front(), p);
}

void PairOptions::warn(Console& console, const std::string& file, const std::string& sentence) {
    console.warning(fmt::format("{}: {}", file, sentence));
    warnings_.push_back({file, sentence});
}

Result<void> PairOptions::check_level(std::size_t level, const MipChain& a, const MipChain& b, const MapPair& pair) {
    const std::vector<std::string> names = pair.names();
    const MipChain* const chains[] = {&a, &b};
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t count = chains[k]->levels.size();
        if (level < count) continue;
        return Error{ErrorCode::bad_option, names[k],
                     fmt::format("has {} level{}, so none of number {}", count, count == 1 ? "" : "s", level)};
    }
    const Extent p = a.levels[level].extent(), q = b.levels[level].extent();
    if (p == q) return {};
    const bool a_is_larger = p.width > q.width;
    const Extent &large = a_is_larger ? p : q, &small = a_is_larger ? q : p;
    std::string advice;
    for (int halvings = 1; level_extent(large, halvings).width >= small.width && large.width > small.width;
         ++halvings) {
        if (level_extent(large, halvings) != small) continue;
        const ComparedMap& larger = pair.maps[a_is_larger ? 0 : 1];
        const std::string map = !larger.model ? shell_word(larger.file)
                                              : fmt::format("{} --material {}", shell_word(larger.model->file),
                                                            shell_word(larger.model->material));
        advice = fmt::format(
            "; pack-normals {} --max-size {} -o SMALL{} makes a map of that extent, and --magnify compares them as a "
            "shader shows both from near",
            map, std::max(small.width, small.height), larger.model ? ".png" : "");
        break;
    }
    return Error{ErrorCode::bad_option, names[1],
                 fmt::format("is {}x{} texels, {} is {}x{}{}", q.width, q.height, names[0], p.width, p.height, advice)};
}

std::vector<std::string> PairOptions::violations(int level, const AngularError& error) const {
    std::vector<std::string> sentences;
    const auto hold = [&](const char* name, double figure, std::optional<double> limit) {
        if (!limit || figure <= *limit) return;
        sentences.push_back(
            fmt::format("level {}: {} {:.4f} degrees is over the limit of {}", level, name, figure, *limit));
    };
    hold("mean", error.mean, max_mean_);
    hold("p99", error.p99, max_p99_);
    hold("p99.9", error.p999, max_p999_);
    hold("max", error.max, max_);
    return sentences;
}

}  // namespace tex::cli
