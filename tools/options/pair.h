// SPDX-License-Identifier: Apache-2.0
// pair.h: the option groups for two maps, A and B, that are compared: how they are read, and how far they may differ.

#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tex/check.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/transcode.h>
#include <tex/types.h>

#include "cli/command.h"
#include "cli/json.h"
#include "options/map_pairs.h"

namespace tex::cli {

// --y-a, --y-b, --as, --magnify, --level, --max-mean, --max-p99, --max-p999, --max.
class PairOptions {
public:
    void add(Command& command);

    // Reads the texture of A (0) or B (1). If the file does not give its swizzle, the swizzle is guessed from the
    // texels, with one warning for each file. The options for y override the file. B is transcoded for --as.
    [[nodiscard]] Result<Texture> read(const ComparedMap& map, int which, const ReadOptions& read, Console& console,
                                       const Execution& execution);
    [[nodiscard]] Result<MipChain> read_levels(const ComparedMap& map, int which, const ReadOptions& read,
                                               Console& console, const Execution& execution);

    // Warns of maps that were read by read_levels() and seem to hold something else. If both are in doubt about y, they
    // are compared in the same direction, and nothing is said.
    void warn_of_doubts(const std::vector<std::string>& names, Console& console);

    // The first level that is compared, and the level after the last one. Warns if the maps differ in their number of
    // levels.
    [[nodiscard]] std::pair<std::size_t, std::size_t> levels(const MipChain& a, const MipChain& b,
                                                             const std::vector<std::string>& names, Console& console);
    // With --magnify: enlarges the first level of the smaller map to the extent of the other's.
    void magnify(MipChain& a, MipChain& b) const;
    [[nodiscard]] bool magnifies() const { return magnifies_; }
    // Returns an error if a map lacks `level` or if the two differ in extent there.
    [[nodiscard]] static Result<void> check_level(std::size_t level, const MipChain& a, const MipChain& b,
                                                  const MapPair& pair);

    // A sentence for each figure of a level that is above its limit.
    [[nodiscard]] std::vector<std::string> violations(int level, const AngularError& error) const;

    void warn(Console& console, const std::string& file, const std::string& sentence);
    // The warnings so far, or since forget_warnings().
    [[nodiscard]] const std::vector<FileWarning>& warnings() const { return warnings_; }
    void forget_warnings() { warnings_.clear(); }

private:
    std::optional<YAxis> y_[2];
    std::optional<GpuFormat> as_;
    int level_ = 0;
    bool all_levels_ = false, magnifies_ = false;
    std::optional<double> max_mean_, max_p99_, max_p999_, max_;  // degrees
    std::set<std::string> warned_of_;                            // files
    SourceInfo info_[2];
    std::vector<FileWarning> warnings_;
};

}  // namespace tex::cli
