#include "comparisons/sweep/suite.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/report/headline_cases.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/expected_runs.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/status.h"
#include "comparisons/sweep/suite_results.h"
#include "comparisons/sweep/sweep.h"
#include "comparisons/sweep/time_left.h"
#include "fem_reference/exchange/reference.h"
#include "problem/files/file_name.h"
#include "problem/files/new_file.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/shortened.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// One part of one case: the unit of work.
struct Task {
  const PreparedCase* prepared;
  std::size_t setting;
  fs::path file;  ///< where the finished part is kept
  VtuOutput vtu;
  std::string stamp;
  std::string title;
  Part part;
};

void require_writable(const fs::path& folder) {
  if (folder.empty()) throw InputError("--out: needs the name of a folder");
  std::error_code error;
  fs::create_directories(folder / "parts", error);
  try {
    if (!error) NewFile(folder / "trial", {"x"});
  } catch (const std::system_error& e) {
    error = e.code();
  }
  if (error)
    throw InputError(shortened(fmt::format("--out: cannot write into {}: {}", folder.string(), error.message())));
}

std::vector<Experiment> read_all(const std::vector<fs::path>& cases, const SuiteOptions& options) {
  std::vector<Experiment> all;
  for (const fs::path& file : cases)
    all.push_back(finer(options.finer, only(options.poisson_ratios, read_experiment(file))));
  return all;
}

}  // namespace

Sweep planned(const std::vector<Experiment>& cases, const SuiteOptions& options) {
  Sweep sweep{SPRINGPROOF_VERSION, fem::version(), options.shard.value_or(Shard{}).count,
              options.finer,       options.vtu,    {}};
  std::vector<double> seconds;
  for (const Experiment& e : cases) {
    PlannedCase planned{fs::absolute(e.file).string(), e.text, case_name(e.file), key_of(e.file), {}};
    const std::string sum = input_checksum(e);
    const std::vector<double> settings = e.settings();
    for (std::size_t s = 0; s < settings.size(); ++s) {
      const std::string nu = fmt::format("nu{}", settings[s]);
      planned.parts.push_back({settings[s], fmt::format("{}-{}.cbor", planned.key, nu),
                               fmt::format("{} | {} | {} | {}{} | {} | {}", sweep.version, sweep.libraries, nu,
                                           options.vtu, options.vtu_single ? " single" : "", options.finer, sum)});
      seconds.push_back(unmeshed_seconds(e, e.body_material(s)));
    }
    sweep.cases.push_back(std::move(planned));
  }
  const std::vector<int> shards = shards_of(seconds, sweep.shards);
  auto shard = shards.begin();
  for (PlannedCase& c : sweep.cases)
    for (PlannedPart& p : c.parts) p.shard = *shard++;
  return sweep;
}

