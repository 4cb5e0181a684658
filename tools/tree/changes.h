// SPDX-License-Identifier: Apache-2.0
// changes.h: what makes an output out of date, in words and as JSON.

#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/json.h"
#include "tree/sha256.h"

namespace tex::cli {

// Settings, each by the name of its step and option: {"blend tiling", "8"}.
using NamedValues = std::vector<std::pair<std::string, std::string>>;
using NamedDigests = std::vector<std::pair<std::string, Digest>>;

// One setting that is not what it was, or one file whose contents are not.
struct Change {
    std::string setting;  // empty: a file
    std::string before, after;
    std::string file = {};
};

// What differs between two lists of settings. `preset` says which value a setting has that is not in a list.
[[nodiscard]] std::vector<Change> changed_settings(const NamedValues& before, const NamedValues& after,
                                                   const std::function<std::string(const std::string& name)>& preset);

// The files whose contents differ, or that only one of the lists has.
[[nodiscard]] std::vector<Change> changed_files(const NamedDigests& before, const NamedDigests& after);

// "tiling: 8 to 6; shared/grain.png changed", fit to be printed.
[[nodiscard]] std::string words_of(const std::vector<Change>& changes);
[[nodiscard]] Json json_of(const std::vector<Change>& changes);

}  // namespace tex::cli
