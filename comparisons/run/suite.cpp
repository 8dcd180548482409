#include "comparisons/run/suite.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "comparisons/judge/calibration.h"
#include "comparisons/judge/judge.h"
#include "comparisons/report/crack_picture.h"
#include "comparisons/report/headline.h"
#include "comparisons/report/report.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/folder_lock.h"
#include "comparisons/run/input_checksum.h"
#include "comparisons/run/part_file.h"
#include "comparisons/run/prepare.h"
#include "comparisons/run/status.h"
#include "comparisons/run/time_left.h"
#include "fem_reference/reference.h"
#include "problem/system/child.h"
#include "problem/system/file_name.h"
#include "problem/system/files.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> interrupted = false;

void on_interrupt(int) {
  interrupted = true;
  fem::interrupt();
}

/// The case's name as a file name.
std::string key_of(const fs::path& file) {
  std::string key = case_name(file);
  std::replace(key.begin(), key.end(), '/', '-');
  return file_name(key);
}

/// One part of one case: the unit of work.
struct Task {
  const PreparedCase* prepared;
  std::size_t material;
  fs::path file;  ///< where the finished part is kept
  VtuOutput vtu;
  std::string stamp;
  std::string title;
  Part part;
  bool done = false;
};

void require_writable(const fs::path& folder) {
  if (folder.empty()) throw InputError("--out: needs the name of a folder");
  std::error_code error;
  fs::create_directories(folder / "parts", error);
  const fs::path trial = folder / ".writable";
  std::ofstream out;
  if (!error) out.open(trial), out << "x", out.close();
  if (error || !out)
    throw InputError(shortened(fmt::format("--out: cannot write into {}: {}", folder.string(),
                                           error ? error.message() : std::strerror(errno))));
  fs::remove(trial, error);
}

std::vector<Task> make_tasks(const std::vector<PreparedCase>& prepared, const SuiteOptions& options) {
  std::vector<Task> tasks;
  const std::string fem = fem::version();
  for (const PreparedCase& p : prepared) {
    const std::string sum = input_checksum(p);
    for (std::size_t m = 0; m < p.experiment.materials.size(); ++m) {
      const std::string key = key_of(p.experiment.file);
      const std::string nu = fmt::format("nu{}", p.experiment.materials[m].poisson_ratio);
      const std::string stamp = fmt::format("{} | {} | {} | {}{} | {} | {}", SPRINGPROOF_VERSION, fem, nu, options.vtu,
                                            options.vtu_single ? " single" : "", options.finer, sum);
      tasks.push_back({&p,
                       m,
                       options.out / "parts" / (key + "-" + nu + ".cbor"),
                       {options.vtu ? options.out / "vtu" / key : fs::path(), options.vtu_single},
                       stamp,
                       fmt::format("{}  {}", case_name(p.experiment.file), nu),
                       {}});
    }
  }
  return tasks;
}

/// Restricts a case to the requested Poisson's ratios, and to the expectations at these or at every one.
/// @throws InputError if it has none of them.
Experiment only(const std::vector<double>& wanted, Experiment e) {
  if (wanted.empty()) return e;
  const auto left_out = [&](double nu) {
    return std::none_of(wanted.begin(), wanted.end(), [&](double w) { return same_poisson_ratio(w, nu); });
  };
  std::string has;
  for (const IsotropicMaterial& m : e.materials) has += fmt::format("{}{}", has.empty() ? "" : ", ", m.poisson_ratio);
  std::erase_if(e.materials, [&](const IsotropicMaterial& m) { return left_out(m.poisson_ratio); });
  std::erase_if(e.expectations, [&](const Expectation& x) { return x.poisson_ratio && left_out(*x.poisson_ratio); });
  std::erase_if(e.published, [&](const PublishedValue& v) { return left_out(v.poisson_ratio); });
  if (e.materials.empty())
    throw InputError(fmt::format("{}: poisson_ratio: none of those wanted (allowed: {})", e.file.string(), has));
  return e;
}

/// Multiplies the cells of the reference's grids along each direction, except in directions of one cell.
/// @throws InputError if the case leaves the choice of its reference grids to the program.
Experiment finer(int times, Experiment e) {
  if (times == 1) return e;
  if (e.reference.cells[0] == 0 && e.reference.edge == 0)
    throw InputError(fmt::format(
        "--finer: {} leaves its reference grids to the program; give it [reference] cells or edge_m", e.file.string()));
  for (int& n : e.reference.cells)
    if (n > 1) n *= times;
  e.reference.edge /= times;
  return e;
}

