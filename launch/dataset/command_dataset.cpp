#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/config/scenario_draws.h"
#include "launch/command/command.h"
#include "launch/dataset/dataset_digest.h"
#include "launch/dataset/dataset_directory.h"
#include "launch/dataset/dataset_growth.h"
#include "launch/process/worker_processes.h"
#include "launch/run/progress.h"
#include "nodes/runtime/process/event.h"

namespace dmise {
namespace {

struct DatasetOptions {
  std::string scenario, seeds, shard = "1/1", out = "out/dataset";
  std::uint64_t seeds_per_shard = 100;
  int workers = 0;  // 0: one for each processor
  bool check = false, force = false;
};

/// Parses two whole numbers >= 0 that are separated by `between`.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text,
                                                                   std::string_view between) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos) return std::nullopt;
  const auto first = parse_count(text.substr(0, at));
  const auto second = parse_count(text.substr(at + between.size()));
  if (!first || !second) return std::nullopt;
  return std::pair(*first, *second);
}

DatasetTask task_of(const DatasetOptions& options) {
  const auto numbers = two_numbers(options.shard, "/");
  if (!numbers || numbers->first < 1 || numbers->first > numbers->second)
    throw ConfigError("--shard: must be i/n with i from 1 to n, got " + printable(options.shard));
  if (options.force && numbers->second > 1)
    throw ConfigError("--force: would remove what other tasks have made, with --shard " +
                      options.shard);
  return {numbers->first, numbers->second};
}

DatasetPlan plan_of(const DatasetOptions& options, const std::string& scenario_text) {
  constexpr std::uint32_t max_shards = 1'000'000;
  const auto seeds = two_numbers(options.seeds, "..");
  if (!seeds || seeds->first > seeds->second || seeds->second > max_sample_seed)
    throw ConfigError("--seeds: must be A..B with 0 <= A <= B <= " +
                      std::to_string(max_sample_seed) + ", got " + printable(options.seeds));
  DatasetPlan plan{.first_seed = seeds->first,
                   .last_seed = seeds->second,
                   .seeds_per_shard = options.seeds_per_shard,
                   .scenario_text = scenario_text,
                   .digest = {}};
  if (plan.shards() > max_shards)
    throw ConfigError("--per-shard: gives more than 1000000 archives, got " +
                      std::to_string(options.seeds_per_shard));
  return plan;
}

/// Reads the scenario of every seed of this task, so that errors are found before the first frame.
void check_seeds(const DatasetPlan& plan, const DatasetTask& task, const ScenarioDraws& draws,
                 SampleMaker& maker) {
  Progress progress;
  const auto check = [&](std::uint64_t seed) {
    const Scenario scenario = draws.draw(seed).scenario;
    const auto as_drawn = [seed](const Error& e) {
      return std::string(e.what()) + " (as drawn for seed " + std::to_string(seed) + ")";
    };
    try {
      check_output_of_dataset(scenario);
      maker.prepare(scenario);
    } catch (const ConfigError& e) {
      throw ConfigError(as_drawn(e));
    } catch (const Error& e) {
      throw Error(as_drawn(e));
    }
  };
  for (std::size_t shard = 0; shard < plan.shards(); ++shard) {
    if (!task.makes(shard)) continue;
    progress.show_share(double(shard) / double(plan.shards()), "dataset: checking the seeds");
    for (std::uint64_t seed = plan.first_of(shard); seed <= plan.last_of(shard); ++seed) {
      check(seed);
      if (stop_signal().is_set()) throw ExitWith{130};
    }
  }
}

/// The samples of a task that are still to be made; assembles its archives.
class TaskWork {
 public:
  TaskWork(const DatasetPlan& plan, const DatasetTask& task, const DatasetDirectory& directory)
      : directory_(directory) {
    for (std::size_t shard = 0; shard < plan.shards(); ++shard) {
      if (!task.makes(shard)) continue;
      seeds_ += plan.last_of(shard) - plan.first_of(shard) + 1;
      if (directory.has_shard(shard)) continue;
      shards_.push_back({shard, plan.first_of(shard), plan.last_of(shard)});
      for (std::uint64_t seed = plan.first_of(shard); seed <= plan.last_of(shard); ++seed)
        if (!directory.has_sample(seed)) to_make_.push_back(seed);
    }
  }

  std::uint64_t seeds() const { return seeds_; }
  const std::vector<std::uint64_t>& to_make() const { return to_make_; }

  /// Assembles, in their order, the archives whose samples exist.
  void assemble() {
    while (next_ < shards_.size()) {
      OpenShard& open = shards_[next_];
      while (open.seed <= open.last && directory_.has_sample(open.seed)) ++open.seed;
      if (open.seed <= open.last) return;
      directory_.assemble(open.shard);
      ++next_;
    }
  }