namespace {

int jobs_of(const SuiteOptions& options) {
  return options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// The parts of the cases that are not meshed yet.
std::vector<std::vector<RunCost>> unmeshed(const std::vector<Experiment>& cases) {
  std::vector<std::vector<RunCost>> parts;
  for (const Experiment& e : cases)
    for (std::size_t s = 0; s < e.settings().size(); ++s)
      parts.push_back({{RunKind::springs, unmeshed_seconds(e, e.body_material(s))}});
  return parts;
}

/// The cases prepared before an interrupt, which also ends the mesher and is said.
std::vector<PreparedCase> prepare_all(const std::vector<Experiment>& cases, const SuiteOptions& options) {
  std::vector<PreparedCase> prepared;
  const TimeLeft time_left(unmeshed(cases), jobs_of(options));
  Status status(options.quiet, [&] { return time_left.at(0); });
  for (const Experiment& e : cases) try {
      const Status::Working working(status, case_name(e.file));
      if (!children_interrupted()) prepared.push_back(prepare(e));
    } catch (const std::runtime_error&) {
      if (!children_interrupted()) throw;
    }
  if (children_interrupted()) to_stderr("interrupted before any part was run\n");
  return prepared;
}

/// Of the parts of the prepared cases those of one shard, or all.
std::vector<Task> tasks_of(const Sweep& sweep, const std::vector<PreparedCase>& prepared, const SuiteOptions& options) {
  std::vector<Task> tasks;
  for (const PreparedCase& p : prepared) {
    const PlannedCase& planned = case_of_key(sweep, key_of(p.experiment.file));
    const std::vector<double> settings = p.experiment.settings();
    for (std::size_t s = 0; s < settings.size(); ++s)
      for (const PlannedPart& part : planned.parts)
        if (same_poisson_ratio(part.poisson_ratio, settings[s]) &&
            (!options.shard || part.shard == options.shard->number))
          tasks.push_back({&p,
                           s,
                           options.out / "parts" / part.file,
                           {options.vtu ? options.out / "vtu" / planned.key : fs::path(), options.vtu_single},
                           part.stamp,
                           title_of(planned, part),
                           {}});
  }
  return tasks;
}

std::vector<std::vector<RunCost>> expected(const std::vector<Task>& tasks) {
  std::vector<std::vector<RunCost>> runs;
  for (const Task& t : tasks)
    runs.push_back(expected_runs(*t.prepared, t.prepared->experiment.body_material(t.setting)));
  return runs;
}

constexpr double shortest_with_estimate = 60;  // [s]: shorter runs say nothing until they end

/// Shows the running parts and prints those finished, with the time left; thread-safe.
class Progress {
 public:
  Progress(const std::vector<Task>& tasks, const std::vector<std::vector<RunCost>>& expected, int jobs, bool quiet)
      : tasks_(tasks),
        jobs_(jobs),
        time_left_(expected, jobs),
        status_(quiet, [this] { return time_left_.at(now()); }),
        quiet_(quiet) {}

  /// Marks a task as running until the end of the scope.
  auto working(std::size_t task) {
    time_left_.started(task, now());
    return Status::Working(status_, fmt::format("[{}/{}] {}", task + 1, tasks_.size(), tasks_[task].title));
  }

  void ran(std::size_t task, const RunCost& expected, std::optional<double> took) {
    time_left_.ran(task, expected, took, now());
    if (took && expected.kind >= RunKind::matrix_free) say_how_long();
  }

  void known_so_far(std::size_t task, const RunKeeper::Words& words) {
    if (quiet_ || time_left_.at(now()).value_or(0) < shortest_with_estimate) return;
    if (const std::string known = words(); !known.empty())
      status_.print(fmt::format("[{}/{}] {}: {}", task + 1, tasks_.size(), tasks_[task].title, known));
  }

  void finished(std::size_t task, double seconds, bool taken_back) {
    time_left_.finished(task);
    say_how_long();
    const std::lock_guard lock(mutex_);
    ++count_;
    const auto& runs = tasks_[task].part.runs;
    const auto failed = std::ranges::count_if(runs, [](const Run& r) { return !r.ok; });
    std::string remark = taken_back ? "kept from before" : fmt::format("{:.1f} s", seconds);
    if (failed) remark += fmt::format(", {} run{} without a result", failed, failed == 1 ? "" : "s");
    if (!quiet_) status_.print(fmt::format("[{}/{}] {:<44} {}", count_, tasks_.size(), tasks_[task].title, remark));
    for (const Run& r : runs)
      if (r.ok && r.kind == "external" && !r.message.empty())
        status_.print(fmt::format("note: {}: {}: {}", tasks_[task].title, r.model, r.message));
  }

 private:
  /// Once, when the first grid of finite elements has shown how fast they are here.
  void say_how_long() {
    const std::lock_guard lock(mutex_);
    if (quiet_ || std::exchange(is_said_, true)) return;
    const std::size_t parts = tasks_.size(), at_once = std::min<std::size_t>(parts, jobs_);
    if (const auto all = time_left_.at(now()); all && *all > shortest_with_estimate)
      status_.print(
          fmt::format("about {} for {} part{}, {} at once", time_words(*all), parts, parts == 1 ? "" : "s", at_once));
  }

  double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const std::vector<Task>& tasks_;
  const int jobs_;
  std::mutex mutex_;
  std::size_t count_ = 0;
  bool is_said_ = false;
  TimeLeft time_left_;
  Status status_;
  const bool quiet_;
};

/// The part saved by an earlier run, unless its stamp differs or its file is damaged.
std::optional<Part> kept_part(const Task& task) try {
  return load_part(task.file, task.stamp);
} catch (const DamagedFile& e) {
  to_stderr("note: {}; this part is computed anew\n", e.what());
  return {};
}

void run_tasks(std::vector<Task>& tasks, const SuiteOptions& options) {
  const int jobs = jobs_of(options);
  const std::vector<std::vector<RunCost>> runs = expected(tasks);
  std::vector<double> seconds;
  for (const std::vector<RunCost>& of_part : runs) seconds.push_back(sum_of(of_part));
  const std::vector<std::size_t> order = longest_first(seconds);
  std::atomic<std::size_t> next = 0;
  Progress progress(tasks, runs, jobs, options.quiet);
  std::mutex failure_mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t k; !children_interrupted() && (k = next++) < tasks.size();) try {
        const std::size_t i = order[k];
        Task& task = tasks[i];
        const auto start = std::chrono::steady_clock::now();
        const Status::Working working = progress.working(i);
        std::optional<Part> kept;
        const RunKeeper keeper(
            fs::path(task.file).replace_extension(".runs"), task.stamp,
            [&, i](const RunCost& expected, std::optional<double> took) { progress.ran(i, expected, took); },
            [&, i](const RunKeeper::Words& words) { progress.known_so_far(i, words); });
        const bool goes_on = options.resume || options.shard;
        if (goes_on) kept = kept_part(task);
        if (!goes_on) keeper.forget();
        task.part = kept ? std::move(*kept) : run_part(*task.prepared, task.setting, task.vtu, keeper);
        if (children_interrupted()) return;  // its FEM program may have been stopped by the same signal
        if (!kept) save_part(task.file, task.stamp, task.part);
        keeper.forget();
        progress.finished(i, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                          kept.has_value());
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = tasks.size();
      }
  };
  std::vector<std::thread> workers;
  for (std::size_t j = 0; j < std::min(static_cast<std::size_t>(jobs), tasks.size()); ++j) workers.emplace_back(work);
  for (std::thread& w : workers) w.join();
  if (failure && !children_interrupted()) std::rethrow_exception(failure);
}