/// The cases prepared before an interrupt, which also ends the mesher.
std::vector<PreparedCase> prepare_all(const std::vector<fs::path>& cases, const SuiteOptions& options) {
  std::vector<PreparedCase> prepared;
  Status status(options.quiet);
  for (const fs::path& file : cases) try {
      const Status::Working working(status, case_name(file));
      if (!interrupted)
        prepared.push_back(prepare(finer(options.finer, only(options.poisson_ratios, read_experiment(file)))));
    } catch (const std::runtime_error&) {
      if (!interrupted) throw;
    }
  return prepared;
}

std::vector<double> expected(const std::vector<Task>& tasks) {
  std::vector<double> seconds;
  for (const Task& t : tasks)
    seconds.push_back(expected_seconds(*t.prepared, t.prepared->experiment.materials[t.material]));
  return seconds;
}

/// The order in which tasks are started: none of the long ones is left for the end, when other processors idle.
std::vector<std::size_t> longest_first(const std::vector<double>& seconds) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  return order;
}

/// Shows the running parts and prints those finished, with the time left; thread-safe.
class Progress {
 public:
  Progress(const std::vector<Task>& tasks, const std::vector<double>& expected_seconds, int jobs, bool quiet)
      : tasks_(tasks),
        time_left_(expected_seconds, jobs),
        status_(quiet, [this] { return time_left_.at(now()); }),
        quiet_(quiet) {
    const std::size_t parts = tasks.size(), at_once = std::min<std::size_t>(parts, jobs);
    if (const auto all = time_left_.at(0); all && *all > 60 && !quiet)
      status_.print(
          fmt::format("about {} for {} part{}, {} at once", time_words(*all), parts, parts == 1 ? "" : "s", at_once));
  }

  /// Marks a task as running until the end of the scope.
  auto working(std::size_t task) {
    time_left_.started(task, now());
    return Status::Working(status_, fmt::format("[{}/{}] {}", task + 1, tasks_.size(), tasks_[task].title));
  }

  void finished(std::size_t task, double seconds, bool taken_back) {
    const std::lock_guard lock(mutex_);
    ++count_;
    taken_back ? time_left_.kept(task) : time_left_.finished(task, now());
    const auto& runs = tasks_[task].part.runs;
    const auto failed = std::count_if(runs.begin(), runs.end(), [](const Run& r) { return !r.ok; });
    std::string remark = taken_back ? "kept from before" : fmt::format("{:.1f} s", seconds);
    if (failed) remark += fmt::format(", {} run{} without a result", failed, failed == 1 ? "" : "s");
    if (!quiet_) status_.print(fmt::format("[{}/{}] {:<44} {}", count_, tasks_.size(), tasks_[task].title, remark));
  }

 private:
  double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const std::vector<Task>& tasks_;
  std::mutex mutex_;
  std::size_t count_ = 0;
  TimeLeft time_left_;
  Status status_;
  const bool quiet_;
};

/// The part saved by an earlier run, unless its stamp differs or its file is damaged.
std::optional<Part> kept_part(const Task& task) try {
  return load_part(task.file, task.stamp);
} catch (const DamagedPart& e) {
  fmt::print(stderr, "note: {}; this part is computed anew\n", e.what());
  return {};
}

void run_tasks(std::vector<Task>& tasks, const SuiteOptions& options) {
  const int jobs =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const std::vector<double> seconds = expected(tasks);
  const std::vector<std::size_t> order = longest_first(seconds);
  std::atomic<std::size_t> next = 0;
  Progress progress(tasks, seconds, jobs, options.quiet);
  std::mutex failure_mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t k; !interrupted && (k = next++) < tasks.size();) try {
        const std::size_t i = order[k];
        Task& task = tasks[i];
        const auto start = std::chrono::steady_clock::now();
        const Status::Working working = progress.working(i);
        std::optional<Part> kept;
        if (options.resume) kept = kept_part(task);
        task.part = kept ? std::move(*kept) : run_part(*task.prepared, task.material, task.vtu);
        if (interrupted) return;  // its FEM program may have been stopped by the same signal
        if (!kept) save_part(task.file, task.stamp, task.part);
        task.done = true;
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
  if (failure && !interrupted) std::rethrow_exception(failure);
}

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(const Part& from, Part& to) {
  append(from.runs, to.runs);
  append(from.rows, to.rows);
  append(from.references, to.references);
  append(from.pictures, to.pictures);
  append(from.lines, to.lines);
  append(from.histories, to.histories);
  append(from.splits, to.splits);
  append(from.deformations, to.deformations);
  append(from.cracks, to.cracks);
}

