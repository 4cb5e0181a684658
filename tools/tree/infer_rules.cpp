// SPDX-License-Identifier: Apache-2.0

#include "tree/infer_rules.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "cli/glob.h"
#include "cli/text.h"

namespace tex::cli {
namespace {

// The ends of names in lower case, without what separates them.
constexpr std::string_view kNormalWords[] = {"n",       "nm",        "nrm",  "nrml", "norm",     "normal",
                                             "normals", "normalmap", "nmap", "nor",  "normalgl", "normaldx"};
constexpr std::string_view kHeightWords[] = {"h",    "height", "heights",      "heightmap", "hmap",
                                             "disp", "dem",    "displacement", "bump",      "elevation"};

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

// A name as a pattern that matches nothing else.
std::string pattern_of(std::string_view name) {
    std::string pattern;
    for (const char c : name) {
        if (std::string_view("*?[]{}\\,").find(c) != std::string_view::npos) pattern += '\\';
        pattern += c;
    }
    return pattern;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

std::string stem_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

std::string extension_of(const std::string& path) {
    std::string extension = lower_case(std::filesystem::path(path).extension().string());
    if (!extension.empty()) extension.erase(0, 1);
    return extension;
}

// ".png", or ".{png,tga}".
std::string extensions_of(const std::set<std::string>& extensions) {
    if (extensions.size() == 1) return "." + pattern_of(*extensions.begin());
    std::string text;
    for (const std::string& extension : extensions) text += (text.empty() ? "" : ",") + pattern_of(extension);
    return ".{" + text + "}";
}

class Inference {
public:
    explicit Inference(const std::vector<SettingsOfFile>& files) : files_(files), is_taken_(files.size(), false) {}

    InferredRule rule(const std::string& settings) {
        InferredRule rule;
        rule.settings = settings;
        constexpr std::size_t kFew = 2;  // a single file is named instead
        for (const auto& parts : {&Inference::everywhere, &Inference::in_folder, &Inference::whole_folder}) {
            std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> groups;
            for (std::size_t k = 0; k < files_.size(); ++k) {
                if (!is_taken_[k] && files_[k].settings == settings)
                    groups[(this->*parts)(files_[k].path)].push_back(k);
            }
            for (const auto& [key, members] : groups) {
                if (members.size() < kFew || (key.second.empty() && parts != &Inference::whole_folder)) continue;
                std::set<std::string> extensions;
                for (const std::size_t k : members) extensions.insert(extension_of(files_[k].path));
                try_pattern(key.first + "*" + key.second + extensions_of(extensions), rule);
            }
        }
        for (std::size_t k = 0; k < files_.size(); ++k) {
            if (is_taken_[k] || files_[k].settings != settings) continue;
            rule.match.push_back(pattern_of(files_[k].path));
            take(k, rule);
        }
        return rule;
    }

    // What no rule has taken, and several would be right for.
    [[nodiscard]] std::vector<std::size_t> rest() const {
        std::vector<std::size_t> rest;
        for (std::size_t k = 0; k < files_.size(); ++k) {
            if (!is_taken_[k] && files_[k].settings.empty() && !files_[k].also.empty()) rest.push_back(k);
        }
        return rest;
    }

    void take(std::size_t k, InferredRule& rule) {
        is_taken_[k] = true;
        rule.files.push_back(files_[k].path);
    }

private:
    using Parts = std::pair<std::string, std::string>;  // what stands before and after the "*"

    [[nodiscard]] Parts everywhere(const std::string& path) const { return {"**/", pattern_of(name_end(path))}; }
    [[nodiscard]] Parts in_folder(const std::string& path) const {
        return {pattern_of(folder_of(path)), pattern_of(name_end(path))};
    }
    [[nodiscard]] Parts whole_folder(const std::string& path) const { return {pattern_of(folder_of(path)), ""}; }

    [[nodiscard]] static bool fits(const SettingsOfFile& file, const std::string& settings) {
        return file.settings == settings || std::find(file.also.begin(), file.also.end(), settings) != file.also.end();
    }

    // Uses the pattern if it matches nothing that other rules are for. (The first rule that matches a file has it.)
    void try_pattern(const std::string& text, InferredRule& rule) {
        const Glob glob(text);
        std::vector<std::size_t> matched, excluded;
        for (std::size_t k = 0; k < files_.size(); ++k) {
            const SettingsOfFile& file = files_[k];
            if (is_taken_[k] || !glob.matches(file.path)) continue;
            if (fits(file, rule.settings)) {
                matched.push_back(k);
            } else if (file.is_left_out) {
                excluded.push_back(k);
            } else {
                return;
            }
        }
        if (matched.empty()) return;
        rule.match.push_back(text);
        for (const std::size_t k : matched) take(k, rule);
        for (const std::size_t k : excluded) {
            const std::string name = pattern_of(files_[k].path);
            if (std::find(rule.exclude.begin(), rule.exclude.end(), name) == rule.exclude.end())
                rule.exclude.push_back(name);
        }
    }

    const std::vector<SettingsOfFile>& files_;
    std::vector<bool> is_taken_;
};

}  // namespace

std::string name_end(const std::string& path) {
    const std::string stem = stem_of(path);
    std::size_t begin = stem.find_last_of("_-. ");
    if (begin == std::string::npos || begin + 1 == stem.size()) {
        begin = stem.size();
        while (begin > 0 && is_lower(stem[begin - 1])) --begin;
        if (begin < 2 || !is_upper(stem[begin - 1])) return {};
        --begin;
        if (!is_lower(stem[begin - 1])) return {};
    }
    const std::string end = stem.substr(begin);
    const bool has_letter = std::any_of(end.begin(), end.end(), [](char c) { return is_upper(c) || is_lower(c); });
    return has_letter ? end : std::string();
}

std::string name_beginning(const std::string& path) {
    const std::string stem = stem_of(path);
    return folder_of(path) + stem.substr(0, stem.size() - name_end(path).size());
}

NamedAs named_as(const std::string& path) {
    std::string end = lower_case(name_end(path));
    end.erase(0, std::min(end.find_first_not_of("_-. "), end.size()));
    if (end.empty()) end = lower_case(stem_of(path));
    const auto is_one_of = [&](const auto& words) {
        return std::find(std::begin(words), std::end(words), end) != std::end(words);
    };
    if (is_one_of(kNormalWords)) return NamedAs::normals;
    return is_one_of(kHeightWords) ? NamedAs::heights : NamedAs::other;
}

std::vector<InferredRule> infer_rules(const std::vector<SettingsOfFile>& files) {
    std::map<std::string, std::size_t> count;
    for (const SettingsOfFile& file : files) {
        if (!file.settings.empty()) ++count[file.settings];
    }
    // The fewest first: they are the exceptions, and patterns of the many then take all that is left.
    std::vector<std::string> order;
    for (const auto& [settings, number] : count) order.push_back(settings);
    std::stable_sort(order.begin(), order.end(),
                     [&](const std::string& a, const std::string& b) { return count[a] < count[b]; });
    Inference inference(files);
    std::vector<InferredRule> rules;
    for (const std::string& settings : order) rules.push_back(inference.rule(settings));
    // The rest goes to the settings that are right for it and are those of most files in its folder; if there are none,
    // to the most frequent ones.
    const auto folder_of = [](const std::string& path) { return path.substr(0, path.rfind('/') + 1); };
    std::map<std::pair<std::string, std::string>, std::size_t> number;  // of files, by settings and folder
    for (const InferredRule& rule : rules) {
        for (const std::string& file : rule.files) ++number[{rule.settings, folder_of(file)}];
    }
    for (const std::size_t k : inference.rest()) {
        const auto& also = files[k].also;
        auto rule = rules.end();
        std::size_t most = 0;
        for (auto candidate = rules.begin(); candidate != rules.end(); ++candidate) {
            if (std::find(also.begin(), also.end(), candidate->settings) == also.end()) continue;
            const auto its = number.find({candidate->settings, folder_of(files[k].path)});
            const std::size_t beside = its != number.end() ? its->second : 0;
            if (rule != rules.end() && beside < most) continue;
            rule = candidate;
            most = beside;
        }
        if (rule == rules.end()) rule = rules.insert(rules.end(), InferredRule{{}, {}, also.front(), {}});
        rule->match.push_back(pattern_of(files[k].path));
        inference.take(k, *rule);
    }
    return rules;
}

}  // namespace tex::cli
