// SPDX-License-Identifier: Apache-2.0
// Runs the benchmarks of a verb and prints them as a table in Markdown (verb_bench.h). Each benchmark has seven
// repetitions in random order, so that a busy machine slows all of them alike. The figures are the medians. Options of
// Google Benchmark are accepted: --benchmark_filter=Bake/ runs some of them.
//
// Freed memory is kept for the next iteration. Otherwise a benchmark of whole images would measure page faults: the
// system takes longer to clear a fresh page than a kernel takes to fill it.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <malloc.h>

namespace {

class Table final : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) add(run);
    }
    void Finalize() override;

private:
    static constexpr int kNoSize = 0;     // for rows that stay in the cache
    using Sizes = std::map<int, double>;  // texels per second
    struct Row {
        std::string name;
        std::int64_t order = 0;  // its place in the order of registration
        Sizes speeds;
    };

    void add(const Run& run);
    [[nodiscard]] static std::string cells(const Row& row, const Sizes& columns, const Sizes& copies);

    std::vector<Row> rows_;
    Sizes copies_;
};

int size_of(const std::string& arguments) {
    const std::size_t at = arguments.find("size:");
    return at == std::string::npos ? 0 : std::stoi(arguments.substr(at + 5));
}

void Table::add(const Run& run) {
    if (run.run_type != Run::RT_Aggregate || run.aggregate_name != "median") return;
    const auto speed = run.counters.find("items_per_second");
    if (speed == run.counters.end()) return;
    const std::string name =
        run.report_label.empty() ? run.run_name.function_name : run.run_name.function_name + ", " + run.report_label;
    const std::int64_t order = run.family_index * 1000 + run.per_family_instance_index;
    auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& known) { return known.name == name; });
    if (row == rows_.end()) row = rows_.insert(row, {name, order, {}});
    row->order = std::min(row->order, order);
    row->speeds[size_of(run.run_name.args)] = speed->second;
    if (run.run_name.function_name.ends_with("Copy")) copies_[size_of(run.run_name.args)] = speed->second;
}

std::string Table::cells(const Row& row, const Sizes& columns, const Sizes& copies) {
    std::string text;
    const auto cell = [&text](const char* format, double value) {
        char figure[32];
        std::snprintf(figure, sizeof figure, format, value);
        text += figure;
    };
    for (const auto& [size, any] : columns) {
        const auto speed = row.speeds.find(size);
        const auto copy = copies.find(size);
        speed == row.speeds.end() ? void(text += " |") : cell(" %.0f |", speed->second / 1e6);
        if (size == kNoSize) continue;
        speed == row.speeds.end() || copy == copies.end() ? void(text += " |")
                                                          : cell(" %.2f |", speed->second / copy->second);
    }
    return text;
}

void Table::Finalize() {
    std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.order < b.order; });
    Sizes columns;
    for (const Row& row : rows_) columns.insert(row.speeds.begin(), row.speeds.end());
    std::string head = "\n| one thread, Mtexel/s |", line = "\n|---|";
    for (const auto& [size, any] : columns) {
        const std::string side = std::to_string(size);
        head += size == kNoSize ? " in the cache |" : " " + side + "x" + side + " | of copying |";
        line += size == kNoSize ? "---|" : "---|---|";
    }
    std::printf("%s%s\n", head.c_str(), line.c_str());
    for (const Row& row : rows_) std::printf("| %s |%s\n", row.name.c_str(), cells(row, columns, copies_).c_str());
}

}  // namespace

int main(int argc, char** argv) {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    // The options on the command line come later and override these.
    std::vector<std::string> words = {argv[0], "--benchmark_repetitions=7",
                                      "--benchmark_enable_random_interleaving=true", "--benchmark_min_time=0.1"};
    words.insert(words.end(), argv + 1, argv + argc);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int count = static_cast<int>(words.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    Table table;
    benchmark::RunSpecifiedBenchmarks(&table);
    benchmark::Shutdown();
}
