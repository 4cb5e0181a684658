// SPDX-License-Identifier: Apache-2.0

#include "options/folder_pairs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include <tex/mesh.h>

#include "options/input_kind.h"
#include "tasks/find_files.h"

namespace tex::cli {
namespace {

using Pictures = std::map<std::string, std::string>;            // files by their names below the folder
using Stems = std::map<std::string, std::vector<std::string>>;  // such names by their part before the extension

Result<Pictures> pictures_of(const std::string& folder) {
    const Result<FolderPictures> found = pictures_below(folder);
    if (!found) return found.error();
    Pictures pictures;
    for (const std::string& file : found->files)
        pictures.emplace(std::filesystem::path(file).lexically_relative(folder).generic_string(), file);
    return pictures;
}

Stems stems_of(const Pictures& pictures) {
    Stems stems;
    for (const auto& [name, file] : pictures)
        stems[std::filesystem::path(name).replace_extension().generic_string()].push_back(name);
    return stems;
}

std::string taken(Pictures& pictures, const std::string& name) { return std::move(pictures.extract(name).mapped()); }

bool holds_no_map(const std::string& file, const ReadOptions& read) {
    if (is_model(file)) return false;
    const std::optional<JudgedPicture> judged = judge_picture(file, read);
    return judged && judged->is_no_map;
}

}  // namespace

Result<FolderPairs> folder_pairs(const std::string& a, const std::string& b, const ReadOptions& read) {
    Pictures left[2];
    for (int k = 0; k < 2; ++k) {
        auto pictures = pictures_of(k == 0 ? a : b);
        if (!pictures) return pictures.error();
        left[k] = std::move(*pictures);
    }
    std::vector<std::pair<std::string, std::string>> partners;  // names below the folders
    for (const auto& [name, file] : left[0]) {
        if (left[1].count(name) > 0) partners.emplace_back(name, name);
    }
    FolderPairs pairs;
    const auto take_partners = [&] {
        for (const auto& [name_a, name_b] : partners) {
            const std::string file_a = taken(left[0], name_a), file_b = taken(left[1], name_b);
            if (holds_no_map(file_a, read)) {
                ++pairs.others;
            } else {
                pairs.files.emplace_back(file_a, file_b);
            }
        }
        partners.clear();
    };
    take_partners();
    const Stems stems_a = stems_of(left[0]), stems_b = stems_of(left[1]);
    for (const auto& [stem, names] : stems_a) {
        const auto same = stems_b.find(stem);
        if (same != stems_b.end() && names.size() == 1 && same->second.size() == 1)
            partners.emplace_back(names.front(), same->second.front());
    }
    take_partners();
    for (int k = 0; k < 2; ++k) {
        for (const auto& [name, file] : left[k]) pairs.alone[k].push_back(file);
    }
    std::sort(pairs.files.begin(), pairs.files.end());
    return pairs;
}

}  // namespace tex::cli
