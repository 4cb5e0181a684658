// SPDX-License-Identifier: Apache-2.0
// pair.h: the option groups of two maps that are compared, A and B: how they are read, how far they may lie apart.

#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tex/check.h>
#include <tex/compare.h>
#include <tex/image_io.h>
#include <tex/mip_chain.h>
#include <tex/texture.h>

#include "cli/command.h"

namespace tex::cli {

// --y-a, --y-b, --level, --max-mean, --max-p999, --max.
class PairOptions {
public:
    void add(Command& command);

    // The texture of A (0) or B (1), with the swizzle that its texels show if it does not say its own, and with what
    // the options say about y. Warns about a guess, once for each file.
    [[nodiscard]] Result<Texture> read(const std::string& path, int which, const ReadOptions& read, Console& console,
                                       const Execution& execution);
    [[nodiscard]] Result<MipChain> read_levels(const std::string& path, int which, const ReadOptions& read,
                                               Console& console, const Execution& execution);

    // The first level that is compared, and the one behind the last. Warns if the maps differ in how many they have.
    [[nodiscard]] std::pair<std::size_t, std::size_t> levels(const MipChain& a, const MipChain& b,
                                                             const std::vector<std::string>& names,
                                                             Console& console) const;
    // The error, if a map lacks `level` or the two differ in extent; `names` are their files.
    [[nodiscard]] static Result<void> check_level(std::size_t level, const MipChain& a, const MipChain& b,
                                                  const std::vector<std::string>& names);

    // ExitCode::findings, with an error for each figure that is over its limit, or ExitCode::done.
    [[nodiscard]] ExitCode judge(Console& console, int level, const AngularError& error) const;

private:
    std::optional<YAxis> y_[2];
    int level_ = 0;
    bool all_levels_ = false;
    std::optional<double> max_mean_, max_p999_, max_;  // degrees
    std::set<std::string> warned_of_;                  // files
};

}  // namespace tex::cli
