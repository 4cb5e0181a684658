// SPDX-License-Identifier: Apache-2.0

#include "options/input_kind.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>

namespace tex::cli {
namespace {

struct KindOfRule {
    std::string_view id;
    InputKind kind;
};

// By weight: the first one that is found decides.
constexpr KindOfRule kKinds[] = {
    {"N210", InputKind::no_map},         {"N216", InputKind::no_map},       {"N222", InputKind::no_map},
    {"N220", InputKind::inverted},       {"N213", InputKind::object_space}, {"N214", InputKind::no_map},
    {"N215", InputKind::has_background},
};

}  // namespace

std::optional<JudgedPicture> judge_picture(const std::string& path, const ReadOptions& read) {
    if (path.empty() || path == "-") return std::nullopt;
    const auto report = check_file(path, {}, read);
    if (!report || report->error) return std::nullopt;
    JudgedPicture judged;
    judged.is_vectors = report->swizzle[2] == Component::z;
    for (const Finding& finding : report->findings) judged.is_vectors &= finding.rule->id != "N206";
    for (const KindOfRule& row : kKinds) {
        for (const Finding& finding : report->findings) {
            if (finding.rule->id != row.id) continue;
            judged.kind = row.kind;
            judged.words = fmt::format("{} ({})", finding.message, row.id);
            return judged;
        }
    }
    return judged;
}

std::string no_map_text(const JudgedPicture& judged) { return "this is no normal map: " + judged.words; }

std::string no_heights_text(const std::string& path, const ReadOptions& read) {
    const std::optional<JudgedPicture> judged = judge_picture(path, read);
    if (!judged || !judged->is_vectors || judged->kind == InputKind::no_map) return {};
    return "this is a normal map, and holds no heights; integrate-normals makes heights of it, pack-normals and "
           "mip-normals make textures";
}

}  // namespace tex::cli
