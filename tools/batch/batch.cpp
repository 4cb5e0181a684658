// SPDX-License-Identifier: Apache-2.0

#include "batch/batch.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include <sys/stat.h>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include "batch/depfile.h"
#include "batch/name_pattern.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/stream.h"
#include "cli/usage_error.h"
#include "reports/report.h"
#include "threads/fork_join.h"

// When Highway's library is loaded, it asks this function of its own for the resolution of the processor's clock, for
// its benchmarks, and takes 3 ms to find out: a third of what a small texture takes from start to finish. A program's
// functions come before those of its libraries.
namespace hwy::platform {
__attribute__((visibility("default"))) double TimerResolution();
double TimerResolution() { return 1e-8; }
}  // namespace hwy::platform

namespace tex::cli {
namespace {

// Files in work at once, whatever the number of processors: what is beyond them speeds up each file, and
// memory stays that of a few textures.
constexpr int kMostFilesAtOnce = 8;

constexpr const char* kBug = "this is a bug: please report it with the command line and, if you can, the file";

class Runner {
public:
    Runner(const std::vector<Task>& tasks, const FileOptions& files, const RunOptions& run, const Steps& steps)
        : tasks_(tasks), run_(run), steps_(steps), reporter_(tasks.size(), run.json),
          shows_progress_(run.shows_progress()) {
        write_options_.sync = !files.no_sync;
        write_options_.no_clobber = files.no_clobber;
        write_options_.reader = run.read;
    }

    // Every worker takes the next file that nobody has: files are begun in the order of the inputs.
    void run() {
        const int threads = run_.threads > 0 ? run_.threads : tbb::info::default_concurrency();
        const int workers =
            std::min({threads, static_cast<int>(std::min<std::size_t>(tasks_.size(), kMostFilesAtOnce))});
        const auto work = [this](int) {
            for (std::size_t k = next_++; k < tasks_.size() && !stopped(); k = next_++)
                reporter_.finish(k, process(tasks_[k]));
        };
        if (workers <= 1) {
            work(0);
        } else {
            try {
                fork_join(workers, workers, work);
            } catch (const std::runtime_error&) {  // of TBB: process() lets nothing through
                throw std::system_error(EAGAIN, std::generic_category(), "the system refuses threads");
            }
        }
        clear_progress();
    }

    [[nodiscard]] const Reporter& reporter() const { return reporter_; }
    [[nodiscard]] const WriteOptions& write_options() const { return write_options_; }

private:
    [[nodiscard]] bool stopped() const { return caught_signal() != 0 || reporter_.is_abandoned(); }

    Outcome process(const Task& task) {
        double counted = 0.0;  // of this file, in done_
        Job job(task, run_.read, write_options_, run_.threads, [&](double fraction) {
            if (shows_progress_) {
                const double done = done_ += fraction - counted;
                counted = fraction;
                draw_progress(
                    done / static_cast<double>(tasks_.size()),
                    tasks_.size() == 1 ? task.input : fmt::format("{} of {} files", finished_.load(), tasks_.size()));
            }
            return !stopped();
        });
        Outcome outcome;
        try {
            auto result = would_clobber(task) ? Error{ErrorCode::io, task.output, "exists, and --no-clobber is given"}
                                              : steps_.process(job);
            if (!result) outcome.error = result.error();
        } catch (const std::bad_alloc&) {
            outcome.error = Error{ErrorCode::out_of_memory, {}, "out of memory"};
        } catch (const std::exception& exception) {
            outcome.error = Error{ErrorCode::io, {}, fmt::format("{}; {}", exception.what(), kBug)};
            outcome.is_bug = true;
        }
        outcome.input = task.input;
        outcome.report = std::move(job.report);
        outcome.text = job.text();
        outcome.code = job.code();
        outcome.warnings = job.warnings();
        outcome.outputs = job.outputs();
        outcome.prerequisites = job.prerequisites();
        outcome.has_levels = has_level(task.output);
        // The library cannot tell a full disk from a reader that went away; a reader that is content is not
        // an error to talk about.
        outcome.is_silent = outcome.error && task.output == "-" && stdout_is_abandoned();
        done_ += 1.0 - counted;
        ++finished_;
        return outcome;
    }

    // Known before the work is done; the library makes sure once more when it writes.
    [[nodiscard]] bool would_clobber(const Task& task) const {
        struct stat status {};
        return write_options_.no_clobber && stat(with_level(task.output, 0).c_str(), &status) == 0 &&
               S_ISREG(status.st_mode);
    }

