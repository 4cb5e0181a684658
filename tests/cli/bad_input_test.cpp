// SPDX-License-Identifier: Apache-2.0
// Files that every command must survive: missing, damaged or lying files, and outputs that cannot be written. The
// command must exit with the documented code, print one sentence, and leave nothing half-written.

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
}

// The commands that write an output for each input, which is a picture.
std::vector<std::string> writers() {
    std::vector<std::string> names = commands();
    std::erase_if(names, [](const std::string& name) {
        return name == "build-normals" || name == "check-normals" || name == "compare-normals" ||
               name == "transfer-normals";
    });
    return names;
}

}  // namespace

// A PSD of 8x8 texels with this compression of its texels.
std::string psd_with(std::uint32_t compression) {
    std::string file = "8BPS" + std::string("\0\1\0\0\0\0\0\0\0\3", 10) + big_endian(8) + big_endian(8);
    file += std::string("\0\x8\0\3", 4) + std::string(12, '\0');  // 8 bits, RGB; no palette, resources or layers
    return file + big_endian(compression).substr(2) + std::string(3 * 8 * 8, '\x80');
}

TEST(BadInput, OfAKindThatTheDecoderLacksIsUnsupportedAndNotDamaged) {
    const Scratch scratch;
    scratch.write("raw.psd", psd_with(0));
    scratch.write("zip.psd", psd_with(2));
    scratch.write("cut.psd", psd_with(0).substr(0, 100));
    const auto go = [&](const char* name) {
        return run(scratch, "unpack-normals", {name, "-o", "x.png", "--no-sync", "--json"});
    };
    EXPECT_EQ(go("raw.psd").code, 0);
    const Ran zip = go("zip.psd");
    EXPECT_EQ(zip.code, 4);
    EXPECT_EQ(nlohmann::json::parse(zip.out)["error"]["code"], "unsupported") << zip.out;
    EXPECT_NE(zip.err.find("ZIP compression in PSD is not supported"), std::string::npos) << zip.err;
    const Ran cut = go("cut.psd");
    EXPECT_EQ(cut.code, 4);
    EXPECT_EQ(nlohmann::json::parse(cut.out)["error"]["code"], "bad-data") << cut.out;
}

class EveryBadInput : public testing::TestWithParam<std::string> {
protected:
    EveryBadInput() {
        std::filesystem::create_directory(scratch_.path("in"));
        scratch_.add_sample("ramp.png", "good.png");
        scratch_.write("in/sheet.obj", kSheetObj);
        for (const std::string kind : {"dds", "ktx2", "exr", "png"}) {
            EXPECT_EQ(run(scratch_, "bake-normals", {"good.png", "-o", "in/whole." + kind, "--no-sync"}).code, 0);
            whole_[kind] = scratch_.read("in/whole." + kind);
        }
    }

    // The arguments that the command needs besides inputs and outputs.
    [[nodiscard]] std::vector<std::string> needed() const {
        if (GetParam() == "scale-normals") return {"--scale", "2"};
        if (GetParam() == "blend-normals") return {"--detail", "in/whole.png"};
        if (GetParam() == "mip-normals") return {"--mips", "none"};
        if (GetParam() == "convert-normals") return {"--mesh", "in/sheet.obj", "--to", "object"};
        return {};
    }
    Ran go(std::vector<std::string> arguments) {
        const auto more = needed();
        arguments.insert(arguments.end(), more.begin(), more.end());
        arguments.insert(arguments.end(), {"--no-sync", "--quiet"});  // no warnings about heights in colours
        return run(scratch_, GetParam(), arguments);
    }

    // Writes in/NAME and remembers it.
    void add(const std::string& name, const std::string& bytes) {
        scratch_.write("in/" + name, bytes);
        names_.push_back("in/" + name);
    }
    // A file of type `kind` with `bytes` at `offset`.
    std::string patched(const std::string& kind, std::size_t offset, const std::string& bytes) {
        return std::string(whole_[kind]).replace(offset, bytes.size(), bytes);
    }
    void add_liars() {
        const std::string zero(4, '\0'), many = big_endian(100000);
        const std::string many_little(many.rbegin(), many.rend());
        add("zero.dds", patched("dds", 16, zero));                       // 0x64
        add("huge.dds", patched("dds", 12, many_little + many_little));  // 100000x100000
        add("zero.ktx2", patched("ktx2", 20, zero));
        add("huge.ktx2", patched("ktx2", 20, many_little + many_little));
        // The checksum of the header stays wrong: a reader that checks sizes first must refuse the file, too.
        add("zero.png", patched("png", 16, zero));
        add("huge.png", patched("png", 16, many + many));
        add("empty.dds", "");
        add("magic.dds", patched("dds", 0, "DDT "));
        add("text.png", "no picture at all\n");
    }

