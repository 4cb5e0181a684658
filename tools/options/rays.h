// SPDX-License-Identifier: Apache-2.0
// rays.h: the option groups of transfers from mesh to mesh: the rays, what may be missed, and the maps beside the
// output.

#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/conversion.h"
#include "options/maps.h"
#include "tasks/job.h"

namespace tex::cli {

// --extent, --subsamples, --rays, --front, --back, --hit, --backfaces, --straight-angle, --straight-width,
// --rays-per-hit, --occlusion-distance, --padding, --overlap, --max-missed.
class RayOptions {
public:
    void add(Command& command);

    // --extent, or the default, which may be another one.
    [[nodiscard]] Extent extent(Extent preset = kExtent) const { return extent_.value_or(preset); }
    [[nodiscard]] bool has_extent() const { return extent_.has_value(); }
    // `hit` is the default of --hit.
    [[nodiscard]] TransferOptions transfer(HitChoice hit = HitChoice::outermost) const {
        TransferOptions options = transfer_;
        options.hit = hit_.value_or(hit);
        return options;
    }

    // Reports what the rays found, with warnings about what they did not, and raises the exit code if more texels are
    // missed than --max-missed allows.
    // `remedy` is that of GuideOptions.
    [[nodiscard]] Result<void> judge(Job& job, const TransferredMaps& maps, const std::string& remedy) const;

private:
    void add_second(Command& command);
    void add_coverage(Command& command);
    void judge_missed(Job& job, const TransferredMaps& maps, const std::string& remedy) const;

    static constexpr Extent kExtent{2048, 2048};

    std::optional<Extent> extent_;
    std::optional<HitChoice> hit_;
    TransferOptions transfer_;
    Overlap overlap_ = Overlap::first;
    std::optional<double> max_missed_;  // percent
};

// Counts rays while they are cast.
class RaySpeed {
public:
    [[nodiscard]] std::atomic<std::int64_t>& rays() { return rays_; }
    // "12.5 million rays, 4.1 million a second"
    [[nodiscard]] std::string words() const;
    // "4.1 M rays/s", beside the progress bar.
    [[nodiscard]] std::string short_words() const;

private:
    [[nodiscard]] double millions_a_second() const;

    std::atomic<std::int64_t> rays_{0};
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// "rays reach 0.1 in front and 0.2 behind; heights are from -0.05 to 0.06"
[[nodiscard]] std::string reach_of(const TransferredMaps& maps);

// Whether several triangles share most texels, as where UVs tile a picture. Mirrored halves of a model do not: each
// texel has two.
[[nodiscard]] bool repeats(const TransferredMaps& maps, int subsamples);

// --object-out, --height-out, --position-out, --occlusion-out, --occlusion-into, --bent-out, --thickness-out,
// --color-out, --vertex-color-out, --missed-out.
class TransferMaps {
public:
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const;
    [[nodiscard]] bool wants_vertex_colors() const { return vertex_color_.is_given(); }
    // Whether models get occlusion.
    [[nodiscard]] bool puts_occlusion_into_model() const { return occlusion_into_model_; }
    // Sets the maps that are wanted.
    void request(TransferOptions& options) const;

    // Write what the user wants, and add it to the job's report. `y` is that of normals in tangent space.
    [[nodiscard]] Result<void> write(Job& job, TransferredMaps& maps, YAxis y) const;

private:
    [[nodiscard]] Result<void> write_normals(Job& job, const MapOutput& output, NormalMap normals, YAxis y,
                                             const char* key) const;
    [[nodiscard]] Result<void> write_heights(Job& job, TransferredMaps& maps) const;
    [[nodiscard]] Result<void> write_lengths(Job& job, const MapOutput& output, Plane<float> lengths, float lowest,
                                             float highest, Json& report) const;
    [[nodiscard]] Result<void> write_occlusion(Job& job, TransferredMaps& maps) const;
    [[nodiscard]] static Result<void> write_floats(Job& job, const MapOutput& output, std::vector<Plane<float>> planes,
                                                   Json& report);
    [[nodiscard]] static Result<void> write_colors(Job& job, const MapOutput& output, Image colors, const char* key);

    bool occlusion_into_model_ = false;
    MapOutput object_, heights_, positions_, occlusion_, bent_, thickness_, color_, vertex_color_, missed_out_;
};

}  // namespace tex::cli
