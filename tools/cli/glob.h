// SPDX-License-Identifier: Apache-2.0
// glob.h: patterns of paths: "art/**/*_h.{png,tif}".

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tex::cli {

// A pattern of relative paths whose parts are separated by "/".
//
//     *        any characters of one part        [abc] [a-z] [!0-9]  one character of a set
//     ?        one character                     {png,tif}           one of these; may be nested
//     **       as a whole part: any number of folders, also none     \X: the character X
//
// Letters must match in their case, except in the extension, which is what follows the last dot of the pattern:
// "*.png" also matches WALL.PNG. A wildcard at the beginning of a part does not match a dot, so files and folders whose
// names begin with a dot match only if the pattern names the dot.
class Glob {
public:
    // Throws UsageError: an empty or absolute pattern, "..", brackets without their ends, more than 1024 alternatives,
    // 16 levels of braces or 4096 bytes.
    explicit Glob(std::string_view text);

    [[nodiscard]] bool matches(std::string_view path) const;
    // Whether a path below `folder` can match. The folder is "" or ends with "/".
    [[nodiscard]] bool reaches(std::string_view folder) const;

    [[nodiscard]] const std::string& text() const { return text_; }

private:
    using Parts = std::vector<std::string>;
    std::string text_;
    std::vector<Parts> alternatives_;
};

}  // namespace tex::cli
