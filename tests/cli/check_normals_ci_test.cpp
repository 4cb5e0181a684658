// SPDX-License-Identifier: Apache-2.0
// Runs the commands in the files of samples/ci, as far as possible without their servers, on right and wrong files.

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class CheckNormalsCi : public testing::Test {
protected:
    CheckNormalsCi() {
        scratch_.add_sample("waves.png", "waves.png");
        EXPECT_EQ(shell(scratch_,
                        "mkdir -p art samples/ci && cp " TEX_SOURCE_DIR "/samples/ci/* samples/ci && git init -q . && "
                        "git config user.email a@b.c && git config user.name a")
                      .code,
                  0);
    }
    void bake(const std::string& output, const std::string& y) {
        EXPECT_EQ(
            run(scratch_, "bake-normals", {"waves.png", "-o", output, "--bumpiness", "8", "--y", y, "--no-sync"}).code,
            0);
    }
    // The lines of a workflow that find files and check them.
    std::string steps(const std::string& file) {
        std::string script = "set -e\n";
        for (std::string line : lines_of(scratch_.read("samples/ci/" + file))) {
            const auto at = line.find_first_not_of(" -");
            if (at == std::string::npos) continue;
            line.erase(0, at);
            if (line.starts_with("find art") || line.starts_with("check-normals --")) script += line + "\n";
        }
        return script;
    }
    Scratch scratch_;
};

TEST_F(CheckNormalsCi, WorkflowsPassAndFail) {
    for (const auto& [file, document] :
         {std::pair<const char*, const char*>{"github.yml", "normals.html"}, {"gitlab.yml", "normals.xml"}}) {
        bake("art/a_n.dds", "up");
        // What engines put beside the pictures.
        scratch_.write("art/a_n.dds.meta", "guid: 1");
        scratch_.write("art/a_n.dds.import", "[remap]");
        ASSERT_EQ(shell(scratch_, "cp samples/ci/checks.toml .").code, 0);
        const Ran good = shell(scratch_, steps(file));
        EXPECT_EQ(good.code, 0) << file << good.out << good.err;
        EXPECT_TRUE(scratch_.has(document));
        EXPECT_TRUE(scratch_.has("normals.html"));
        bake("art/a_n.dds", "down");
        const Ran bad = shell(scratch_, steps(file));
        EXPECT_EQ(bad.code, 1) << file << bad.out << bad.err;
        EXPECT_NE(scratch_.read(document).find("N401"), std::string::npos);
        const bool annotates = bad.out.find("::error file=art/a_n.dds,title=N401 wrong-y::") != std::string::npos;
        EXPECT_EQ(annotates, std::string_view(file) == "github.yml") << bad.out;
    }
}

// The steps of the action that are scripts, with a stand-in for the archive: a folder with this build's command.
TEST_F(CheckNormalsCi, ActionUnpacksAndChecks) {
    const std::string print =
        "import yaml\n"
        "for step in yaml.safe_load(open('samples/ci/action.yml'))['runs']['steps']:\n"
        "    if 'run' in step: print('(set -eo pipefail; PATH=$(cat path):$PATH\\n' + step['run'] + ')')\n";
    scratch_.write("print.py", print);
    const std::string before =
        "set -e; mkdir -p temp stage/libtex-0/bin; : >path; ln -sf \"$(command -v check-normals)\" stage/libtex-0/bin; "
        "tar -C stage -cJf libtex.tar.xz libtex-0; export RUNNER_TEMP=$PWD/temp GITHUB_PATH=$PWD/path "
        "ARCHIVE=libtex.tar.xz FOLDER=art NAME='*_n.*' CONFIG=samples/ci/checks.toml; ";
    const std::string sum = "export SHA256=$(sha256sum libtex.tar.xz | cut -d' ' -f1); ";
    const std::string steps = "python3 print.py >steps.sh; . ./steps.sh";
    bake("art/a_n.dds", "up");
    const Ran good = shell(scratch_, before + sum + steps);
    EXPECT_EQ(good.code, 0) << good.out << good.err;
    EXPECT_TRUE(scratch_.has("temp/normals.html"));
    bake("art/a_n.dds", "down");
    EXPECT_EQ(shell(scratch_, before + sum + steps).code, 1);
    EXPECT_NE(scratch_.read("temp/normals.sarif").find("N401"), std::string::npos);
    EXPECT_NE(shell(scratch_, before + "export SHA256=00; " + steps).code, 0) << "another archive than the one named";
}

