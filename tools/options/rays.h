// SPDX-License-Identifier: Apache-2.0
// rays.h: the option groups of transfers from mesh to mesh: the rays, what may be missed, and the maps beside the
// output.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/conversion.h"
#include "options/maps.h"
#include "tasks/job.h"

namespace tex::cli {

// --size, --subsamples, --rays, --front, --back, --hit, --backfaces, --straight-angle, --straight-width, --padding,
// --overlap, --max-missed.
class RayOptions {
public:
    void add(Command& command);

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] const TransferOptions& transfer() const { return transfer_; }

    // Reports what the rays found, with warnings about what they did not, and raises the exit code if more texels are
    // missed than --max-missed allows.
    [[nodiscard]] Result<void> judge(Job& job, const TransferredMaps& maps) const;

private:
    void add_coverage(Command& command);
    void judge_missed(Job& job, const TransferredMaps& maps) const;

    Extent extent_{2048, 2048};
    TransferOptions transfer_;
    Overlap overlap_ = Overlap::first;
    std::optional<double> max_missed_;  // percent
};

// "rays reach 0.1 in front and 0.2 behind; heights are from -0.05 to 0.06"
[[nodiscard]] std::string reach_of(const TransferredMaps& maps);

// --object-out, --height-out, --position-out.
class TransferMaps {
public:
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const;
    // Sets the maps that are wanted.
    void request(TransferOptions& options) const;

    // Write what the user wants, and add it to the job's report.
    [[nodiscard]] Result<void> write(Job& job, TransferredMaps& maps) const;

private:
    [[nodiscard]] Result<void> write_object(Job& job, NormalMap normals) const;
    [[nodiscard]] Result<void> write_heights(Job& job, TransferredMaps& maps) const;
    [[nodiscard]] Result<void> write_positions(Job& job, TransferredMaps& maps) const;

    MapOutput object_, heights_, positions_;
};

}  // namespace tex::cli
