// SPDX-License-Identifier: Apache-2.0
// repack.h: commands that read one normal map and write it, and what bake-normals shares with them.

#pragma once

#include <tex/pipeline.h>

#include "batch/batch.h"
#include "batch/job.h"
#include "options/normals.h"

namespace tex::cli {

// A command that makes its outputs from normal maps.
class NormalsConverter : public Converter {
public:
    using Converter::Converter;

    NormalsReader normals;

protected:
    [[nodiscard]] ExitCode finish(Console& console) override;
};

// A command whose work is pack_file() of libtex, with options of its own.
class Repacker : public NormalsConverter {
public:
    using NormalsConverter::NormalsConverter;

protected:
    // Adds usage, inputs, files and how normal maps are read; `inputs` is the help of the inputs.
    void add_files(const char* inputs);

    // What happens on the way: level, scale, mip. All else is for `normals` and `output` to say.
    [[nodiscard]] virtual PackFileOptions options(Job& job) const = 0;
    // The encoding, if the user names none.
    [[nodiscard]] virtual Encoding encoding(const SourceInfo& input, const Task& task) const;
    // Adds to the job's report when all went well.
    virtual void report(Job&, const PackFileReport&) const {}

    [[nodiscard]] Result<void> process(Job& job) override;
};

// The names of files that each hold a level, if `name` has {level}, else empty.
[[nodiscard]] LevelNames level_names(const std::string& name);

// Notes that the job has written `name`, of so many levels.
void wrote_levels(Job& job, const std::string& name, int levels);

}  // namespace tex::cli
