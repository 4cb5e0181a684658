// SPDX-License-Identifier: Apache-2.0
// texture_check.h: what a rule demands of the textures that it makes: the rules of check-normals, and limits for the
// error of packing.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/pack.h>

#include "cli/command.h"
#include "options/pair.h"
#include "options/rules.h"
#include "tree/manifest.h"

namespace tex::cli {

// A texture that was made, and has not replaced the old one yet.
struct MadeTexture {
    std::string file;
    std::string source;  // the normals before packing, as an EXR file; empty if no limit is set
    PackOptions pack;
    std::string name;   // for messages
    std::string input;  // from which it was made
};

class TextureCheck {
public:
    // The key "inputs" says whether the inputs are checked, too. The other keys of `settings` are options of
    // check-normals (require, enable, disable, severity, fail-on) and of compare-normals (max-mean, max-p99, max-p999,
    // max).
    // Throws UsageError with the place in the manifest.
    TextureCheck(const Manifest& manifest, const Settings& settings, Console& console);
    TextureCheck(const TextureCheck&) = delete;
    TextureCheck& operator=(const TextureCheck&) = delete;

    // Whether inputs that hold something else than their rule takes are refused, and whether all rules judge inputs.
    [[nodiscard]] bool refuses_inputs() const { return !inputs_ || *inputs_; }
    [[nodiscard]] bool checks_inputs() const { return inputs_ && *inputs_; }
    [[nodiscard]] bool is_given() const { return is_given_; }
    [[nodiscard]] bool compares() const { return compares_; }
    // What outputs depend on: the same settings give the same text.
    [[nodiscard]] const std::string& text() const { return text_; }

    // A sentence for each finding that fails the texture. Any thread may call this. Errors: those of reading.
    [[nodiscard]] Result<std::vector<std::string>> findings(const MadeTexture& made, const ReadOptions& read,
                                                            const Execution& execution) const;

    // Checks a normal map that is an input, at `path`. Requirements are those of outputs.
    [[nodiscard]] Result<std::vector<std::string>> findings_of_input(const std::string& path, const ReadOptions& read,
                                                                     const Execution& execution) const;

private:
    [[nodiscard]] std::string sentence_of(const Finding& finding, const CheckReport& report,
                                          const std::string& input) const;
    [[nodiscard]] Result<void> compare_with_source(const MadeTexture& made, const ReadOptions& read,
                                                   const Execution& execution,
                                                   std::vector<std::string>& sentences) const;

    Command command_;
    RuleOptions rules_;
    PairOptions limits_;
    std::optional<bool> inputs_;
    bool is_given_ = false;
    bool compares_ = false;
    std::string text_;
};

}  // namespace tex::cli
