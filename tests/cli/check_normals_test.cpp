// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class CheckNormals : public testing::Test {
protected:
    CheckNormals() {
        scratch_.add_sample("bricks.png", "bricks.png");
        bake("good.dds", {});
        bake("down.dds", {"--y", "down"});
    }
    void bake(const std::string& output, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"bricks.png", "-o", output, "--bumpiness", "12", "--effort", "fast", "--no-sync"});
        const Ran ran = run(scratch_, "bake-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
    Ran check(const std::vector<std::string>& arguments) { return run(scratch_, "check-normals", arguments); }
    Scratch scratch_;
};

TEST_F(CheckNormals, OurOwnTexturesAreClean) {
    const Ran ran = check({"good.dds", "--require", "format=dxt5nm", "--require", "mips=full", "--require", "y=up",
                           "--require", "tiles", "--require", "pow2", "--fail-on", "warning"});
    EXPECT_EQ(ran.code, 0) << ran.out;
    EXPECT_NE(ran.out.find("1 file: 0 errors, 0 warnings"), std::string::npos) << ran.out;
    EXPECT_EQ(ran.err, "");
}

TEST_F(CheckNormals, FindingsNameFileRuleFigureAndFix) {
    const Ran ran = check({"good.dds", "down.dds", "--require", "y=up"});
    EXPECT_EQ(ran.code, 1);
    const auto lines = lines_of(ran.out);
    ASSERT_GE(lines.size(), 3u) << ran.out;
    EXPECT_TRUE(lines[0].starts_with("down.dds: error N401 wrong-y: ")) << lines[0];
    EXPECT_NE(lines[0].find("correlation -"), std::string::npos);
    EXPECT_EQ(
        lines[1],
        "    fix: pack-normals down.dds --keep-length --y-in down --y up --format dxt5nm --effort best -o FIXED.dds");
    EXPECT_TRUE(lines.back().starts_with("2 files: 1 error, ")) << lines.back();
}

TEST_F(CheckNormals, SeverityDecidesWhetherItFails) {
    const std::vector<std::string> base = {"down.dds", "--require", "y=up"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), base.begin(), base.end());
        return check(more).code;
    };
    EXPECT_EQ(with({}), 1);
    EXPECT_EQ(with({"--disable", "N401"}), 1) << "the file says that y is down: N112";
    EXPECT_EQ(with({"--disable", "N401", "--disable", "N112"}), 0);
    EXPECT_EQ(with({"--severity", "wrong-y=warning"}), 0);
    EXPECT_EQ(with({"--severity", "wrong-y=warning", "--fail-on", "warning"}), 1);
}

TEST_F(CheckNormals, ConfigurationIsReadAndTheCommandLineWins) {
    scratch_.write("checks.toml",
                   "require = [\"y=up\", \"mips=full\"]\nfail-on = \"error\"\n[severity]\nwrong-y = \"warning\"\n");
    EXPECT_EQ(check({"down.dds", "--config", "checks.toml"}).code, 0);
    EXPECT_EQ(check({"down.dds", "--config", "checks.toml", "--fail-on", "warning"}).code, 1);
    EXPECT_EQ(check({"down.dds", "--config", "checks.toml", "--severity", "N401=error"}).code, 1);
    EXPECT_EQ(check({"good.dds", "--config", "checks.toml", "--require", "y=down", "--severity", "N401=error"}).code,
              1);
    for (const char* text : {"require = 3", "require = [\"y=left\"]", "requires = []", "[severity]\nN999 = \"error\"",
                             "fail-on = \"fatal\"", "x = ["}) {
        scratch_.write("bad.toml", text);
        const Ran ran = check({"good.dds", "--config", "bad.toml"});
        EXPECT_EQ(ran.code, 2) << text;
        EXPECT_NE(ran.err.find("bad.toml: line "), std::string::npos) << ran.err;
    }
    EXPECT_EQ(check({"good.dds", "--config", "gone.toml"}).code, 3);
    // By id in one place and by name in the other: the command line overrides the file.
    scratch_.write("off.toml", "require = [\"y=up\"]\ndisable = [\"wrong-y\", \"N112\"]\n");
    EXPECT_EQ(check({"down.dds", "--config", "off.toml"}).code, 0);
    EXPECT_EQ(check({"down.dds", "--config", "off.toml", "--enable", "N401"}).code, 1);
    EXPECT_EQ(check({"down.dds", "--config", "off.toml", "--enable", "N401", "--disable", "N401"}).code, 0);
}

