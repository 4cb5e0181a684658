// SPDX-License-Identifier: Apache-2.0

#include "tree/changes.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "cli/text.h"
#include "tree/json_line.h"

namespace tex::cli {
namespace {

template <class Value>
const Value* find_named(const std::vector<std::pair<std::string, Value>>& list, const std::string& name) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.first == name; });
    return found == list.end() ? nullptr : &found->second;
}

template <class Value>
std::vector<std::string> names_of_both(const std::vector<std::pair<std::string, Value>>& before,
                                       const std::vector<std::pair<std::string, Value>>& after) {
    std::vector<std::string> names;
    for (const auto& [name, value] : after) names.push_back(name);
    for (const auto& [name, value] : before) {
        if (find_named(after, name) == nullptr) names.push_back(name);
    }
    return names;
}

// The name of the option alone.
std::string short_name(const std::string& setting) {
    const std::size_t space = setting.rfind(' ');
    return space == std::string::npos ? setting : setting.substr(space + 1);
}

}  // namespace

std::vector<Change> changed_settings(const NamedValues& before, const NamedValues& after,
                                     const std::function<std::string(const std::string& name)>& preset) {
    std::vector<Change> changes;
    for (const std::string& name : names_of_both(before, after)) {
        const std::string *const old = find_named(before, name), *const now = find_named(after, name);
        if (old != nullptr && now != nullptr && *old == *now) continue;
        const auto value = [&](const std::string* given) {
            if (given != nullptr) return *given;
            const std::string otherwise = preset(name);
            return otherwise.empty() ? "default" : otherwise + " (default)";
        };
        changes.push_back({name, value(old), value(now)});
    }
    return changes;
}

std::vector<Change> changed_files(const NamedDigests& before, const NamedDigests& after) {
    std::vector<Change> changes;
    for (const std::string& name : names_of_both(before, after)) {
        const Digest *const old = find_named(before, name), *const now = find_named(after, name);
        if (old == nullptr || now == nullptr || *old != *now) changes.push_back({{}, {}, {}, name});
    }
    return changes;
}

std::string words_of(const std::vector<Change>& changes) {
    std::multiset<std::string> short_names;
    for (const Change& change : changes) short_names.insert(short_name(change.setting));
    std::vector<std::string> words;
    for (const Change& change : changes) {
        if (change.setting.empty()) {
            words.push_back(printable(change.file) + " changed");
            continue;
        }
        const std::string name = short_name(change.setting);
        words.push_back(fmt::format("{}: {} to {}", short_names.count(name) > 1 ? change.setting : name,
                                    printable(change.before), printable(change.after)));
    }
    return join(words, "; ");
}

Json json_of(const std::vector<Change>& changes) {
    Json json = Json::array();
    for (const Change& change : changes) {
        if (change.setting.empty()) {
            json.push_back({{"file", name_json(change.file)}});
        } else {
            json.push_back({{"setting", change.setting}, {"from", change.before}, {"to", change.after}});
        }
    }
    return json;
}

}  // namespace tex::cli
