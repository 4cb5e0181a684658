// SPDX-License-Identifier: Apache-2.0
// sheet.h: the option group for the content of a picture (one view of one map, a sheet of many views, or two maps side
// by side), and the code that draws it.

#pragma once

#include <string>
#include <vector>

#include <tex/preview.h>

#include "cli/command.h"
#include "options/scene.h"
#include "tasks/task.h"

namespace tex::cli {

// --show, --size, --columns, --split, --difference, --turntable, --legend-max, --no-legend, --no-captions.
class SheetOptions {
public:
    // `scene` gets the size and the legend's maximum. It must outlive this.
    void add(Command& command, SceneOptions& scene);

    // Throws UsageError if the task's maps or output do not fit the options.
    void check(const Task& task) const;

    [[nodiscard]] bool is_animated() const { return turntable_ > 0; }
    [[nodiscard]] bool is_difference() const { return difference_; }
    [[nodiscard]] bool shows(Show show) const;
    [[nodiscard]] std::vector<std::string> names_of_shows() const;

    // Throws UsageError if a picture needs a mesh, and a map has none.
    void check_mesh(bool has_mesh) const;

    // The maps of a picture, or why one cannot be shown.
    using Maps = std::vector<Result<SampledMap>>;

    // The file of a map, and its material, if it is a map in a model: the caption.
    struct MapName {
        std::string file;
        std::string material = {};
    };

    // Whether a sheet of so many maps can do without one for which this is the reason.
    [[nodiscard]] bool can_leave_out(const Error& error, std::size_t maps) const;

    // Draws the frames of the picture: one, unless it is animated. `maps` are the maps of the files `names`, one of
    // which can be shown; one that cannot be drawn becomes its error. `with` holds the other files of the scene.
    // Errors: those of the verbs.
    [[nodiscard]] Result<std::vector<Texture>> draw(const std::vector<MapName>& names, Maps& maps,
                                                    const SceneFiles& with, const Execution& execution) const;

private:
    void add_shows(Command& command);
    [[nodiscard]] Result<Texture> draw_frame(const std::vector<MapName>& names, Maps& maps, const SceneFiles& with,
                                             PreviewOptions options, const Execution& execution) const;
    [[nodiscard]] Result<Texture> draw_difference(const std::string& name, const NormalMap& a, const NormalMap& b,
                                                  const Execution& execution) const;
    [[nodiscard]] static std::string name_apart(const std::vector<MapName>& names, std::size_t map);
    [[nodiscard]] std::string caption(const std::vector<MapName>& names, std::size_t map, Show show) const;

    const SceneOptions* scene_ = nullptr;
    std::vector<Show> shows_ = {Show::lit};
    int columns_ = 0;
    int turntable_ = 0;
    bool split_ = false;
    bool difference_ = false;
    bool no_legend_ = false;
    bool no_captions_ = false;
};

}  // namespace tex::cli
