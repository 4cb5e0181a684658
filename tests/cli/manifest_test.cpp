// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/host.h"
#include "cli/usage_error.h"
#include "tree/manifest.h"
#include "tree/recipe.h"

namespace tex::cli {
namespace {

constexpr const char* kRule = "version = 1\n[[rule]]\nmatch = \"*.png\"\n";

// What is wrong with a manifest, or nothing.
std::string refusal(const std::string& text) {
    MemoryHost host;
    Console console("build-normals", host);
    try {
        const Manifest manifest = parse_manifest("n.toml", text, step_names());
        ProgramPool pool;
        for (const RuleSettings& rule : manifest.rules) const Recipe recipe(manifest, rule, 1, "", pool, console);
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

std::string refusal_of(const std::string& steps, const std::string& more = {}) {
    return refusal(kRule + ("steps = " + steps) + "\n" + more);
}

}  // namespace

TEST(Manifest, DefaultsApplyUnlessARuleSaysOtherwise) {
    const Manifest manifest = parse_manifest("n.toml", R"(
version = 1
output-version = 1
[defaults]
out-dir = "out"
name = "{stem}.ktx2"
bake = { bumpiness = 3, invert = true }
[[rule]]
match = ["a/*.png", "b/*.{tif,exr}"]
exclude = "a/x*"
steps = [ { bake = { bumpiness = 0.5 } }, { blend = { detail = ["d1.png", "d2.png"], tiling = [8, "2,4"] } } ]
outputs = [ {}, { format = "bc5", name = "{stem}_2.dds" } ]
)",
                                             step_names());
    ASSERT_EQ(manifest.rules.size(), 1u);
    const RuleSettings& rule = manifest.rules[0];
    EXPECT_EQ(rule.match.size(), 2u);
    EXPECT_EQ(rule.exclude, std::vector<std::string>{"a/x*"});
    EXPECT_EQ(rule.out_dir, "out");
    ASSERT_EQ(rule.outputs.size(), 2u);
    EXPECT_EQ(rule.outputs[0].name, "{stem}.ktx2");
    EXPECT_EQ(rule.outputs[1].name, "{stem}_2.dds");
    ASSERT_EQ(rule.steps.size(), 2u);
    MemoryHost host;
    Console console("build-normals", host);
    ProgramPool pool;
    const Recipe recipe(manifest, rule, 1, "root", pool, console);
    const std::vector<std::string> bake = {"--bumpiness=0.5", "--invert"};
    const std::vector<std::string> blend = {"--detail=d1.png", "--detail=d2.png", "--format=bc5", "--tiling=8",
                                            "--tiling=2,4"};
    EXPECT_EQ(recipe.before()[0].arguments, bake);
    EXPECT_EQ(recipe.outputs()[1].last.arguments, blend);
    EXPECT_EQ(recipe.files(), (std::vector<std::string>{"d1.png", "d2.png"}));
    EXPECT_EQ(recipe.output_name("a/w.png", 1), "out/w_2.dds");
    EXPECT_TRUE(recipe.takes("b/w.TIF"));
    EXPECT_FALSE(recipe.takes("a/xy.png"));
}

TEST(Manifest, EveryOptionThatSaysHowNormalsAreMadeIsAKey) {
    for (const std::string& step : step_names()) {
        const ProgramRow* const row = find_program(step + "-normals");
        const std::unique_ptr<Program> program = row->make(*row);
        for (const Option& option : program->command.options()) {
            if (option.hidden) continue;
            const std::string message =
                refusal_of("[ { " + step + " = { " + option.name().substr(2) + " = \"\\u0001\" } } ]");
            const bool is_key = message.find("has no such option here") == std::string::npos;
            const bool is_of_runs = option.group == kHelpGroup || option.group == "Files" || option.group == "Running";
            EXPECT_EQ(is_key, !is_of_runs) << step << " " << option.name();
        }
    }
}

TEST(Manifest, MistakesNameTheirPlaceAndTheRemedy) {
    EXPECT_EQ(refusal("x = 1"), "n.toml: line 1, column 1: unknown key 'x'");
    EXPECT_EQ(refusal("version = 2"), "n.toml: line 1, column 11: an unknown version; this program reads version = 1");
    EXPECT_EQ(refusal("rule = []"), "n.toml: line 1, column 1: no version; this program reads version = 1");
    EXPECT_EQ(refusal("version = 1"), "n.toml: line 1, column 1: no rule; a rule begins with [[rule]]");
    EXPECT_EQ(refusal("version = 1\n[[rule]]\nmtch = 1"),
              "n.toml: line 3, column 1: unknown key 'mtch'; did you mean match?");
    EXPECT_EQ(refusal(kRule), "n.toml: line 2, column 1: the rule has no steps: steps = [ { bake = {} } ]");
    EXPECT_EQ(refusal_of("[ { bke = {} } ]"), "n.toml: line 4, column 13: unknown key 'bke'; did you mean bake?");
    EXPECT_EQ(refusal_of("[ { bake = { bumpines = 2 } } ]"),
              "n.toml: line 4, column 22: bumpines: bake-normals has no such option here; did you mean bumpiness?");
    EXPECT_EQ(refusal_of("[ { bake = { strength = 2 } } ]"),
              "n.toml: line 4, column 22: strength: bake-normals has no such option here; here it is bumpiness");
    EXPECT_EQ(refusal_of("[ { bake = { tiles = true } } ]"),
              "n.toml: line 4, column 22: tiles needs {x} and {y} in match, the place of a tile");
    EXPECT_EQ(refusal_of("[ { bake = { kernel = \"sobl\" } } ]").substr(0, 60),
              "n.toml: line 4, column 22: bake: --kernel: must be one of fo");
    EXPECT_EQ(refusal_of("[ { bake = { invert = 1 } } ]"), "n.toml: line 4, column 22: invert: must be true or false");
    EXPECT_EQ(refusal_of("[ { bake = { bumpiness = true } } ]"), "n.toml: line 4, column 22: bumpiness: needs a value");
    EXPECT_EQ(refusal_of("[ { bake = { bumpiness = inf } } ]"),
              "n.toml: line 4, column 34: bumpiness must be a finite number");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "match = 1").substr(0, 22), "n.toml: line 5, column");
    EXPECT_EQ(refusal_of("[ { bake = {}, mip = {} } ]"),
              "n.toml: line 4, column 11: a step holds one command, such as { bake = {} }");
    EXPECT_EQ(refusal_of("[ { scale = { scale = 2 } }, { bake = {} } ]"),
              "n.toml: line 4, column 40: bake must be the first step");
    EXPECT_EQ(refusal_of("[ { mip = {} }, { scale = { scale = 2 } } ]"),
              "n.toml: line 4, column 13: mip builds levels, so it must be the last step");
    EXPECT_EQ(refusal_of("[ { bake = {} }, { preview = {} } ]", "name = \"{stem}.png\"").substr(27),
              "preview must be the only step");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "name = \"{stm}.dds\"").substr(0, 34),
              "n.toml: line 2, column 1: name: a ");
    EXPECT_EQ(
        refusal_of("[ { bake = {} } ]", "name = \"{stem}.png\"\noutputs = [ { format = \"bc5\" } ]").substr(0, 59),
        "n.toml: line 6, column 13: bake: name.png: png files cannot");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "outputs = [ { fromat = \"bc5\" } ]"),
              "n.toml: line 5, column 15: fromat: bake-normals has no such option here; did you mean format?");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "check = { requir = 1 }"),
              "n.toml: line 5, column 11: check: requir is no key of a check; did you mean require?");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "check = { require = \"mps=full\" }").substr(0, 45),
              "n.toml: line 5, column 11: check: --require: ");
    EXPECT_EQ(refusal_of("[ { bake = {} } ]", "check = { config = \"a\" }"),
              "n.toml: line 5, column 11: check: config is no key of a check");
    EXPECT_EQ(refusal_of("[ { bake = { format = \"bc5\" } }, { mip = {} } ]").substr(0, 34),
              "n.toml: line 4, column 22: format:");
}

TEST(Manifest, OddLettersAreKeptInStringsAndRefusedElsewhere) {
    const Manifest manifest = parse_manifest(
        "n.toml", "version = 1 # \xc3\xa4\n[[rule]]\nmatch = '\xc3\xa4/*.png'\nsteps = [ { bake = {} } ]\n",
        step_names());
    EXPECT_EQ(manifest.rules[0].match[0], "\xc3\xa4/*.png");
    EXPECT_FALSE(refusal("\xc3\xa4 = 1").empty());
    EXPECT_FALSE(refusal("version = 1\n[[rule]]\nmatch = \"\\u0000\"").empty());
    EXPECT_FALSE(refusal("[:]").empty());
}

}  // namespace tex::cli
