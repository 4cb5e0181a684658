// SPDX-License-Identifier: Apache-2.0

#include "tree/texture_maker.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>
#include <variant>

#include "batch/repack.h"

namespace tex::cli {
namespace {

// The tasks and jobs of one texture's steps. Options refer to their job, so both stay where they are.
class Jobs {
public:
    Jobs(const MakeSettings& settings, Console& console) : settings_(settings), console_(console) {}

    Job& add(Task task) {
        tasks_.push_back(std::move(task));
        Job& job = jobs_.emplace_back(
            tasks_.back(), console_, settings_.running.read, settings_.write, settings_.running.threads,
            [this](double fraction, const std::string&) { return settings_.advance(fraction); });
        job.shared_maps = settings_.shared;
        return job;
    }
    void add_words(Made& made) const {
        for (const Job& job : jobs_) {
            made.text += job.text();
            if (job.report.contains("bumpiness")) made.bumpiness = job.report["bumpiness"];
            made.warnings.insert(made.warnings.end(), job.warnings().begin(), job.warnings().end());
            made.remarks.insert(made.remarks.end(), job.remarks().begin(), job.remarks().end());
        }
    }

private:
    const MakeSettings& settings_;
    Console& console_;
    std::deque<Task> tasks_;
    std::deque<Job> jobs_;
};

// The number of levels that a step makes; 0: all, or those of the source.
int levels_of(const Step& step) {
    if (const auto* bake = std::get_if<BakeFileOptions>(&step)) return bake->mip.levels;
    if (const auto* blend = std::get_if<BlendFileOptions>(&step)) return blend->mip.levels;
    const auto& pack = std::get<PackFileOptions>(step);
    return pack.mip ? pack.mip->levels : 0;
}

// Makes the step store how it packs its output.
void keep_packing(Step& step, PackOptions& kept) {
    const auto keep = [&kept](std::function<PackOptions(const SourceInfo&)>& pack) {
        pack = [inner = std::move(pack), &kept](const SourceInfo& source) { return kept = inner(source); };
    };
    if (const auto* bake = std::get_if<BakeFileOptions>(&step)) {
        kept = bake->pack;
    } else if (auto* pack = std::get_if<PackFileOptions>(&step)) {
        keep(pack->pack);
    } else {
        keep(std::get<BlendFileOptions>(step).pack);
    }
}

// Takes the output of a step as one more file of another step.
MoreFile more_file(const Step& step, const Task& task) {
    MoreFile file;
    file.output = task.output;
    file.container = task.container;
    file.levels = levels_of(step);
    std::visit(
        [&](const auto& options) {
            file.level_names = options.level_names;
            file.write = options.write;
        },
        step);
    if (const auto* bake = std::get_if<BakeFileOptions>(&step)) {
        file.pack = [pack = bake->pack](const SourceInfo&) { return pack; };
    } else if (const auto* pack = std::get_if<PackFileOptions>(&step)) {
        file.pack = pack->pack;
    } else {
        file.pack = std::get<BlendFileOptions>(step).pack;
    }
    return file;
}

// Notes what the steps have learnt about the files: the first step about heights, one other about normals.
void note(const Recipe& recipe, const RecipeOutput& output, const std::string& input, const StepsReport& report,
          Jobs& jobs) {
    Job& job = jobs.add(Task{input, {}});
    Converter& last = *output.last.converter;
    Converter& first = recipe.before().empty() ? last : *recipe.before().front().converter;
    first.note(job, report);
    if (&first != &last && dynamic_cast<NormalsConverter*>(&first) == nullptr) last.note(job, report);
}

// The files that an output has if it has this number of levels.
std::vector<std::string> files_of(const std::string& path, int levels) {
    const int count = has_level(path) ? levels : 1;
    std::vector<std::string> files;
    files.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) files.push_back(with_level(path, k));
    return files;
}

// Writes the files of options of the step elsewhere.
void redirect(Step& step, const std::map<std::string, std::string>& further) {
    auto* const pack = std::get_if<PackFileOptions>(&step);
    if (pack == nullptr) return;
    const auto turn = [&](auto& file) {
        if (!file) return;
        if (const auto place = further.find(file->output); place != further.end()) file->output = place->second;
    };
    turn(pack->roughness);
    for (const Extra extra : kExtras) turn(pack->apart[extra]);
}

// The files that a step has written, in the order of Recipe::files_of(). `path` is its output.
std::vector<std::string> files_of(const Task& task, const std::string& path, int levels) {
    std::vector<std::string> names = {path}, files;
    names.insert(names.end(), task.more_outputs.begin(), task.more_outputs.end());
    std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return has_level(name); });
    for (const std::string& name : names) {
        for (std::string& file : files_of(name, levels)) files.push_back(std::move(file));
    }
    return files;
}

