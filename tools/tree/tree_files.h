// SPDX-License-Identifier: Apache-2.0
// tree_files.h: every file that a run of build-normals reads or writes, so that it destroys none of them.

#pragma once

#include <string>
#include <vector>

#include <tex/types.h>

#include "tasks/collisions.h"
#include "tasks/file_table.h"
#include "tree/recipe.h"
#include "tree/work.h"

namespace tex::cli {

// What a run reads and writes besides the files of textures. Files without a name do not count.
struct RunDocuments {
    std::vector<NamedFile> read;     // the manifest, a plan, reports
    std::vector<NamedFile> written;  // the state, a plan, a depfile, a report
};

// All files that the outputs of a task may have, relative to the root; none if it cannot be made.
[[nodiscard]] std::vector<std::string> files_of(const BuildTask& task, const Recipe& recipe);

// Files are compared as in file_table.h. Any thread may call the members that are const.
class TreeFiles {
public:
    // Throws UsageError if an output is a file that is read, or if a document is an output, a file that is read, or
    // another document.
    TreeFiles(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks, const std::string& root,
              const RunDocuments& documents);

    // To be called when the output `path` is complete: since the run began, folders may have become links. Errors: io,
    // if it would now replace a file that is read.
    [[nodiscard]] Result<void> may_replace(const std::string& path) const;
    [[nodiscard]] bool is_read(const std::string& path) const { return read_.find(path) != nullptr; }

private:
    void add_inputs(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks, const std::string& root);
    void add_outputs(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks, const std::string& root);
    void add_documents(const RunDocuments& documents);

    FileTable<std::string> read_;     // what messages call the file: "the input art/a.png"
    FileTable<std::string> written_;  // "an output of art/a.png"
};

}  // namespace tex::cli