/// @throws InputError if two cases would write the same files, or one could write none.
void check_names(const std::vector<fs::path>& cases) {
  for (const fs::path& file : cases)
    if (key_of(file).size() > longest_file_name)
      throw InputError(shortened(fmt::format("{}: a name too long for the results' files (allowed: up to {} letters)",
                                             key_of(file), longest_file_name)));
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (file_name_key(key_of(cases[i])) == file_name_key(key_of(cases[j])))
        throw InputError(fmt::format("{} and {} have the same name; rename one, or compare them one at a time",
                                     cases[j].string(), cases[i].string()));
}

/// Says which models may lose their equilibrium, before anything is run.
void warn_of_limits(const std::vector<PreparedCase>& prepared) {
  for (const PreparedCase& p : prepared)
    for (const LatticeLimit& limit : p.limits) to_stderr("warning: {}\n", limit_sentence(p.experiment, limit));
}

/// Runs the tasks; false if interrupted, which is said.
bool completed(std::vector<Task>& tasks, const SuiteOptions& options) {
  if (!fem::available()) to_stderr("note: springproof-fem is not here; there will be no reference\n");
  const std::string words =
      fmt::format("interrupted; what is finished is kept in {}: the same command {}goes on from there",
                  options.out.string(), options.shard ? "" : "with --resume ");
  set_last_words(words);
  run_tasks(tasks, options);
  if (children_interrupted()) to_stderr("{}\n", words);
  return !children_interrupted();
}

int run_shard(const std::vector<fs::path>& files, const SuiteOptions& options) {
  const auto [number, count] = *options.shard;
  const std::string out = options.out.string();
  std::vector<Experiment> cases = read_all(files, options);
  require_writable(options.out);
  const FolderLock lock(options.out, FolderLock::beside_shards);
  const Sweep sweep = common_plan(options.out, planned(cases, options));
  const ByteLock once(sweep_file(options.out), number,
                      fmt::format("--shard: {}/{} is at work in {} already (wait for its end)", number, count, out));
  std::erase_if(cases, [&, shard = number](const Experiment& e) {
    const std::vector<PlannedPart>& parts = case_of_key(sweep, key_of(e.file)).parts;
    return std::ranges::none_of(parts, [&](const PlannedPart& p) { return p.shard == shard; });
  });
  const std::vector<PreparedCase> prepared = prepare_all(cases, options);
  if (children_interrupted()) return interrupted_status;
  warn_of_limits(prepared);
  for (const PreparedCase& p : prepared) save_meshed(options.out, key_of(p.experiment.file), case_of(p));
  std::vector<Task> tasks = tasks_of(sweep, prepared, options);
  if (!completed(tasks, options)) return interrupted_status;
  to_stdout("shard {}/{}: its {} part{} in {}; once every shard has ended: springproof report {}\n", number, count,
            tasks.size(), tasks.size() == 1 ? " is" : "s are", out, out);
  return 0;
}

int run_all(const std::vector<fs::path>& files, const SuiteOptions& options) {
  const std::vector<Experiment> cases = read_all(files, options);
  const std::vector<PreparedCase> prepared = prepare_all(cases, options);
  if (children_interrupted()) return interrupted_status;
  warn_of_limits(prepared);
  require_writable(options.out);
  const FolderLock lock(options.out);
  const ByteLock no_shards(
      sweep_file(options.out), ByteLock::all,
      fmt::format("--out: {} is in use by shards (wait for their end, or name another folder)", options.out.string()));
  const Sweep plan = planned(cases, options);
  std::vector<Task> tasks = tasks_of(plan, prepared, options);
  if (!completed(tasks, options)) return interrupted_status;
  std::vector<CaseResult> results;
  for (const PreparedCase& p : prepared) {
    results.push_back(case_of(p));
    for (const Task& task : tasks)
      if (task.prepared == &p) append(task.part, results.back());
  }
  return write_results(std::move(results), plan.libraries, options) ? 0 : 1;
}

}  // namespace

int compare(const std::vector<fs::path>& cases, const SuiteOptions& options) {
  set_last_words("interrupted before any part was run");
  end_at_interrupts();
  constexpr int most_jobs = 1024;
  if (options.jobs < 0 || options.jobs > most_jobs)
    throw InputError(fmt::format("--jobs: is {} (allowed: 0 to {})", options.jobs, most_jobs));
  check_names(cases);
  return options.shard ? run_shard(cases, options) : run_all(cases, options);
}

}  // namespace springproof
