// SPDX-License-Identifier: Apache-2.0

#include "reports/model_fixes.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"

namespace tex::cli {
namespace {

// Commands that change nothing where there is no fault.
constexpr std::string_view kForAll[] = {"repair-normals ", "convert-normals "};
constexpr std::string_view kLikely = " --likely";

// Whether the words stood in the text, from which they are taken.
bool take_out(std::string& text, std::string_view words) {
    const std::size_t at = text.find(words);
    if (at != std::string::npos) text.erase(at, words.size());
    return at != std::string::npos;
}

}  // namespace

void ModelFixes::add(const std::string& command, const std::string& material) {
    if (std::find(commands_.begin(), commands_.end(), command) != commands_.end()) return;
    commands_.push_back(command);
    std::string whole = command;
    take_out(whole, " --material " + shell_word(material));
    is_likely_ = take_out(whole, kLikely) || is_likely_;
    whole_.push_back(std::move(whole));
}

std::string ModelFixes::text(const std::string& model) const {
    if (commands_.size() < 2) return {};
    std::string whole = whole_.front();
    const bool is_for_all = std::any_of(std::begin(kForAll), std::end(kForAll),
                                        [&](std::string_view name) { return whole.starts_with(name); });
    const bool is_one = is_for_all && std::all_of(whole_.begin(), whole_.end(),
                                                  [&](const std::string& other) { return other == whole; });
    if (!is_one) {
        return fmt::format("{}: each fix reads the model as it is: give it the FIXED of the one before\n",
                           printable(model));
    }
    const std::string file = shell_file(model);
    if (const std::size_t at = whole.find(file); is_likely_ && at != std::string::npos)
        whole.insert(at + file.size(), kLikely);
    return fmt::format("{}: all of these in one run: {}\n", printable(model), whole);
}

}  // namespace tex::cli
