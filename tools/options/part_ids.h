// SPDX-License-Identifier: Apache-2.0
// part_ids.h: the option group of the map of ids: --id-out, --id-by.

#pragma once

#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/high_meshes.h"
#include "options/maps.h"
#include "tasks/job.h"

namespace tex::cli {

// What has a colour of its own.
enum class IdBy { part, material, mesh };

inline constexpr Named<IdBy> kIdByNames[] = {
    {IdBy::part, "part", "parts with the same name, which is that of the node or object"},
    {IdBy::material, "material", "materials with the same name"},
    {IdBy::mesh, "mesh", "files"},
};

class PartIds {
public:
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const { output_.amend(task); }

    // Numbers the parts, if the map is wanted.
    void number(const HighParts& high, TransferInputs& inputs) const;
    // Writes the map, with what each colour means in the job's report and on standard output.
    [[nodiscard]] Result<void> write(Job& job, const HighParts& high, const TransferredMaps& maps) const;

private:
    // The names that ids have, in their order.
    [[nodiscard]] std::vector<std::string> names_of(const HighParts& high) const;
    [[nodiscard]] std::string name_of_part(const HighParts& high, std::size_t part) const;

    MapOutput output_;
    IdBy by_ = IdBy::part;
};

}  // namespace tex::cli
