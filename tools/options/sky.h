// SPDX-License-Identifier: Apache-2.0
// sky.h: the option group of what heights hide: occlusion, sky view, bent normals and horizons beside the output.

#pragma once

#include <functional>
#include <vector>

#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/heights.h"
#include "options/maps.h"
#include "tasks/job.h"

namespace tex::cli {

// --occlusion-out, --occlusion-into, --sky-view-out, --bent-out, --horizon-out, --horizon-directions,
// --occlusion-directions, --occlusion-distance.
class SkyOptions {
public:
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const;

    // Whether a map is written.
    [[nodiscard]] bool is_given() const;
    // What is made.
    [[nodiscard]] OcclusionOptions options() const;
    // Sets it. `is_extra`: occlusion goes beside the normals, too.
    void apply(BakeFileOptions& options, bool is_extra) const;
    // Throws UsageError if an option has no effect.
    void check(const Command& command, bool is_extra) const;

    // An error if the file of --occlusion-into does not take the occlusion of heights of this extent: before anything
    // is written. The extent is asked for only if it is needed.
    [[nodiscard]] Result<void> accept(const Job& job, const std::function<Result<Extent>()>& extent_of) const;
    // Write what the user wants, and add it to the job's report. `y` is that of the bent normals. With `mips`, files
    // that hold blocks have levels, too, except those of horizons, whose slices would mix.
    [[nodiscard]] Result<void> write(Job& job, OcclusionMaps maps, YAxis y, const MipOptions* mips = nullptr) const;

private:
    [[nodiscard]] static Result<void> write_plane(Job& job, const MapOutput& output, Plane<float> values,
                                                  const char* key, const MipOptions* mips);
    [[nodiscard]] Result<void> write_horizons(Job& job, std::vector<Plane<float>> horizons) const;

    [[nodiscard]] ChannelFile into_of(const Task& task) const;

    OcclusionOptions options_;
    int horizons_ = 8;
    ChannelFile into_;  // its file is a pattern, or empty
    MapOutput occlusion_, sky_view_, bent_, horizon_;
};

}  // namespace tex::cli
