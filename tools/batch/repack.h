// SPDX-License-Identifier: Apache-2.0
// repack.h: commands that read one normal map and write it, and the code that they share with bake-normals.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/mesh.h>
#include <tex/pipeline.h>

#include "batch/batch.h"
#include "options/extras.h"
#include "options/normals.h"
#include "tasks/job.h"

namespace tex::cli {

// A command that makes its outputs from normal maps.
class NormalsConverter : public Converter {
public:
    using Converter::Converter;

    NormalsReader normals;
    ExtraOptions extras;

    void note(Job& job, const StepsReport& done) override;
    [[nodiscard]] Result<void> accept(const Job& job) const override;
    void add_accept(Step& step, const Job& job) const override;

protected:
    [[nodiscard]] ExitCode finish(Console& console) override;
};

// A command that calls pack_file() of libtex and has its own options.
class PackCommand : public NormalsConverter {
public:
    using NormalsConverter::NormalsConverter;

    // None for models, which are written as a whole.
    [[nodiscard]] std::optional<Step> step(Job& job) override {
        return job.task.model_output ? std::nullopt : std::optional<Step>(all_options(job));
    }

protected:
    // Adds the usage, the inputs, the files and the way normal maps are read. `inputs` is the help text of the inputs.
    void add_files(const char* inputs);

    // The processing between reading and writing: level, scale, mip. `normals` and `output` determine everything else.
    [[nodiscard]] virtual PackFileOptions options(Job& job) const = 0;
    // The encoding, if the user names none.
    [[nodiscard]] virtual Encoding encoding(const SourceInfo& input, const Task& task) const;
    // Adds to the job's report after success.
    virtual void report(Job&, const PackFileReport&) const {}

    [[nodiscard]] Result<void> process(Job& job) override;

private:
    [[nodiscard]] PackFileOptions all_options(Job& job) const;
    [[nodiscard]] Result<void> process_model(Job& job);
    [[nodiscard]] Result<void> pack_image(Job& job, const std::vector<std::shared_ptr<const ModelInput>>& maps,
                                          const Execution& execution, ModelPicture& picture);
};

}  // namespace tex::cli
