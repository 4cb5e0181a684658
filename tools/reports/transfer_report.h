// SPDX-License-Identifier: Apache-2.0
// transfer_report.h: the page of transfer-normals: --report.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/transfer.h>

#include "cli/command.h"
#include "options/high_meshes.h"
#include "options/tangent_space.h"
#include "reports/html_report.h"
#include "tasks/collisions.h"
#include "tasks/job.h"

namespace tex::cli {

// The most triangles of high meshes in a page, in all; larger meshes are simplified (page_mesh.h).
inline constexpr std::size_t kPageTriangles = 100'000;

class TransferReport {
public:
    TransferReport();

    // In the group of files.
    void add(Command& command);

    [[nodiscard]] bool is_given() const { return !path_.empty(); }

    // Throws UsageError if the page is a file that the tasks read or write, or one of `others`.
    void check(const std::vector<Task>& tasks, std::vector<NamedFile> others);

    // What the page shows of a map.
    struct Entry {
        const MeshSpace& low;
        std::string arguments;  // as a shell reads them: how preview-normals finds this mesh
        const HighParts& high;
        const TransferredMaps& maps;
        const Texture& texture;  // the output
    };

    // Adds a map, with the warnings of its job. Any thread may call these functions. Errors: those of the verbs.
    [[nodiscard]] Result<void> add(Job& job, const Entry& entry);
    void add_failure(const Job& job, const Error& error);
    // Adds a model that the job has written. A page is of models or of maps.
    [[nodiscard]] Result<void> add_model(Job& job, const std::vector<std::string>& originals);

    // Writes the page, if it is wanted.
    [[nodiscard]] ExitCode write(Console& console) const;

private:
    [[nodiscard]] Result<HtmlBeside> beside(const Entry& entry, const HtmlSizes& sizes,
                                            const Execution& execution) const;

    std::string path_;
    std::size_t maps_ = 1;  // of the run
    HtmlReport page_, models_;
    // The texels of each output.
    struct Texels {
        std::int64_t covered = 0, missed = 0;
        bool failed = false;
    };
    mutable std::mutex mutex_;  // guards:
    std::size_t lods_ = 0, failed_lods_ = 0;
    std::map<std::string, Texels> texels_;
};

}  // namespace tex::cli