// Adds the files that the command writes, in the order of Recipe::files_of().
Result<void> run_command(Converter& converter, Job& job, std::vector<std::string>& files) {
    if (Result<void> done = converter.process_task(job); !done) return done;
    if (job.code() != ExitCode::done) {
        const std::string why = job.warnings().empty() ? "has findings" : job.warnings().back().message;
        return Error{ErrorCode::bad_data, job.task.input, job.why().empty() ? why : job.why()};
    }
    const std::vector<std::string>& more = job.task.more_outputs;
    for (const std::string& file : job.outputs()) {
        if (std::find(more.begin(), more.end(), file) == more.end()) files.push_back(file);
    }
    files.insert(files.end(), more.begin(), more.end());
    return {};
}

// An error if the command refuses the input.
Result<void> accept_input(const Converter& converter, const std::string& input, const MakeSettings& settings,
                          Jobs& jobs) {
    if (settings.takes_any) return {};
    return converter.accept(jobs.add(Task{input, {}}));
}

// Commands that are no steps make their outputs one after the other.
Result<Made> run_commands(const Recipe& recipe, const std::string& input, const std::vector<WantedOutput>& wanted,
                          const MakeSettings& settings, Jobs& jobs) {
    if (auto accepted = accept_input(*recipe.outputs()[wanted.front().index].last.converter, input, settings, jobs);
        !accepted)
        return accepted.error();
    Made made;
    for (const WantedOutput& output : wanted) {
        std::vector<std::string>& files = made.files.emplace_back();
        for (Task& task : recipe.tasks_of(input, output.index, output.path)) {
            Job& job = jobs.add(std::move(task));
            if (auto done = run_command(*recipe.outputs()[output.index].last.converter, job, files); !done)
                return done.error();
        }
    }
    jobs.add_words(made);
    made.text.clear();  // what transfers say of each map
    return made;
}

