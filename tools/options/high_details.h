// SPDX-License-Identifier: Apache-2.0
// high_details.h: the option group of pictures on the high mesh: --high-normals, --high-color, --high-alpha, --high-y,
// --high-decoder.

#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/high_meshes.h"
#include "options/mesh_files.h"
#include "tasks/job.h"

namespace tex::cli {

// What the files hold, for one job.
struct HighPictures {
    std::list<NormalMap> normals;
    std::list<Image> colors;
    std::list<Plane<float>> alphas;
    std::list<std::vector<Float4>> tangents;
    std::map<const ModelInput*, const NormalMap*> own;
    Extent largest_own{0, 0};         // of the high meshes' own maps
    std::vector<HighDetail> details;  // of the parts, which refer to the lists
};

class HighDetailOptions {
public:
    // `implies_own`: whether own maps count without being named.
    void add(Command& command, std::function<bool()> implies_own);

    [[nodiscard]] bool has_colors() const { return !colors_.empty(); }
    // Whether parts must keep their UVs.
    [[nodiscard]] bool is_given() const { return !colors_.empty() || !normals_.empty() || !alphas_.empty(); }
    // Whether the high meshes' own normal maps count.
    [[nodiscard]] bool takes_own() const { return own_.value_or(implies_own_()); }

    // Whether alpha of the high meshes' materials makes holes.
    [[nodiscard]] bool takes_alpha() const { return !is_solid_; }

    // Adds the files to the task.
    void amend(Task& task) const;
    // Adds the files beside these high meshes that have pictures of them.
    void add_files_beside(const std::vector<std::string>& meshes, const ReadOptions& options,
                          std::vector<std::string>& files) const;

    // Reads the files, each once; jobs that share the parts share what their files hold. Any thread may call this.
    // Errors: no part has such a material; a part has no UVs.
    [[nodiscard]] Result<std::shared_ptr<const HighPictures>> read(Job& job,
                                                                   const std::shared_ptr<const HighParts>& high) const;

private:
    // A file, for the parts with one material or for those that nothing else is given for.
    struct Assigned {
        std::string material;  // empty: all others
        std::string pattern;
    };

    static Option& add_files(Command& command, std::vector<Assigned>& files, const std::string& name, std::string help);
    [[nodiscard]] static const Assigned* find(const std::vector<Assigned>& files, const std::string& material);
    [[nodiscard]] static Result<void> check(const std::vector<Assigned>& files, const HighParts& high,
                                            const std::string& option);
    [[nodiscard]] Result<void> read_normals_of(Job& job, const HighParts& high, HighPictures& pictures) const;
    [[nodiscard]] Result<void> read_colors_of(Job& job, const HighParts& high, HighPictures& pictures) const;

    [[nodiscard]] Result<void> read_alphas_of(Job& job, const HighParts& high, HighPictures& pictures) const;
    [[nodiscard]] Result<const Plane<float>*> alpha_of(Job& job, const PartAlpha& alpha, HighPictures& pictures,
                                                       std::map<std::string, const Plane<float>*>& known) const;

    [[nodiscard]] Result<void> add_own(Job& job, const HighParts& high, std::size_t k, HighPictures& pictures) const;
    static void note_unused(Job& job, const HighParts& high, const HighPictures& pictures);
    [[nodiscard]] Result<const NormalMap*> own_map(Job& job, const ModelInput& map, HighPictures& pictures) const;

    std::vector<Assigned> normals_, colors_, alphas_;
    bool is_solid_ = false;
    std::optional<bool> own_;
    std::function<bool()> implies_own_;
    [[nodiscard]] Result<HighPictures> read_all(Job& job, const HighParts& high) const;
    [[nodiscard]] std::vector<FileState> files_of(const Task& task) const;

    std::optional<YAxis> y_;
    Decoder decoder_ = Decoder::gltf;
    // What was read last for jobs that share it: with what it belongs to, and what was said of it.
    struct Kept {
        std::shared_ptr<const HighParts> high;
        std::vector<FileState> files;
        std::shared_ptr<const HighPictures> pictures;
        std::vector<FileWarning> warnings;
    };
    mutable std::mutex mutex_;
    mutable Kept last_;
};

}  // namespace tex::cli