TEST_F(CheckNormalsCi, HookRefusesWhatIsStaged) {
    EXPECT_EQ(shell(scratch_, "cp samples/ci/pre-commit.sh .git/hooks/pre-commit").code, 0);
    bake("art/a_n.dds", "up");
    EXPECT_EQ(shell(scratch_, "git add art && git commit -qm right").code, 0);
    bake("art/a_n.dds", "down");
    const Ran refused = shell(scratch_, "git add art && git commit -qm wrong");
    EXPECT_NE(refused.code, 0);
    const std::string said = "\n" + refused.out + refused.err;
    EXPECT_NE(said.find("N401"), std::string::npos) << said;
    // The names that the user knows, in messages and in commands.
    EXPECT_EQ(said.find("/tmp"), std::string::npos) << said;
    EXPECT_NE(said.find("\nart/a_n.dds"), std::string::npos) << said;
    EXPECT_NE(said.find("pack-normals art/a_n.dds "), std::string::npos) << said;
    for (const char* name : {"wall_NORM.dds", "wall-nm.dds", "WallNormalGL.dds"}) {
        const Ran other = shell(scratch_, std::string("git reset -q && cp art/a_n.dds art/") + name +
                                              " && git add art/" + name + " && git commit -qm wrong");
        EXPECT_NE((other.out + other.err).find("N401"), std::string::npos) << name << other.out << other.err;
    }
    EXPECT_EQ(shell(scratch_, "git reset -q && echo text > readme && git add readme && git commit -qm 'no maps'").code,
              0);
}

// A hook that rewrites: what is staged is repaired in the working tree, and staged again by hand.
TEST_F(CheckNormalsCi, HookRepairsWhatIsStaged) {
    EXPECT_EQ(shell(scratch_, "cp samples/ci/pre-commit-repair.sh .git/hooks/pre-commit").code, 0);
    bake("art/a_n.dds", "up");
    const std::string make =
        "pack-normals art/a_n.dds -o art/a_n.png --format rgb8 && cp art/a_n.png right.png && "
        "convert right.png -separate -swap 0,2 -combine -strip art/a_n.png && rm art/a_n.dds && "
        "git add art";
    EXPECT_EQ(shell(scratch_, make).code, 0);
    const std::string bgr = scratch_.read("art/a_n.png");
    // What is not staged is nobody's to change.
    EXPECT_EQ(shell(scratch_, "cp art/a_n.png keep; echo more >>art/a_n.png").code, 0);
    const Ran partly = shell(scratch_, "git commit -qm partly");
    EXPECT_NE(partly.code, 0);
    EXPECT_NE(partly.err.find("changes that are not staged"), std::string::npos) << partly.err;
    EXPECT_EQ(scratch_.read("art/a_n.png"), bgr + "more\n");
    EXPECT_EQ(shell(scratch_, "mv keep art/a_n.png").code, 0);
    const Ran refused = shell(scratch_, "git commit -qm wrong");
    EXPECT_NE(refused.code, 0);
    EXPECT_NE(refused.err.find("art/a_n.png: repaired; look at it"), std::string::npos) << refused.err;
    EXPECT_EQ(shell(scratch_, "compare-normals right.png art/a_n.png --max 0").code, 0);
    EXPECT_EQ(shell(scratch_, "git add art && git commit -qm right").code, 0);
}

// Both stand in the repository, and fit the copies of the staged files.
TEST_F(CheckNormalsCi, HookUsesTheConfigurationAndTheBaseline) {
    EXPECT_EQ(shell(scratch_, "cp samples/ci/pre-commit.sh .git/hooks/pre-commit").code, 0);
    scratch_.write("checks.toml", "require = [\"y=up\"]\n[[rule]]\nmatch = \"art/dx/*\"\nrequire = [\"y=down\"]\n");
    EXPECT_EQ(shell(scratch_, "mkdir -p art/dx").code, 0);
    bake("art/dx/a_n.dds", "down");
    bake("art/old_n.dds", "down");
    EXPECT_EQ(shell(scratch_,
                    "check-normals --config checks.toml art --baseline-write known.json && "
                    "git add checks.toml known.json art && git commit -qm accepted")
                  .code,
              0);
    bake("art/dx/a_n.dds", "up");
    const Ran refused = shell(scratch_, "git add art && git commit -qm wrong");
    EXPECT_NE(refused.code, 0);
    EXPECT_NE((refused.out + refused.err).find("art/dx/a_n.dds"), std::string::npos) << refused.out << refused.err;
    EXPECT_EQ((refused.out + refused.err).find("art/old_n.dds"), std::string::npos) << refused.out << refused.err;
}

}  // namespace tex::cli
