// SPDX-License-Identifier: Apache-2.0
// lod_report.h: what the page of transfer-normals shows of a model that it has written.

#pragma once

#include <string>
#include <vector>

#include "reports/html_report.h"
#include "tasks/job.h"

namespace tex::cli {

// The headings of such a page.
[[nodiscard]] std::vector<std::string> lod_columns();

// An entry for each material of the model that the job has written which the original has, too: the original, the low
// model with its old map, and the output side by side, and how far both are from the original to the eye. Adds these
// numbers to the job's report. Errors: those of the verbs.
[[nodiscard]] Result<std::vector<HtmlEntry>> lod_entries(Job& job, const std::vector<std::string>& originals,
                                                         const HtmlSizes& sizes);

}  // namespace tex::cli
