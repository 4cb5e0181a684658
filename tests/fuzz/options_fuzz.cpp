// SPDX-License-Identifier: Apache-2.0
// A command line of any words is understood or refused with a usage error of one line; numbers that are taken are
// finite.
//
// Input: a byte that tells which command, then a line for each argument. Lines that begin with a byte of 128 and more
// name an option by its place in the table, and hold its value; the others are arguments as they are.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "batch/batch.h"
#include "cli/usage_error.h"
#include "options/heights.h"
#include "options/layers.h"
#include "options/mips.h"
#include "options/normals.h"
#include "options/scene.h"

namespace {

using namespace tex;

// Every option group that there is, as if one command had them all.
struct Everything {
    cli::Command command{"every-normals", "Has every option."};
    cli::FileOptions files;
    cli::HeightReader reader;
    cli::WrapOptions wrap;
    cli::OutputOptions output;
    cli::MipChainOptions mips;
    cli::RunOptions running;

    Everything() {
        command.input("FILE...", "files");
        files.add(command);
        reader.strength.add(command);
        reader.heights.add(command);
        reader.color.add(command);
        wrap.add(command, "the border");
        output.add(command, "any", "up");
        mips.add(command, true, "all");
        running.add(command);
    }
};

// The options of layers and pictures have names of the groups above.
struct Layers {
    cli::Command command{"layer-normals", "Has layers."};
    cli::LayerOptions layers;
    cli::NormalsReader normals;

    Layers() {
        layers.add(command);
        normals.add(command);
    }
};

struct Scene {
    cli::Command command{"scene-normals", "Has a scene."};
    cli::SceneOptions scene;

    Scene() { scene.add(command); }
};

std::vector<std::string> arguments_of(const std::uint8_t* data, std::size_t size, const cli::Command& command) {
    std::vector<std::string> arguments;
    std::string line;
    const auto end_line = [&] {
        line = line.substr(0, line.find('\0'));
        if (!line.empty() && static_cast<unsigned char>(line[0]) >= 128) {
            const cli::Option& row = command.options()[static_cast<unsigned char>(line[0]) % command.options().size()];
            arguments.push_back(row.name());
            if (!row.value.empty()) arguments.push_back(line.substr(1));
        } else {
            arguments.push_back(line);
        }
        line.clear();
    };
    for (std::size_t k = 0; k < size; ++k) {
        if (data[k] == '\n') {
            end_line();
        } else {
            line += static_cast<char>(data[k]);
        }
    }
    end_line();
    return arguments;
}

// False where the command line was refused, or has done what it asked for.
bool parse(cli::Command& command, const std::uint8_t* data, std::size_t size) {
    const std::vector<std::string> arguments = arguments_of(data, size, command);
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    cli::MemoryHost host;  // --help and its like print
    cli::Console console("every-normals", host);
    try {
        return !command.parse(pointers, console);
    } catch (const cli::UsageError& error) {
        const std::string text = error.what();
        if (text.empty() || text.find('\n') != std::string::npos) std::abort();
        return false;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kLongest = 4096;
    if (size == 0 || size > kLongest) return 0;
    const int choice = data[0] % 3;
    ++data;
    --size;
    if (choice == 0) {
        Everything everything;
        if (!parse(everything.command, data, size)) return 0;
        const cli::StrengthOptions& strength = everything.reader.strength;
        if (!std::isfinite(strength.bumpiness)) std::abort();
        if (everything.running.read.max_texels < 1 || everything.running.threads < 0) std::abort();
    } else if (choice == 1) {
        Layers layers;
        parse(layers.command, data, size);
    } else {
        Scene scene;
        parse(scene.command, data, size);
    }
    return 0;
}