    Scratch scratch_;
    std::map<std::string, std::string> whole_;
    std::vector<std::string> names_;
};

INSTANTIATE_TEST_SUITE_P(Cli, EveryBadInput, testing::ValuesIn(writers()), [](const auto& instance) {
    std::string name = instance.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST_P(EveryBadInput, IsRefusedWithASentenceAndAnExitCode) {
    add_liars();
    std::vector<std::string> arguments = names_;
    const bool takes_folders = GetParam() == "repair-normals";
    arguments.insert(arguments.end(), {"in/missing.png", "--out-dir", "out", "--name", "{stem}_{ext}.png", "--json"});
    if (!takes_folders) arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(names_.size()) + 1, "in");
    const Ran ran = go(arguments);
    EXPECT_EQ(ran.code, 4) << ran.err;
    const auto told = lines_of(ran.out), said = lines_of(ran.err);
    ASSERT_EQ(told.size(), names_.size() + (takes_folders ? 1 : 2));
    EXPECT_EQ(said.size(), told.size()) << ran.err;
    for (std::size_t k = 0; k < told.size(); ++k) {
        const auto line = nlohmann::json::parse(told[k]);
        const bool is_readable = k < names_.size();
        ASSERT_TRUE(line.contains("error")) << told[k];
        EXPECT_EQ(line["error"]["code"] == "io", !is_readable) << told[k];
        EXPECT_TRUE(said[k].starts_with(GetParam() + ": error: " + line["input"].get<std::string>() + ": ")) << said[k];
    }
    EXPECT_TRUE(std::filesystem::is_empty(scratch_.path("out")));
}

// Cuts the file at every power of two. The command must report an error, or read the complete levels.
TEST_P(EveryBadInput, TruncatedFilesAreRefusedOrReadAsFarAsTheyGo) {
    for (const auto& [kind, bytes] : whole_) {
        for (std::size_t size = 1; size < bytes.size(); size *= 2)
            add(fmt::format("cut{}.{}", size, kind), bytes.substr(0, size));
    }
    std::vector<std::string> arguments = names_;
    arguments.insert(arguments.end(), {"--out-dir", "out", "--name", "{stem}_{ext}.png", "--json"});
    const Ran ran = go(arguments);
    EXPECT_EQ(ran.code, 4) << ran.err;
    const auto told = lines_of(ran.out);
    ASSERT_EQ(told.size(), names_.size());
    std::set<std::string> written;
    for (const std::string& text : told) {
        const auto line = nlohmann::json::parse(text);
        if (line.contains("error")) {
            EXPECT_TRUE(line["error"]["code"] == "bad-data" || line["error"]["code"] == "unsupported") << text;
        } else {
            EXPECT_TRUE(line["input"].get<std::string>().ends_with(".dds")) << text;  // only a base level
            written.insert(line["output"].get<std::string>().substr(4));
        }
    }
    std::set<std::string> there;
    for (const auto& entry : std::filesystem::directory_iterator(scratch_.path("out")))
        there.insert(entry.path().filename());
    EXPECT_EQ(there, written);
}

TEST_P(EveryBadInput, OutputsThatCannotBeWrittenAreAnError) {
    scratch_.add_sample("hemisphere.png", "dome.png");
    EXPECT_EQ(run(scratch_, "bake-normals", {"dome.png", "-o", "large.png", "--no-sync"}).code, 0);
    scratch_.write("old.png", "old");
    const auto before = scratch_.list();
    for (const std::string target : {"no/such/folder.png", "good.png/x.png"}) {
        const Ran ran = go({"in/whole.png", "-o", target});
        EXPECT_EQ(ran.code, 3) << ran.err;
        EXPECT_TRUE(ran.err.starts_with(GetParam() + ": error: " + target + ": ")) << ran.err;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
    }
    // A limit on the size of files is the closest to a full disk that is possible without a mount.
    std::string line = "ulimit -f 1; " + GetParam() + " large.png -o old.png --no-sync --quiet";
    for (const std::string& argument : needed()) line += " " + argument;
    const Ran full = shell(scratch_, line);
    EXPECT_EQ(full.code, 3) << full.err;
    EXPECT_EQ(lines_of(full.err).size(), 1u) << full.err;
    EXPECT_EQ(scratch_.read("old.png"), "old");
    EXPECT_EQ(scratch_.list(), before);
}

}  // namespace tex::cli
