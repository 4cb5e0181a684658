// SPDX-License-Identifier: Apache-2.0
// maps.h: the option group of maps that a command writes besides its output: a picture of one value for each texel.

#pragma once

#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/mip.h>
#include <tex/types.h>

#include "cli/command.h"
#include "options/files.h"
#include "tasks/job.h"

namespace tex::cli {

// An option such as --curl-out FILE. Of many inputs it is a pattern, as --name. <UDIM> becomes the task's tile.
class MapOutput {
public:
    // `files` must outlive this. `name`: the option.
    Option& add(Command& command, const FileOptions& files, std::string name, std::string help);

    [[nodiscard]] bool is_given() const { return !pattern_.empty(); }

    // Adds the file to the task. Throws UsageError if its name shows no file type, or one that cannot hold the map.
    void amend(Task& task) const;

    // Whether the file holds floats. Others hold pictures of 8 or 16 bits.
    [[nodiscard]] bool holds_floats(const Job& job) const;

    // Writes a picture of one channel as floats or with 16 bits (8 if the file type holds no more), or one with the
    // planes R, G and B with 8 bits. Values of pictures are in [0, 1]. Adds the file to the outputs of the job, and its
    // name to `report`.
    // With `mips`, files of block formats (dds, ktx2) hold these levels: averages.
    [[nodiscard]] Result<void> write(Job& job, Plane<float> values, Json& report,
                                     const MipOptions* mips = nullptr) const;
    [[nodiscard]] Result<void> write(Job& job, const Image& colors, Json& report) const;
    // Writes normals as bytes, or as half floats in exr. Adds as above.
    [[nodiscard]] Result<void> write(Job& job, NormalMap normals, YAxis y, Json& report,
                                     const MipOptions* mips = nullptr) const;
    // Writes a texture that its file type can hold.
    [[nodiscard]] Result<void> write(Job& job, const Texture& texture, Json& report) const;
    // The file type. Throws UsageError as amend().
    [[nodiscard]] Container container_for(const Task& task) const { return container_of_path(path_of(task)); }
    [[nodiscard]] std::string path_for(const Task& task) const { return path_of(task); }

private:
    [[nodiscard]] std::string path_of(const Task& task) const;
    [[nodiscard]] Container container_of_path(const std::string& path) const;

    const FileOptions* files_ = nullptr;
    std::string name_, pattern_;
};

// The format of a map of one channel: r32_float in exr, r8_unorm in tga, bmp, jpeg and webp, else r16_unorm.
[[nodiscard]] Format map_format(Container container);

}  // namespace tex::cli
