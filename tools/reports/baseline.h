// SPDX-License-Identifier: Apache-2.0
// baseline.h: findings that a project has accepted.
//
// A JSON file to be kept beside the textures: {"version": 1, "findings": [{"file": "a.dds", "id": "N201", "level": 0},
// ...]}, sorted, with one finding on each line. A finding is identified by its file, rule and level; its figures may
// change.

#pragma once

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <tex/check.h>

namespace tex::cli {

class Baseline {
public:
    // Errors: io, bad_data.
    [[nodiscard]] static Result<Baseline> read(const std::string& path);
    // The same from memory. `path` appears in messages. Errors: bad_data.
    [[nodiscard]] static Result<Baseline> parse(const std::string& path, const std::string& text);

    // Adds the findings of the report to the known ones.
    void add(const CheckReport& report);
    // Removes known findings from the report. Returns their number.
    int accept(CheckReport& report) const;
    [[nodiscard]] std::string text() const;

private:
    using Key = std::tuple<std::string, std::string, int>;  // file, id, level
    [[nodiscard]] static Key key_of(const CheckReport& report, const Finding& finding);

    std::set<Key> known_;
};

}  // namespace tex::cli
