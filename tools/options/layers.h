// SPDX-License-Identifier: Apache-2.0
// layers.h: the option group of detail layers: their files, and how each one is placed on the base.

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/heights.h"
#include "options/normals.h"
#include "tasks/job.h"

namespace tex::cli {

// The values of an option that may be given for each layer: the i-th value is for the i-th layer; a single value is for
// all.
template <class T>
class PerLayer {
public:
    std::vector<T> values;

    [[nodiscard]] T of(std::size_t layer, T otherwise) const {
        if (values.empty()) return otherwise;
        return values.size() == 1 ? values.front() : values.at(layer);
    }
};

class LayerOptions {
public:
    void add(Command& command);

    // Throws UsageError unless each option is absent, given once, or given once for each of `count` layers.
    void check(std::size_t count) const;

    [[nodiscard]] const std::vector<std::string>& details() const { return details_; }
    // The files of --detail and --mask.
    [[nodiscard]] std::vector<std::string> files() const;

    // The layers, from the files `names`. The job must outlive them.
    [[nodiscard]] std::vector<LayerFile> layers(Job& job, const std::vector<std::string>& names,
                                                const NormalsReader& normals) const;

private:
    using Pair = std::pair<float, float>;

    void add_placement(Command& command);

    std::vector<std::string> details_;
    PerLayer<float> scale_, rotation_, strength_;
    PerLayer<Pair> tiling_, offset_;
    PerLayer<ChannelFile> mask_;
    PerLayer<std::pair<Wrap, Wrap>> wrap_;
    PerLayer<std::optional<YIn>> y_in_;
};

}  // namespace tex::cli
