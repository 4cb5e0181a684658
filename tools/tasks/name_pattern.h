// SPDX-License-Identifier: Apache-2.0
// name_pattern.h: builds the names of outputs from the names of inputs: --name '{stem}_mip{level}{ext}'.
//
// {stem:-_h} is the stem without the suffix _h; a stem without the suffix stays as it is.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tex/file.h>

namespace tex::cli {

// The values of the fields. {ext} includes the dot; {dir} is "." for a name without a folder.
struct NameFields {
    std::string dir;
    std::string stem;
    std::string ext;
    std::string format;
    std::string engine = {};    // of --for
    std::string material = {};  // of a map in a model
    std::string type = {};      // the extension of the output without its dot, if --for or --container sets it
};

// The dir, stem and ext of a path. The stem of "-" is "stdin".
[[nodiscard]] NameFields name_fields(const std::string& path);

// The first extension of a container: ".dds" for Container::dds.
[[nodiscard]] std::string extension_of(Container container);

// Marks the place of the level in a name that is built before the number of levels is known. No file name can contain
// it.
inline constexpr char kLevelMark = '\0';
[[nodiscard]] std::string with_level(const std::string& name, int level);
[[nodiscard]] bool has_level(const std::string& name);
// The name with {level} in place of the mark, for files that people read, and back.
[[nodiscard]] std::string written_name(std::string name);
[[nodiscard]] std::string marked_name(std::string name);
// The names of all files that an output may have: one for each level of the largest extent, or the name itself.
[[nodiscard]] std::vector<std::string> with_all_levels(const std::string& name);

class NamePattern {
public:
    // Throws UsageError for unknown fields and unbalanced braces. "{{" and "}}" are literal braces.
    explicit NamePattern(std::string_view text);

    // {level} becomes kLevelMark. Throws UsageError for {engine}, {type} and {material} if nothing sets them.
    [[nodiscard]] std::string expand(const NameFields& fields) const;
    [[nodiscard]] bool uses(std::string_view field) const;

private:
    struct Piece {
        bool is_field;
        std::string text;
        std::string without = {};  // taken from the end of the field
    };
    std::vector<Piece> pieces_;
};

}  // namespace tex::cli
