// SPDX-License-Identifier: Apache-2.0
// The commands, run in this process. tex/_run.py makes run() of these two functions.

#include <atomic>

#include <pybind11/stl.h>

#include "cli/host.h"
#include "cli/programs.h"
#include "modules.h"
#include "running.h"
#include "verb.h"

namespace tex::python {
namespace {

// Keeps what a command prints, and can be stopped.
class PythonHost : public cli::MemoryHost {
public:
    PythonHost(const Execution& execution, std::string out_name)
        : execution_(execution), out_name_(std::move(out_name)) {}

    [[nodiscard]] std::string out_name() const override { return out_name_; }

    // Any thread of the command asks. Progress is not known, so the fraction stays 0.
    [[nodiscard]] std::string_view interruption() const override {
        return execution_.progress(0.0) ? std::string_view() : std::string_view("SIGINT");
    }

private:
    const Execution& execution_;
    const std::string out_name_;
};

const cli::ProgramRow& program_of(const std::string& name) {
    const cli::ProgramRow* const program = cli::find_program(name);
    if (program != nullptr) return *program;
    std::string names;
    std::vector<std::string> all;
    for (const cli::ProgramRow& row : cli::programs()) {
        names += (names.empty() ? "" : ", ") + std::string(row.name);
        all.emplace_back(row.name);
    }
    raise_value("command", "'" + name + "' must be one of " + names + did_you_mean(name, all));
}

bool has_option(const std::string& name, const std::string& option) {
    const cli::ProgramRow& row = program_of(name);
    const std::unique_ptr<cli::Program> program = row.make(row);
    for (const cli::Option& each : program->command.options()) {
        for (const std::string& one : each.names) {
            if (one == option) return true;
        }
    }
    return false;
}

// `out_name` is what "-" stands for as an output.
py::tuple run_command(const std::string& name, const std::vector<std::string>& arguments, const std::string& out_name) {
    const cli::ProgramRow& program = program_of(name);
    std::vector<const char*> words;
    words.reserve(arguments.size());
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    struct Ran {
        int code = 0;
        std::string out, err;
    };
    Running running;
    const Ran ran = running.run([&](const Execution& execution) -> Result<Ran> {
        PythonHost host(execution, out_name);
        const auto code = static_cast<int>(cli::run(program, words, host));
        return Ran{code, host.out(), host.err()};
    });
    return py::make_tuple(ran.code, py::bytes(ran.out), py::bytes(ran.err));
}

}  // namespace

void add_programs(Module& module) {
    std::vector<std::string> names;
    for (const cli::ProgramRow& row : cli::programs()) names.emplace_back(row.name);
    module.module().attr("_commands") = py::cast(names);
    module.module().def("_has_option", &has_option);
    module.module().def("_run", &run_command);
}

}  // namespace tex::python
