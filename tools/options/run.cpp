// SPDX-License-Identifier: Apache-2.0

#include "options/run.h"

namespace tex::cli {

void RunOptions::add(Command& command) {
    command.group("Running");
    command.number(threads, "--threads", "N", 0, 1024, "the most threads at once").preset = "0, one for each processor";
    command.flag(json, "--json", "print the results on standard output, one JSON object a line for each file")
        .often(8, "print the results as JSON");
    command.flag(quiet, "--quiet", "no warnings and no progress; errors are always printed")
        .often(9, "no warnings and no progress");
    command.choice(progress, "--progress", "WHEN", kShowProgressNames, "show a progress bar");
    const auto count = [](auto& target) { return [&target](const std::string& text) { target = parse_count(text); }; };
    command.option("--max-texels", "N", "refuse files of more texels (K, M, G: powers of 1024)", count(read.max_texels))
        .preset = count_text(read.max_texels);
    command.text(read.layer, "--layer", "NAME",
                 "read this layer: of EXR by name, such as Normal; of arrays and cube maps by number");
    command
        .option("--reader-memory", "BYTES", "memory limit of the process that reads TIFF, JPEG and the like",
                count(read.reader_memory))
        .preset = count_text(read.reader_memory);
    command.number(read.reader_timeout, "--reader-timeout", "SECONDS", 1, 86400, "time limit of that process");
}

bool RunOptions::shows_progress(const Host& host) const {
    return !quiet &&
           (progress == ShowProgress::always || (progress == ShowProgress::automatic && host.err_is_terminal()));
}

Execution RunOptions::step(Console& console, double from, double to, const std::string& words) const {
    const bool shown = shows_progress(console.host());
    if (shown) console.draw_progress(from, words);
    return {threads, [=, &console](double done) {
                if (shown) console.draw_progress(from + (to - from) * done, words);
                return console.host().interruption().empty();
            }};
}

}  // namespace tex::cli