// Makes outputs with the same data beside the normals, in one flow.
Result<Made> make_together(const Recipe& recipe, const std::string& input, const std::vector<WantedOutput>& wanted,
                           const MakeSettings& settings, Console& console) {
    Jobs jobs(settings, console);
    // The files between two steps do not exist; their names say that they are EXR files.
    const std::string between = "between.exr";
    std::vector<Step> steps;
    std::string from = input;
    if (!recipe.before().empty()) {
        const Converter& reader = *recipe.before().front().converter;
        if (auto accepted = accept_input(reader, input, settings, jobs); !accepted) return accepted.error();
    }
    for (const ReadyCommand& command : recipe.before()) {
        steps.push_back(*command.converter->step(jobs.add(command.converter->task_for(from, between, input))));
        from = between;
    }
    // The output with the most levels is made by the last step itself, and the others beside it.
    struct Ending {
        Step step;
        const Task* task;
    };
    std::vector<Ending> endings;
    for (const WantedOutput& output : wanted) {
        Converter& converter = *recipe.outputs()[output.index].last.converter;
        Task task;
        if (!recipe.outputs()[output.index].last.writes.empty())
            task = std::move(recipe.tasks_of(input, output.index, output.path).front());
        else if (from == input)
            task = recipe.first_task(converter, from, output.path);
        else
            task = converter.task_for(from, output.path, input);
        if (!output.write_to.empty()) task.output = output.write_to;
        Job& job = jobs.add(std::move(task));
        std::optional<Step> step = converter.step(job);
        if (!step) return run_commands(recipe, input, wanted, settings, jobs);
        redirect(*step, output.further);
        if (!settings.takes_any && recipe.before().empty()) converter.add_accept(*step, job);
        endings.push_back({std::move(*step), &job.task});
    }
    const auto has_fewer = [](const Ending& a, const Ending& b) {
        const int levels = levels_of(a.step);
        return levels > 0 && (levels_of(b.step) == 0 || levels < levels_of(b.step));
    };
    std::vector<const Task*> tasks;
    for (const Ending& ending : endings) tasks.push_back(ending.task);
    std::vector<PackOptions> packs(wanted.size());
    for (std::size_t k = 0; k < endings.size(); ++k) keep_packing(endings[k].step, packs[k]);
    std::iter_swap(endings.begin(), std::max_element(endings.begin(), endings.end(), has_fewer));
    const Task* const first = endings.front().task;
    std::vector<MoreFile> more;
    for (std::size_t k = 1; k < endings.size(); ++k) more.push_back(more_file(endings[k].step, *endings[k].task));
    if (!settings.source.empty()) {
        MoreFile& source = more.emplace_back();
        source.output = settings.source;
        source.container = Container::exr;
        source.levels = 1;
        source.pack = [](const SourceInfo&) { return PackOptions{Encoding::float_}; };
        source.write.sync = false;
    }
    steps.push_back(std::move(endings.front().step));
    std::visit([&](auto& options) { options.more = std::move(more); }, steps.back());
    const Execution execution{settings.running.threads, settings.advance};
    Result<StepsReport> done = apply_steps(input, steps, first->output, first->container, execution);
    const RecipeOutput& output = recipe.outputs()[wanted.front().index];
    if (!done) {
        const Converter& reader = recipe.before().empty() ? *output.last.converter : *recipe.before().front().converter;
        return reader.with_remedy(done.error());
    }
    note(recipe, output, input, *done, jobs);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const int levels = std::get_if<PackFileOptions>(&steps.back()) == nullptr ? 0 : done->levels;
        recipe.outputs()[wanted[k].index].last.converter->note_output(
            jobs.add(*tasks[k]), {done->extent, levels, done->left_out > 0, packs[k].encoding}, wanted[k].path);
    }
    Made made;
    made.report = std::move(*done);
    made.packs = std::move(packs);
    jobs.add_words(made);
    for (std::size_t k = 0; k < wanted.size(); ++k)
        made.files.push_back(files_of(*tasks[k], wanted[k].path, made.report.levels));
    return made;
}

}  // namespace

Result<Made> make_texture(const Recipe& recipe, const std::string& input, const std::vector<WantedOutput>& wanted,
                          const MakeSettings& settings, Console& console) {
    const auto data_of = [&](const WantedOutput& output) { return recipe.outputs()[output.index].data; };
    std::vector<std::string> groups;
    for (const WantedOutput& output : wanted) {
        if (std::find(groups.begin(), groups.end(), data_of(output)) == groups.end()) groups.push_back(data_of(output));
    }
    if (groups.size() < 2) return make_together(recipe, input, wanted, settings, console);
    Made made;
    made.files.resize(wanted.size());
    made.packs.resize(wanted.size());
    MakeSettings own = settings;
    for (std::size_t group = 0; group < groups.size(); ++group) {
        std::vector<WantedOutput> together;
        std::vector<std::size_t> places;
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            if (data_of(wanted[k]) != groups[group]) continue;
            together.push_back(wanted[k]);
            places.push_back(k);
        }
        const auto count = static_cast<double>(groups.size());
        own.advance = [&settings, group, count](double fraction) {
            return settings.advance((static_cast<double>(group) + fraction) / count);
        };
        Result<Made> some = make_together(recipe, input, together, own, console);
        if (!some) return some;
        for (std::size_t k = 0; k < places.size(); ++k) {
            made.files[places[k]] = std::move(some->files[k]);
            if (k < some->packs.size()) made.packs[places[k]] = some->packs[k];
        }
        if (group == 0) made.text = std::move(some->text);  // the others read the same heights
        if (made.bumpiness.is_null()) made.bumpiness = std::move(some->bumpiness);
        some->report.bytes += made.report.bytes;
        made.report = std::move(some->report);
        add_new(std::move(some->warnings), made.warnings);
        add_new(std::move(some->remarks), made.remarks);
        own.source.clear();  // the normals before packing are the same
    }
    return made;
}

}  // namespace tex::cli
