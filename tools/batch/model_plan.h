// SPDX-License-Identifier: Apache-2.0
// model_plan.h: decides which model becomes which model.

#pragma once

#include <string>
#include <vector>

#include "batch/plan.h"

namespace tex::cli {

// Whether the outputs that the options name are models.
[[nodiscard]] bool writes_models(const FileOptions& files);

// plan_outputs(), where outputs are models. Throws UsageError also for options that mean nothing for models.
[[nodiscard]] std::vector<Task> plan_models(std::vector<Input> inputs, const FileOptions& files,
                                            const OutputOptions& output, const OutputRules& rules,
                                            const Command& command, const MeshReadOptions& options);

// One such task, of a rule of a manifest, which knows its files from the manifest alone: the model is GLB and names no
// files; another one is an error of its job. Throws UsageError as plan_models().
[[nodiscard]] Task complete_model(Task task, const FileOptions& files, const OutputOptions& output,
                                  const OutputRules& rules, const Command& command, const MeshReadOptions& options);

}  // namespace tex::cli
