// SPDX-License-Identifier: Apache-2.0
// Runs the jobs of samples/farm as far as possible without their engines.

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class FarmSamples : public testing::Test {
protected:
    FarmSamples() {
        const Ran made =
            shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/*.png " TEX_SOURCE_DIR
                            "/samples/normals.toml .\n"
                            "build-normals --no-sync --quiet && mv built expected && rm .normals.toml.state\n"
                            "mkdir fake && printf '#!/bin/sh\\necho \"$@\" >>requeued' >fake/scontrol\n"
                            "chmod +x fake/scontrol\n");
        EXPECT_EQ(made.code, 0) << made.err;
    }
    // Runs a script with the names of the samples' folder and of the fake programs.
    [[nodiscard]] Ran bash(const std::string& script) const {
        return shell(scratch_, "set -e; farm=" TEX_SOURCE_DIR "/samples/farm; PATH=$PWD/fake:$PATH\n" + script);
    }
    // Prints a value of a YAML file: a Python expression of its document `d`.
    static std::string yaml(const std::string& file, const std::string& expression) {
        return fmt::format("python3 -c 'import yaml; d = yaml.safe_load(open(\"{}/samples/farm/{}\")); print({})'",
                           TEX_SOURCE_DIR, file, expression);
    }
    void expect_complete(const Ran& ran) const {
        EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
        const Ran same = shell(scratch_, "diff -r --exclude=reports expected built");
        EXPECT_EQ(same.code, 0) << same.out << same.err;
    }

    Scratch scratch_;
};

TEST_F(FarmSamples, SlurmArraysMakeEverything) {
    expect_complete(
        bash("build-normals --plan plan.jsonl; export SLURM_ARRAY_JOB_ID=77 SLURM_CPUS_PER_TASK=1\n"
             "for k in 1 2 3; do SLURM_ARRAY_TASK_ID=$k bash $farm/slurm.sh 3; done\n"
             "[ ! -e requeued ]; build-normals --plan plan.jsonl --merge reports/*.jsonl"));
}

TEST_F(FarmSamples, SlurmTasksThatAreKilledAskForAnotherTry) {
    const std::string killed =
        "printf '#!/bin/sh\\nkill -KILL $$' >fake/build-normals; chmod +x fake/build-normals; printf '#!/bin/sh' "
        ">fake/sleep; chmod +x fake/sleep\nexport SLURM_ARRAY_JOB_ID=77 SLURM_ARRAY_TASK_ID=3; ";
    EXPECT_EQ(bash(killed + "bash $farm/slurm.sh 3").code, 137);
    EXPECT_EQ(scratch_.read("requeued"), "requeue 77_3\n");
    EXPECT_EQ(bash(killed + "SLURM_RESTART_COUNT=3 bash $farm/slurm.sh 3").code, 137);
    EXPECT_EQ(scratch_.read("requeued"), "requeue 77_3\n") << "not for ever";
    EXPECT_EQ(bash("rm -f fake/build-normals; SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=1 bash $farm/slurm.sh 3").code,
              3);
    EXPECT_EQ(scratch_.read("requeued"), "requeue 77_3\n") << "an error stays one";
}

TEST_F(FarmSamples, GnuParallelSendsLostShardsAgain) {
    if (!is_installed("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
    expect_complete(bash("bash $farm/parallel.sh : 3"));
    // A shard whose first try is killed.
    std::filesystem::remove_all(scratch_.path("built"));
    std::filesystem::remove(scratch_.path(".normals.toml.state"));
    expect_complete(
        bash("real=$(command -v build-normals); printf '#!/bin/sh\\ncase \"$*\" in *\" 2/3 \"*) [ -e tried ] || { "
             "touch tried; kill -KILL $$; } ;; esac\\nexec %s \"$@\"' \"$real\" >fake/build-normals\n"
             "chmod +x fake/build-normals; bash $farm/parallel.sh : 3; [ -e tried ]"));
    // A texture that cannot be made is not tried for ever.
    scratch_.write("bad.png", "no picture");
    EXPECT_EQ(bash("rm fake/build-normals; bash $farm/parallel.sh : 3").code, 1);
}

TEST_F(FarmSamples, KubernetesIndicesAreShards) {
    const std::string container = "d[\"spec\"][\"template\"][\"spec\"][\"containers\"][0]";
    expect_complete(bash("build-normals --plan plan.jsonl; count=$(" +
                         yaml("kubernetes.yml", "d[\"spec\"][\"completions\"]") +
                         ")\nfor k in $(seq 0 $((count - 1))); do JOB_COMPLETION_INDEX=$k bash -c \"$(" +
                         yaml("kubernetes.yml", container + "[\"args\"][0]") +
                         ")\"; done\nbuild-normals --plan plan.jsonl --merge reports/*.jsonl"));
    EXPECT_EQ(bash("[ \"$(" + yaml("kubernetes.yml", container + "[\"command\"]") + ")\" = \"['bash', '-c']\" ]").code,
              0);
}

TEST_F(FarmSamples, TheMatrixNeedsNoSharedFolder) {
    const auto steps = [](const std::string& job) {
        return "\"$(" +
               yaml("github.yml", "\"\\n\".join(s[\"run\"] for s in d[\"jobs\"][\"" + job +
                                      "\"][\"steps\"] if s.get(\"run\", \"\").startswith(\"build-normals\"))") +
               ")\"";
    };
    expect_complete(bash("bash -c " + steps("plan") + "\nfor k in $(" +
                         yaml("github.yml", "*d[\"jobs\"][\"shard\"][\"strategy\"][\"matrix\"][\"shard\"]") +
                         "); do mkdir m$k; cp *.png normals.toml plan.jsonl m$k; (cd m$k; SHARD=$k bash -e -c " +
                         steps("shard") + "); mkdir -p built; cp -r m$k/built/. built; done\nbash -c " +
                         steps("merge")));
}

}  // namespace tex::cli
