// SPDX-License-Identifier: Apache-2.0
// name_pattern.h: names of outputs made from names of inputs: --name '{stem}_mip{level}{ext}'.

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tex::cli {

// What the fields stand for. {ext} has its dot; {dir} is "." for a name without a folder.
struct NameFields {
    std::string dir;
    std::string stem;
    std::string ext;
    std::string format;
};

// The dir, stem and ext of a path; "-" has the stem "stdin".
[[nodiscard]] NameFields name_fields(const std::string& path);

// Stands for the level in a name that is made before the number of levels is known. No file name can hold it.
inline constexpr char kLevelMark = '\0';
[[nodiscard]] std::string with_level(const std::string& name, int level);
[[nodiscard]] bool has_level(const std::string& name);

class NamePattern {
public:
    // Throws UsageError for unknown fields and braces that do not match; "{{" and "}}" stand for braces.
    explicit NamePattern(std::string_view text);

    // {level} becomes kLevelMark.
    [[nodiscard]] std::string expand(const NameFields& fields) const;
    [[nodiscard]] bool uses(std::string_view field) const;

private:
    struct Piece {
        bool is_field;
        std::string text;
    };
    std::vector<Piece> pieces_;
};

}  // namespace tex::cli
