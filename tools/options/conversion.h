// SPDX-License-Identifier: Apache-2.0
// conversion.h: the option group of conversions between spaces: padding and overlaps.

#pragma once

#include <string>

#include <tex/mesh.h>

#include "cli/command.h"
#include "options/tangent_space.h"
#include "tasks/job.h"

namespace tex::cli {

enum class Overlap { first, error };

inline constexpr Named<Overlap> kOverlapNames[] = {
    {Overlap::first, "first", "the first triangle decides, with a warning"},
    {Overlap::error, "error", "the file fails"},
};

// --padding, --overlap, and what TangentSpaceOptions adds.
class ConversionOptions {
public:
    TangentSpaceOptions spaces;

    void add(Command& command);

    [[nodiscard]] bool makes_object() const { return spaces.to == Space::object; }

    // Converts the job's map, up to this fraction of the job. Adds what it did to the job's report, with warnings about
    // what cannot be right.
    [[nodiscard]] Result<ConvertedMap> convert(Job& job, const NormalMap& map, double until) const;

private:
    [[nodiscard]] Result<void> judge(Job& job, const ConvertedMap& converted, const std::string& mesh) const;

    ConvertOptions convert_;
    Overlap overlap_ = Overlap::first;
};

}  // namespace tex::cli