std::vector<CaseResult> collect(const std::vector<PreparedCase>& prepared, const std::vector<Task>& tasks) {
  std::vector<CaseResult> results;
  for (const PreparedCase& p : prepared) {
    CaseResult result;
    result.experiment = p.experiment;
    result.size = p.size;
    for (const Lattice& lattice : p.lattices) result.cells.push_back(lattice.cells);
    result.notes = p.notes;
    for (std::size_t m = 0; m < p.models.size(); ++m)
      if (const auto own = own_poisson_ratio(p.models[m].row))
        result.own_poisson_ratios[p.experiment.models[m].label] = *own;
    for (const Task& task : tasks)
      if (task.prepared == &p) append(task.part, result);
    judge(result);
    results.push_back(std::move(result));
  }
  return results;
}

nlohmann::json host() {
  utsname u{};
  uname(&u);
  std::string processor, line;
  for (std::ifstream in("/proc/cpuinfo"); std::getline(in, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  return {{"system", fmt::format("{} {}", u.sysname, u.machine)},
          {"processor", processor},
          {"cores", std::thread::hardware_concurrency()}};
}

std::vector<KnownQuantity> known_quantities(const std::vector<CaseResult>& results) {
  std::vector<KnownQuantity> all;
  for (const CaseResult& r : results) append(known_quantities(r), all);
  return all;
}

nlohmann::json document(const std::vector<CaseResult>& results, const std::vector<KnownQuantity>& known) {
  nlohmann::json cases = nlohmann::json::array();
  for (const CaseResult& r : results) cases.push_back(to_json(r));
  const std::string fem = fem::version();
  return {{"program", {{"name", "springproof"}, {"version", SPRINGPROOF_VERSION}, {"libraries", fem}}},
          {"generated", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"host", host()},
          {"cases", cases},
          {"calibration", calibration_json(known)}};
}

/// Writes everything; true if every expectation holds and every case was compared.
bool write_results(const std::vector<CaseResult>& results, const fs::path& out) {
  const std::vector<KnownQuantity> known = known_quantities(results);
  const nlohmann::json doc = document(results, known);
  nlohmann::json pictures = nlohmann::json::array();
  for (const CaseResult& r : results) pictures.push_back(pictures_to_json(r));
  write_file(out / "results.json", doc.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
  write_file(out / "results.csv", to_csv(results));
  write_crack_pictures(results, out);
  write_report(out / "report.html", doc, pictures);
  const Headline h = headline(doc);
  fmt::print("{}{}report: {}\n", terminal_text(h), calibration_table(known), (out / "report.html").string());
  return success(h);
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

}  // namespace

int compare(const std::vector<fs::path>& cases, const SuiteOptions& options) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  constexpr int most_jobs = 1024;
  if (options.jobs > most_jobs)
    throw InputError(fmt::format("--jobs: is {} (allowed: 0 to {})", options.jobs, most_jobs));
  check_names(cases);
  const std::vector<PreparedCase> prepared = prepare_all(cases, options);
  if (interrupted) {
    fmt::print(stderr, "interrupted before any part was run\n");
    return 130;
  }
  require_writable(options.out);
  const FolderLock lock(options.out);
  std::vector<Task> tasks = make_tasks(prepared, options);
  if (!fem::available()) fmt::print(stderr, "note: springproof-fem is not here; there will be no reference\n");
  run_tasks(tasks, options);
  if (interrupted) {
    const auto done = std::count_if(tasks.begin(), tasks.end(), [](const Task& t) { return t.done; });
    fmt::print(stderr,
               "interrupted; {} of {} parts are kept in {}: the same command with --resume goes on from there\n", done,
               tasks.size(), options.out.string());
    return 130;
  }
  if (!options.live_page.empty())
    fs::copy_file(options.live_page, options.out / "live.html", fs::copy_options::overwrite_existing);
  const std::vector<CaseResult> results = collect(prepared, tasks);
  if (options.vtu)
    for (const CaseResult& r : results) write_series(r, options.out / "vtu" / key_of(r.experiment.file));
  return write_results(results, options.out) ? 0 : 1;
}

}  // namespace springproof
