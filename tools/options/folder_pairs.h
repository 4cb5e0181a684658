// SPDX-License-Identifier: Apache-2.0
// folder_pairs.h: the files of two folders that compare-normals compares.

#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::cli {

struct FolderPairs {
    std::vector<std::pair<std::string, std::string>> files;  // A and B, in the order of A's names
    std::vector<std::string> alone[2];                       // pictures without a partner
    std::int64_t others = 0;                                 // pairs whose A holds no normal map
};

// The pictures and models of two folders, and of those below them, that have one name: the whole name, or else the name
// without its extension, as long as only one file of each folder has it. Errors: those of pictures_below().
[[nodiscard]] Result<FolderPairs> folder_pairs(const std::string& a, const std::string& b, const ReadOptions& read);

}  // namespace tex::cli