TEST_F(CheckNormals, BaselineAcceptsWhatIsKnown) {
    EXPECT_EQ(check({"down.dds", "--require", "y=up", "--baseline-write", "known.json"}).code, 0);
    const Ran known = check({"down.dds", "--require", "y=up", "--baseline", "known.json"});
    EXPECT_EQ(known.code, 0);
    EXPECT_NE(known.out.find("known and accepted"), std::string::npos);
    EXPECT_EQ(check({"./down.dds", "--require", "y=up", "--baseline", "known.json"}).code, 0) << "the same file";
    EXPECT_EQ(check({"good.dds", "--require", "y=down", "--baseline", "known.json"}).code, 1);
    scratch_.write("known.json", "[]");
    EXPECT_EQ(check({"good.dds", "--baseline", "known.json"}).code, 4);
    for (const char* text : {R"({"version": "1", "findings": []})",
                             R"({"version": 1, "findings": [{"file": "a", "id": "N201", "level": 4294967296}]})"}) {
        scratch_.write("known.json", text);
        EXPECT_EQ(check({"good.dds", "--baseline", "known.json"}).code, 4) << text;
    }
}

TEST_F(CheckNormals, UnreadableFilesAreFindingsAndExit4) {
    scratch_.write("torn.dds", "DDS |");
    const Ran ran = check({"torn.dds", "good.dds", "gone.dds"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.out.find("torn.dds: error N101 unreadable: "), std::string::npos);
    EXPECT_NE(ran.err.find("gone.dds"), std::string::npos);
    EXPECT_EQ(check({"gone.dds"}).code, 3);
}

TEST_F(CheckNormals, SarifHasItsRulesAndResults) {
    ASSERT_EQ(check({"good.dds", "down.dds", "--require", "y=up", "--sarif", "out.sarif"}).code, 1);
    const auto log = nlohmann::json::parse(scratch_.read("out.sarif"));
    EXPECT_EQ(log["version"], "2.1.0");
    const auto& driver = log["runs"][0]["tool"]["driver"];
    ASSERT_EQ(driver["rules"].size(), rules().size());
    bool found = false;
    for (const auto& result : log["runs"][0]["results"]) {
        EXPECT_EQ(driver["rules"][result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
        EXPECT_TRUE(result["message"]["text"].is_string());
        const auto& place = result["locations"][0]["physicalLocation"];
        if (result["ruleId"] == "N401") {
            found = true;
            EXPECT_EQ(place["artifactLocation"]["uri"], "down.dds");
            EXPECT_EQ(result["level"], "error");
        }
    }
    EXPECT_TRUE(found);
}

TEST_F(CheckNormals, JUnitCountsAndEscapes) {
    bake("a<&\"b.dds", {"--y", "down"});
    scratch_.write("torn.dds", "DDS |");
    EXPECT_EQ(check({"good.dds", "a<&\"b.dds", "torn.dds", "--require", "y=up", "--junit", "out.xml"}).code, 4);
    const std::string xml = scratch_.read("out.xml");
    EXPECT_NE(xml.find("tests=\"3\" failures=\"1\" errors=\"1\""), std::string::npos) << xml;
    EXPECT_NE(xml.find("name=\"a&lt;&amp;&quot;b.dds\""), std::string::npos);
}

// Checks SARIF with a closed schema based on the OASIS standard, and JUnit's XML with a schema of the elements that its
// readers accept. The files are broken in every way that a rule knows, or missing, or have names that must be escaped.
TEST_F(CheckNormals, DocumentsFollowTheirSchemas) {
    ASSERT_EQ(
        shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N* . && cp N401-wrong-y.png $'a \\xff<&\">%.png'").code,
        0);
    ASSERT_EQ(shell(scratch_,
                    "check-normals --require y=up --require pow2 --require tiles --require mips=full --sarif out.sarif "
                    "--junit out.xml N* a* gone.dds")
                  .code,
              4);
    const Ran sarif = shell(scratch_, R"(/usr/bin/python3 -c '
import json, jsonschema, sys
schema = json.load(open(sys.argv[1]))
jsonschema.Draft7Validator.check_schema(schema)
jsonschema.Draft7Validator(schema).validate(json.load(open("out.sarif")))
' )" TEX_SOURCE_DIR "/tests/cli/sarif.schema.json");
    EXPECT_EQ(sarif.code, 0) << sarif.err;
    const Ran junit = shell(scratch_, "xmllint --noout --schema " TEX_SOURCE_DIR "/tests/cli/junit.xsd out.xml");
    EXPECT_EQ(junit.code, 0) << junit.err;
    EXPECT_GT(nlohmann::json::parse(scratch_.read("out.sarif"))["runs"][0]["results"].size(), 60u);
}

TEST_F(CheckNormals, DocumentsDoNotDependOnThreads) {
    const std::vector<std::string> files = {"good.dds", "down.dds",  "bricks.png", "--require", "y=up",
                                            "--sarif",  "out.sarif", "--junit",    "out.xml"};
    const auto documents = [&](const std::string& threads) {
        auto arguments = files;
        arguments.insert(arguments.end(), {"--threads", threads});
        const Ran ran = check(arguments);
        const std::string times = std::regex_replace(scratch_.read("out.xml"), std::regex("time=\"[0-9.]+\""), "");
        return ran.out + scratch_.read("out.sarif") + times;
    };
    EXPECT_EQ(documents("1"), documents("4"));
}

TEST_F(CheckNormals, HeightMapsAreComparedWithTheirNormals) {
    const auto report = [&](const std::string& height) {
        return nlohmann::json::parse(check({"good.dds", "--height", height, "--json"}).out);
    };
    const auto own = report("bricks.png");
    EXPECT_GT(own["pair"]["correlation"], 0.9);
    EXPECT_NEAR(own["pair"]["strength"].get<double>(), 12.0, 1.0);
    EXPECT_EQ(own["pair"]["y"], "up");
    EXPECT_EQ(own["findings"].size(), 0u);
    EXPECT_NE(
        check({"good.dds", "--height", "bricks.png"}).out.find("good.dds: best fit to the height map: correlation "),
        std::string::npos);
    scratch_.add_sample("waves.png", "waves.png");
    EXPECT_EQ(report("waves.png")["findings"][0]["id"], "N601");
    EXPECT_EQ(check({"good.dds", "down.dds", "--height", "bricks.png"}).code, 2);
}

// The judge of these maps is the commands of others: the rule makes its own heights from the normals.
TEST_F(CheckNormals, OcclusionIsComparedWithTheNormals) {
    bake("again.dds", {"--occlusion-out", "ao.png"});
    scratch_.add_sample("waves.png", "waves.png");
    const auto report = [&](const std::string& map, const std::string& occlusion) {
        return nlohmann::json::parse(check({map, "--occlusion", occlusion, "--json"}).out);
    };
    const auto notes = [&](const std::string& map, const std::string& occlusion) {
        auto findings = report(map, occlusion)["findings"].get<std::vector<nlohmann::json>>();
        std::erase_if(findings, [](const nlohmann::json& finding) { return finding["id"] != "N603"; });
        return findings;
    };
    const auto own = report("good.dds", "ao.png");
    EXPECT_GT(own["occlusion"]["correlation"], 0.9);
    EXPECT_EQ(own["findings"].size(), 0u);
    const auto expect_note = [&](const std::string& map, const std::string& occlusion, const std::string& words) {
        const auto findings = notes(map, occlusion);
        ASSERT_EQ(findings.size(), 1u) << occlusion;
        EXPECT_EQ(findings[0]["severity"], "note");
        EXPECT_NE(findings[0]["message"].get<std::string>().find(words), std::string::npos) << findings[0]["message"];
    };
    expect_note("good.dds", "waves.png", "their correlation is ");
    const auto change = [&](const std::string& from, const std::string& to, auto changed) {
        const Image image = *read_image(scratch_.path(from));
        const Extent extent = image.extent();
        RoughnessChain chain;
        chain.levels.emplace_back(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) chain.levels[0].at(i, j) = changed(image.planes[0], i, j);
        }
        const auto bytes = encode_file(*pack_roughness(chain), Container::png);
        ASSERT_TRUE(bytes);
        scratch_.write(to, std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
    };
    change("ao.png", "closed.png", [](const Plane<float>& from, int i, int j) { return 1.0f - from.at(i, j); });
    expect_note("good.dds", "closed.png", "inverted");
    // transfer-normals makes such occlusion of a mesh that hardly hides itself.
    change("waves.png", "faint.png",
           [](const Plane<float>& from, int i, int j) { return 0.95f + 0.05f * from.at(i, j); });
    EXPECT_EQ(notes("good.dds", "faint.png").size(), 0u);
    // Bricks are the same in a mirror.
    change("bricks.png", "bent.png", [](const Plane<float>&, int i, int j) {
        return static_cast<float>(0.5 + 0.4 * std::sin(0.0004 * i * j) * std::sin(0.04 * i + 0.09 * j));
    });
    const Ran made = run(scratch_, "bake-normals",
                         {"bent.png", "-o", "bent_n.png", "--bumpiness", "12", "--occlusion-out", "bent_ao.png"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(notes("bent_n.png", "bent_ao.png").size(), 0u);
    const auto right = [](const Plane<float>& from, int i, int j) { return from.at(511 - i, j); };
    change("bent_ao.png", "flopped.png", right);
    expect_note("bent_n.png", "flopped.png", "mirrored from left to right");
    EXPECT_NE(check({"good.dds", "--occlusion", "ao.png"}).out.find("correlation of the occlusion with the surface"),
              std::string::npos);
    EXPECT_EQ(check({"good.dds", "down.dds", "--occlusion", "ao.png"}).code, 2);
    EXPECT_EQ(check({"good.dds", "--occlusion", "none.png"}).code, 3);
    ASSERT_EQ(check({"good.dds", "--occlusion", "ao.png", "--report", "page.html"}).code, 0);
    EXPECT_NE(scratch_.read("page.html").find("with occlusion"), std::string::npos);
    // LabPBR holds it in blue.
    bake("labpbr.png", {"--layout", "labpbr"});
    const auto packed = nlohmann::json::parse(check({"labpbr.png", "--swizzle", "labpbr", "--json"}).out);
    EXPECT_GT(packed["occlusion"]["correlation"], 0.9);
    const auto plain = nlohmann::json::parse(check({"labpbr.png", "--swizzle", "rg", "--json"}).out);
    EXPECT_FALSE(plain.contains("occlusion"));
}

TEST_F(CheckNormals, DocumentsNeverReplaceWhatIsRead) {
    scratch_.write("list", "good.dds\n");
    scratch_.write("checks.toml", "");
    const std::string before = scratch_.read("good.dds");
    const auto refuses = [&](std::vector<std::string> arguments, const std::string& reason) {
        const Ran ran = check(arguments);
        EXPECT_EQ(ran.code, 2) << arguments[1] << ": " << ran.out;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    };
    for (const char* option : {"--sarif", "--junit", "--baseline-write", "--report"}) {
        refuses({"good.dds", option, "good.dds"}, "good.dds is the input good.dds");
        refuses({"good.dds", option, "list", "--files-from", "list"}, "list is the file of --files-from");
        refuses({"good.dds", option, "bricks.png", "--height", "bricks.png"}, "bricks.png is the file of --height");
        refuses({"good.dds", option, "checks.toml", "--config", "./checks.toml"},
                "checks.toml is the file of --config");
        refuses({"good.dds", option, "-"}, "needs the name of a file");
        refuses({"good.dds", option, "."}, "is a folder");
    }
    refuses({"@list", "--report", "list"}, "list is the file of @list");
    // A model's buffers and images, of normals or not; the model need not be sound.
    scratch_.write("m.bin", "geometry");
    scratch_.write("m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"m.bin","byteLength":8}],)"
                             R"("images":[{"uri":"bricks.png"}]})");
    refuses({"m.gltf", "--sarif", "m.bin"}, "m.bin is the file of m.gltf");
    refuses({"m.gltf", "--report", "./bricks.png"}, "bricks.png is the file of m.gltf");
    EXPECT_EQ(scratch_.read("m.bin"), "geometry");
    refuses({"good.dds", "--sarif", "f", "--junit", "f"}, "--junit: f is the file of --sarif");
    refuses({"good.dds", "--report", "f", "--baseline-write", "f"}, "--report: f is the file of --baseline-write");
    refuses({"good.dds", "--sarif", "f", "--baseline", "f"}, "--sarif: f is the file of --baseline");
    EXPECT_EQ(scratch_.read("good.dds"), before);
    EXPECT_EQ(scratch_.read("list"), "good.dds\n");
    EXPECT_FALSE(scratch_.has("f"));
    EXPECT_EQ(check({"good.dds", "--sarif", "/dev/null", "--junit", "/dev/null"}).code, 0);
}

// Accepted findings stay accepted if the baseline is rewritten in place.
TEST_F(CheckNormals, ABaselineIsRenewedWithAllFindings) {
    ASSERT_EQ(check({"down.dds", "--require", "y=up", "--baseline-write", "known.json"}).code, 0);
    const std::string before = scratch_.read("known.json");
    EXPECT_EQ(
        check({"down.dds", "--require", "y=up", "--baseline", "known.json", "--baseline-write", "known.json"}).code, 0);
    EXPECT_EQ(scratch_.read("known.json"), before);
    EXPECT_EQ(check({"down.dds", "--require", "y=up", "--baseline", "known.json"}).code, 0);
}

TEST_F(CheckNormals, ABaselineKnowsNamesOfAnyBytes) {
    ASSERT_EQ(shell(scratch_, R"(mv down.dds $'d\xff\x01\xef\xbf\xbe\n.dds')").code, 0);
    const Ran ran = shell(
        scratch_,
        "check-normals d* --require y=up --baseline-write k.json --junit k.xml && check-normals d* --require y=up "
        "--baseline k.json");
    EXPECT_EQ(ran.code, 0) << ran.out;
    EXPECT_TRUE(ran.out.ends_with("1 known and accepted\n")) << ran.out;
    EXPECT_EQ(shell(scratch_, "/usr/bin/python3 -c 'import xml.dom.minidom as x; x.parse(\"k.xml\")'").code, 0)
        << scratch_.read("k.xml");
}

TEST_F(CheckNormals, AnEmptyListHasItsDocuments) {
    scratch_.write("list", "");
    EXPECT_EQ(check({"--files-from", "list"}).code, 2);
    const Ran ran = check({"--files-from", "list", "--allow-empty", "--sarif", "out.sarif", "--junit", "out.xml"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.out, "0 files: 0 errors, 0 warnings, 0 notes\n");
    EXPECT_TRUE(nlohmann::json::parse(scratch_.read("out.sarif"))["runs"][0]["results"].empty());
    EXPECT_TRUE(scratch_.has("out.xml"));
}

// Each file contradicts itself in one place, and the commands read it nevertheless.
TEST_F(CheckNormals, Ktx2ThatContradictsItselfIsReported) {
    bake("good.ktx2", {"--format", "bc5"});
    const std::string good = scratch_.read("good.ktx2");
    const auto descriptor = static_cast<std::size_t>(static_cast<unsigned char>(good[48])) +
                            256 * static_cast<std::size_t>(static_cast<unsigned char>(good[49]));
    const struct {
        std::size_t at;
        char byte;
        std::vector<std::string> rules;
    } changes[] = {
        {descriptor + 14, 2, {"N102", "N111"}},  // the transfer function
        {52, 0, {"N102"}},                       // the size of the descriptor
        {96, 1, {"N102"}},                       // the size of level 0 when uncompressed
        {40, 1, {"N104"}},                       // the number of levels
    };
    for (const auto& change : changes) {
        std::string changed = good;
        changed[change.at] = change.byte;
        scratch_.write("changed.ktx2", changed);
        const Ran ran = check({"changed.ktx2"});
        for (const std::string& rule : change.rules)
            EXPECT_NE(ran.out.find(" " + rule + " "), std::string::npos) << change.at << ran.out;
        EXPECT_EQ(ran.out.find("N101"), std::string::npos) << ran.out;
    }
    std::string eac = good;
    eac[12] = static_cast<char>(155);
    scratch_.write("eac.ktx2", eac);
    const Ran ran = check({"eac.ktx2"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.out.find("says BC5, but VkFormat 155 is eac-rg11-unorm"), std::string::npos) << ran.out;
}

TEST_F(CheckNormals, ListsAndExplainsEveryRule) {
    const Ran list = check({"--list"});
    EXPECT_EQ(list.code, 0);
    std::ifstream page(TEX_BINARY_DIR "/man/check-normals.1");
    const std::string manual{std::istreambuf_iterator<char>(page), {}};
    for (const Rule& rule : rules()) {
        EXPECT_NE(list.out.find(std::string(rule.sentence)), std::string::npos) << rule.id;
        const Ran explained = check({"--explain", std::string(rule.id)});
        EXPECT_EQ(explained.code, 0);
        EXPECT_TRUE(explained.out.starts_with(fmt::format("{} {}", rule.id, rule.name)));
        const std::string heading =
            fmt::format(".It Sy {} Li {} Pq {}", rule.id, rule.name, name_of(kSeverityNames, rule.severity));
        const std::size_t at = manual.find(heading);
        ASSERT_NE(at, std::string::npos) << rule.id << " is not in the manual";
        EXPECT_EQ(manual.find(fmt::format("\n{}\n", rule.sentence), at), manual.find('\n', at)) << rule.id;
    }
    EXPECT_EQ(check({"--explain", "N999"}).code, 2);
    EXPECT_EQ(check({"--list", "good.dds"}).code, 2);
    EXPECT_EQ(check({}).code, 2);
}

}  // namespace tex::cli
