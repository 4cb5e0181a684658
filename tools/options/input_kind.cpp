// SPDX-License-Identifier: Apache-2.0

#include "options/input_kind.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/format.h>

namespace tex::cli {
namespace {

struct Judgement {
    std::string_view rule;
    bool JudgedPicture::*what;
};

// By weight: the first one that is found decides.
constexpr Judgement kJudgements[] = {
    {"N210", &JudgedPicture::is_no_map},       {"N216", &JudgedPicture::is_no_map},
    {"N222", &JudgedPicture::is_no_map},       {"N220", &JudgedPicture::is_inverted},
    {"N213", &JudgedPicture::is_object_space}, {"N214", &JudgedPicture::is_no_map},
    {"N223", &JudgedPicture::is_x_ray},        {"N215", &JudgedPicture::has_background},
    {"N219", &JudgedPicture::is_other_blue},   {"N301", &JudgedPicture::is_damaged},
    {"N302", &JudgedPicture::is_damaged},      {"N303", &JudgedPicture::is_damaged},
    {"N313", &JudgedPicture::is_damaged},      {"N314", &JudgedPicture::is_damaged},
    {"N316", &JudgedPicture::is_subsampled},   {"N201", &JudgedPicture::is_uneven},
};

}  // namespace

std::optional<JudgedPicture> judge_picture(const std::string& path, const ReadOptions& read) {
    if (path.empty() || path == "-") return std::nullopt;
    const auto report = check_file(path, {}, read);
    if (!report || report->error) return std::nullopt;
    JudgedPicture judged;
    judged.height_bytes = report->height_bytes;
    judged.is_vectors = report->swizzle[2] == Component::z;
    judged.has_alpha = report->more_data && format_info(report->format).channels == 4;
    for (const Finding& finding : report->findings) judged.is_vectors &= finding.rule->id != "N206";
    for (const Judgement& judgement : kJudgements) {
        for (const Finding& finding : report->findings) {
            if (finding.rule->id != judgement.rule) continue;
            judged.*judgement.what = true;
            judged.words = fmt::format("{} ({})", finding.message, judgement.rule);
            return judged;
        }
    }
    return judged;
}

std::string no_map_text(const JudgedPicture& judged) { return "this is no normal map: " + judged.words; }

bool names_layout(const JudgedPicture& judged) { return judged.words.find("--swizzle") != std::string::npos; }

JudgedColours judge_colours(const std::string& path, const ReadOptions& read) {
    const std::optional<JudgedPicture> judged = judge_picture(path, read);
    if (judged && judged->height_bytes) {
        const std::string_view channel = name_of(kHeightChannelNames, *judged->height_bytes);
        return {
            fmt::format("R, G and B are the bytes of heights, as in map tiles; --channel {} reads them so", channel),
            judged->height_bytes};
    }
    if (!judged || !judged->is_vectors || judged->is_no_map) return {};
    if (judged->has_alpha) return {"this is a normal map; --channel a takes its alpha as heights"};
    return {
        "this is a normal map, and holds no heights; integrate-normals makes heights of it, pack-normals and "
        "mip-normals make textures"};
}

}  // namespace tex::cli