    const std::vector<Task>& tasks_;
    const RunOptions& run_;
    const Steps& steps_;
    WriteOptions write_options_;
    Reporter reporter_;
    bool shows_progress_;
    std::atomic<std::size_t> next_{0};
    std::atomic<std::size_t> finished_{0};
    std::atomic<double> done_{0.0};
};

ExitCode write_depfile(const std::string& path, const std::vector<Dependency>& dependencies,
                       const WriteOptions& options) {
    const std::string text = depfile_text(dependencies);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    WriteOptions write = options;
    write.no_clobber = false;  // a depfile is rewritten by every run
    const auto written = write_file(path, std::vector<std::byte>(bytes, bytes + text.size()), write);
    if (written) return ExitCode::done;
    print_error(written.error().message());
    return exit_code(written.error().code);
}

}  // namespace

bool RunOptions::shows_progress() const {
    return !quiet &&
           (progress == ShowProgress::always || (progress == ShowProgress::automatic && stderr_is_terminal()));
}

void RunOptions::add(Command& command) {
    command.group("Running");
    command.number(threads, "--threads", "N", 0, 1024, "the most threads at once").preset = "0, one for each processor";
    command.flag(json, "--json",
                 "tell the results on standard output, a JSON object for each file on a line of its own");
    command.flag(quiet, "--quiet", "no warnings and no progress; errors are always told");
    command.choice(progress, "--progress", "WHEN", kShowProgressNames, "show a progress bar");
    const auto count = [](auto& target) { return [&target](const std::string& text) { target = parse_count(text); }; };
    command.option("--max-texels", "N", "refuse files of more texels (K, M, G: powers of 1024)", count(read.max_texels))
        .preset = count_text(read.max_texels);
    command
        .option("--reader-memory", "BYTES", "memory limit of the process that reads TIFF, TGA, JPEG and the like",
                count(read.reader_memory))
        .preset = count_text(read.reader_memory);
    command.number(read.reader_timeout, "--reader-timeout", "SECONDS", 1, 86400, "time limit of that process");
    command.check([this] {
        if (quiet) set_quiet();
    });
}

namespace {

ExitCode failed(const Error& error) {
    print_error(error.message());
    return exit_code(error.code);
}

ExitCode run_tasks(const std::vector<Task>& tasks, const FileOptions& files, const RunOptions& run,
                   const Steps& steps) {
    std::optional<tbb::global_control> limit;
    if (run.threads > 1)
        limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(run.threads));
    catch_signals();
    Runner runner(tasks, files, run, steps);
    runner.run();
    if (const int signal = caught_signal(); signal != 0) {
        print_error(fmt::format("interrupted by SIG{}; {} of {} files are done", sigabbrev_np(signal),
                                runner.reporter().done(), tasks.size()));
        end_by_signal(signal);
    }
    if (steps.finish) steps.finish();
    ExitCode code = runner.reporter().exit_code();
    if (!files.depfile.empty()) {
        code = std::max(code, write_depfile(files.depfile, runner.reporter().dependencies(), runner.write_options()));
    }
    return code;
}

}  // namespace

ExitCode run_batch(const Command& command, const FileOptions& files, const RunOptions& run, const OutputOptions& output,
                   const Steps& steps) {
    const auto tasks = files.plan(command, output, steps.defaults);
    if (!tasks) return failed(tasks.error());
    if (steps.check) {
        if (const auto checked = steps.check(*tasks); !checked) return failed(checked.error());
    }
    if (const auto created = files.create_folders(*tasks); !created) return failed(created.error());
    return run_tasks(*tasks, files, run, steps);
}

ExitCode run_readers(const Command& command, const FileOptions& files, const RunOptions& run, const Steps& steps) {
    const auto inputs = files.list_inputs(command);
    if (!inputs) return failed(inputs.error());
    std::vector<Task> tasks;
    for (const std::string& input : *inputs) tasks.push_back({input, "", Container::dds});
    if (steps.check) {
        if (const auto checked = steps.check(tasks); !checked) return failed(checked.error());
    }
    return run_tasks(tasks, files, run, steps);
}

int run_main(const char* program, const std::function<ExitCode()>& body) {
    ExitCode code = ExitCode::bug;
    try {
        set_program(program);
        secure_streams();
        code = body();
    } catch (const UsageError& error) {
        print_error(error.what());
        code = ExitCode::usage;
    } catch (const std::bad_alloc&) {
        print_error("out of memory");
        code = ExitCode::io;
    } catch (const std::system_error& error) {
        print_error(error.what());
        code = ExitCode::io;
    } catch (const std::exception& error) {
        print_error(fmt::format("{}; {}", error.what(), kBug));
    } catch (...) {
        print_error(kBug);
    }
    return static_cast<int>(code);
}

}  // namespace tex::cli
