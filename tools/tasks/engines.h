// SPDX-License-Identifier: Apache-2.0
// engines.h: what engines and programs import: the presets of --for. normal-maps-engines(7) explains them to users.

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/check.h>
#include <tex/file.h>

#include "cli/command.h"

namespace tex::cli {

// Where materials read roughness.
enum class RoughnessUse {
    any,         // in whichever channel the user connects
    green,       // of a texture with occlusion in red and metalness in blue
    smoothness,  // 1 - roughness, in alpha of a texture with metalness in red and occlusion in green
};

// One row of the table.
// Where an engine reads roughness, and what makes its importer derive the levels from a normal map; may be empty.
struct EngineRoughness {
    constexpr EngineRoughness(RoughnessUse use_ = RoughnessUse::any, std::string_view importer_ = {})
        : use(use_), importer(importer_) {}
    RoughnessUse use;
    std::string_view importer;
};

struct Engine {
    std::string_view name;  // "unity"
    Container container;    // of names that the command makes, and of standard output
    Encoding format;
    YAxis y;
    bool has_mips;            // whether the file holds all levels; otherwise the engine builds them
    std::string_view suffix;  // of names that the command makes: the engine recognises normal maps by it
    std::string_view reason;  // sentences
    // What it reads besides, for check-normals.
    std::span<const Container> types;
    std::span<const Encoding> encodings;
    EngineRoughness roughness = {};
    std::span<const Encoding> in_ktx2 = {};  // instead of encodings, in KTX2
    bool inflates_zlib = true;               // of KTX2
};

[[nodiscard]] std::span<const Engine> engines();

// The engines of "unity,unreal", in this order. Throws UsageError.
[[nodiscard]] std::vector<const Engine*> parse_engines(const std::string& text);

// What check-normals compares a file with.
[[nodiscard]] EngineNeeds needs_of(const Engine& engine);

// The words of --for: the engines and "list".
[[nodiscard]] std::vector<Word> engine_words();

// What --for list prints: each engine with its settings and the reason for them.
[[nodiscard]] std::string engine_table();

}  // namespace tex::cli
