// SPDX-License-Identifier: Apache-2.0

#include "batch/lod_rules.h"

#include <string>
#include <utility>

#include "batch/model_plan.h"
#include "cli/usage_error.h"
#include "tasks/model_input.h"

namespace tex::cli {

bool takes_all_materials(const TangentSpaceOptions& low) { return low.material() == "all"; }

void set_lod_rules(OutputRules& rules, const LodOptions& options) {
    std::vector<std::string> idle = {"--primitive", "--node", "--uv-set", "--tile", "--cage"};
    MeshReadOptions how;
    how.reader = options.read;
    if (writes_models(options.files)) {
        rules.models = takes_all_materials(options.low) ? "" : options.low.material();
        rules.writes_models = true;
        rules.lods = {options.low.tangents(), options.maps.puts_occlusion_into_model()};
        rules.not_for_models = idle;
        for (const char* const name :
             {"--skew", "--offset", "--object-out", "--height-out", "--position-out", "--occlusion-out", "--bent-out",
              "--thickness-out", "--color-out", "--vertex-color-out", "--missed-out", "--id-out"})
            rules.not_for_models.emplace_back(name);
        return;
    }
    if (options.maps.puts_occlusion_into_model())
        throw UsageError("--occlusion-into", "a model is no output here: give -o x.glb");
    if (!takes_all_materials(options.low)) return;
    idle.emplace_back("--report");
    if (const auto given = options.command.given_of(idle); !given.empty())
        throw UsageError("--material all and " + given.front() + " contradict each other");
    rules.materials = [how](const Input& input) {
        std::vector<Input> inputs;
        for (auto& material : materials_of_model(input.name, "", how)) {
            inputs.push_back(input);
            inputs.back().model = std::move(material);
        }
        return inputs;
    };
}

}  // namespace tex::cli