 private:
  struct OpenShard {
    std::size_t shard;
    std::uint64_t seed, last;  // the first seed whose sample may be missing, and the last
  };
  const DatasetDirectory& directory_;
  std::uint64_t seeds_ = 0;
  std::vector<std::uint64_t> to_make_;
  std::vector<OpenShard> shards_;
  std::size_t next_ = 0;
};

int processors() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

std::string left_text(double elapsed_s, std::size_t done, std::size_t all) {
  if (done == 0) return "";
  return formatted(", %.0f s left", elapsed_s / double(done) * double(all - done));
}

void make_samples(TaskWork& work, const ScenarioDraws& draws, SampleMaker& maker,
                  const DatasetDirectory& directory, int workers) {
  const auto& seeds = work.to_make();
  const auto start = std::chrono::steady_clock::now();
  Progress progress;
  const auto make = [&](std::size_t item) {
    const std::uint64_t seed = seeds[item];
    try {
      directory.write_sample(seed, maker.make(draws.draw(seed)));
    } catch (const ConfigError& e) {
      throw ConfigError("seed " + std::to_string(seed) + ": " + e.what());
    } catch (const std::exception& e) {
      throw Error("seed " + std::to_string(seed) + ": " + e.what());
    }
  };
  const auto outcome = work_in_processes(seeds.size(), workers, make, [&](std::size_t done) {
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::size_t before = work.seeds() - seeds.size();
    progress.show_share(double(before + done) / double(work.seeds()),
                        "dataset: " + std::to_string(before + done) + " of " +
                            counted(work.seeds(), "sample") +
                            left_text(elapsed_s, done, seeds.size()));
    work.assemble();
    return !stop_signal().is_set();
  });
  progress.clear_line();
  if (outcome.interrupted) {
    std::printf("interrupted: the same command continues\n");
    throw ExitWith{130};
  }
  if (outcome.is_config_error) throw ConfigError(outcome.failure);
  if (!outcome.failure.empty()) throw Error(outcome.failure);
  work.assemble();
}

void dataset(const DatasetOptions& options) {
  stop_signal();
  const DatasetTask task = task_of(options);
  const ScenarioDraws draws(options.scenario);
  DatasetPlan plan = plan_of(options, draws.text());
  plan.digest = dataset_digest(draws);
  SampleMaker maker(plan.digest);
  check_seeds(plan, task, draws, maker);
  if (options.check) {
    std::printf("%s: seeds %s can be made\n", printable(options.scenario).c_str(),
                options.seeds.c_str());
    return;
  }
  if (!options.force) plan = grown_plan(options.out, plan);
  DatasetDirectory directory(options.out, plan);
  if (!directory.begin(task, options.force)) {
    std::printf("%s contains this data set, complete; --force repeats it\n", options.out.c_str());
    return;
  }
  TaskWork work(plan, task, directory);
  make_samples(work, draws, maker, directory, options.workers > 0 ? options.workers : processors());
  const std::size_t missing = directory.finish();
  std::printf(
      "%s: %llu samples%s\n", options.out.c_str(), static_cast<unsigned long long>(work.seeds()),
      missing > 0
          ? (", " + std::to_string(missing) + " archives of other tasks are missing").c_str()
          : ", complete: dataset.json");
}

void add_dataset_options(CLI::App& command) {
  auto options = std::make_shared<DatasetOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML) with distributions")
      ->required();
  command.add_option("--seeds", options->seeds, "A..B, one sample each")->required();
  command.add_option("--out", options->out, "directory of the data set")
      ->default_val("out/dataset");
  command
      .add_option("--shard", options->shard,
                  "i/n: only the i-th of every n archives, for the tasks of a job array")
      ->default_val("1/1");
  command.add_option("--per-shard", options->seeds_per_shard, "seeds in an archive")
      ->default_val(100)
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--workers", options->workers,
                  "number of processes; by default one for each processor")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--check", options->check, "only read the scenario of every seed");
  command.add_flag("--force", options->force,
                   "replace the data set in the directory, and files with the names of one");
  command.callback([options] { dataset(*options); });
}

}  // namespace

Command dataset_command() {
  return {.group = CommandGroup::scenarios,
          .summary = "Makes labelled frames of a scenario whose values are drawn, as tar archives",
          .details =
              "The archives are for WebDataset (docs/datasets.md). The bytes depend on scenario, "
              "seeds and --per-shard alone; stopped, the same command continues; with more seeds "
              "it adds them",
          .add_options = add_dataset_options};
}

}  // namespace dmise
