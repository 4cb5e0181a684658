// SPDX-License-Identifier: Apache-2.0
// guides.h: the option group of what guides rays beside the meshes: --cage, --skew, --offset.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/tangent_space.h"
#include "tasks/job.h"

namespace tex::cli {

// What the files hold, for one job.
struct Guides {
    std::optional<MeshSpace> cage;
    Plane<float> skew, offset;

    // What transfer() takes; valid as long as this stays where it is.
    void fill(TransferInputs& inputs) const;
};

class GuideOptions {
public:
    void add(Command& command);

    // Rays must be straight for --skew, which turns them so if the user has not chosen any.
    [[nodiscard]] bool wants_straight() const { return !skew_.empty(); }

    // What to change where rays are too short, instead of --front: nothing if neither --cage nor --offset is given.
    [[nodiscard]] const char* remedy() const;

    // Adds the files to the task.
    void amend(Task& task) const;

    // Reads them. `low` says which parts of the cage count, and `space` what they are compared with.
    [[nodiscard]] Result<Guides> read(Job& job, const TangentSpaceOptions& low, const MeshSpace& space) const;

private:
    // The files of a job by the patterns, empty for those that are not given.
    [[nodiscard]] static std::string name_of(const std::string& pattern, const Task& task);
    [[nodiscard]] Result<MeshSpace> read_cage(Job& job, const TangentSpaceOptions& low, const MeshSpace& space) const;

    std::string cage_, skew_, offset_;  // patterns
};

}  // namespace tex::cli
