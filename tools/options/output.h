// SPDX-License-Identifier: Apache-2.0
// output.h: the option group that determines what is written.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/pack.h>

#include "cli/command.h"
#include "tasks/engines.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

class Job;

struct OutputOptions {
    std::optional<Encoding> format;      // none: the container's default, or another default of the command
    bool keeps_format = false;           // --format keep: each input's, if the container can hold it
    std::optional<Container> container;  // none: from the output's extension
    std::optional<YAxis> y;              // none: the input's
    Effort effort = PackOptions{}.effort;
    Metric metric = PackOptions{}.metric;
    RdoOptions rdo;
    DdsHeader dds_header = WriteOptions{}.dds_header;
    bool dds_mark = WriteOptions{}.dds_mark;
    std::optional<int> zstd;  // none: blocks of Basis Universal are compressed
    std::optional<int> quality;
    std::vector<const Engine*> engines;  // of --for; each input gives an output for each
    const Engine* engine = nullptr;      // the engine of these options, which of() has set

    // `format_default` and `y_default` appear in the help. With `with_keep`, --format has the word keep.
    void add(Command& command, std::string format_default, std::string y_default, bool with_keep = false,
             Container standard_output = Container::dds);
    // Adds --for, for commands that also have MipChainOptions.
    void add_engines(Command& command);

    // The options for one engine (null: for none): what the user has not set comes from the engine's preset.
    [[nodiscard]] OutputOptions of(const Engine* its_engine) const;
    // What of() takes: the engines of --for, or null alone.
    [[nodiscard]] std::vector<const Engine*> engines_or_none() const;

    // The container of names that the command makes itself, if the options set it.
    [[nodiscard]] std::optional<Container> made_container() const;
    // Sets the fields that these options know.
    void fill(NameFields& fields) const;

    // The container of `output`; for "-" it is `standard_output`. Throws UsageError if the name does not show the
    // container, or if the container cannot be compressed as the user asks.
    [[nodiscard]] Container container_for(const std::string& output, Container standard_output) const;

    // Without --y, y is that of the input, and is stated only if it is known. A metric of angles implies the best
    // effort.
    [[nodiscard]] PackOptions pack_options(Encoding encoding, YAxis input, bool input_known) const {
        const Effort effort_for_metric = metric == Metric::angle ? Effort::best : effort;
        return {encoding, y.value_or(input), effort_for_metric, metric, y || input_known, rdo};
    }
    // The job's write options, with the user's choices.
    [[nodiscard]] WriteOptions write_options(const Job& job) const;

    // For names with {format}: throws UsageError with --format keep, which is known only once an input is read.
    void check_knows_format() const;
    // How the levels of a file of this format are compressed: unless the user says it, blocks of UASTC are.
    [[nodiscard]] int zstd_for(Format stored) const;

    // Throws UsageError if the container cannot hold `encoding`.
    static void check_holds(const std::string& output, Container container, Encoding encoding);

private:
    void add_format(Command& command, std::string preset, bool with_keep);
    void add_rdo(Command& command);
    [[nodiscard]] Container container_of_output(const std::string& output, Container standard_output) const;
};

// The library's default encoding for each container: "dxt5nm in dds, ktx2; rgb8 in png, tga, ...".
[[nodiscard]] std::string default_encodings(Encoding of_textures = Encoding::dxt5nm);

// Puts extent, levels, format, y and bytes into the job's report, and what optimisation has done, if there was any.
void report_texture(Job& job, Extent extent, int levels, const PackOptions& pack, std::size_t bytes,
                    const std::optional<RdoReport>& rdo);

}  // namespace tex::cli
