#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "comparisons/advise/advice.h"
#include "comparisons/advise/measure.h"
#include "comparisons/commands/commands.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "msm/parameters/model_table.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// "0.3", "0.3:0.49" (both ends and the middle) or "0.3,0.45".
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> out;
  const bool range = text.find(':') != std::string::npos;
  std::string part;
  std::istringstream in(text);
  while (std::getline(in, part, range ? ':' : ',')) {
    std::size_t read = 0;
    double nu = 2;
    try {
      nu = std::stod(part, &read);
    } catch (const std::exception&) {
    }
    if (read != part.size() || !(nu > -1 && nu < 0.5))
      throw InputError(
          fmt::format("--nu: '{}' (allowed: numbers from above -1 to below 0.5, as 0.3, 0.3:0.49 or "
                      "0.3,0.45)",
                      text));
    out.push_back(nu);
  }
  if (out.empty() || (range && (out.size() != 2 || out[0] > out[1])))
    throw InputError(fmt::format("--nu: '{}' (allowed: a range is FIRST:LAST, the first the smaller)", text));
  if (range) out.insert(out.begin() + 1, (out[0] + out[1]) / 2);
  std::ranges::sort(out);
  return out;
}

/// The smallest and the largest: the case's own, or those of --nu.
std::vector<IsotropicMaterial> ends_of(const Experiment& e, const std::string& wanted) {
  std::vector<IsotropicMaterial> all = e.materials;
  if (!wanted.empty()) {
    const IsotropicMaterial first = all.front();
    all.clear();
    for (const double nu : numbers_of(wanted)) all.push_back({first.youngs_modulus, nu, first.density});
  }
  std::ranges::sort(all, [](const auto& a, const auto& b) { return a.poisson_ratio < b.poisson_ratio; });
  if (all.size() > 2) all = {all.front(), all.back()};
  return all;
}

void check_models(const std::vector<std::string>& models) {
  for (const std::string& name : models) resolve({name, {}, name, {}});
}

/// `springproof advise CASE`.
class AdviseCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: a model reaches the error within the budget; 1: none does; with --check 0 if nine of ten predictions
  ///   are hits; with --measure-held-out 130 if interrupted.
  /// @throws InputError for unusable input.
  int run() const;

 private:
  Forecast forecast() const;
  int check() const;

  std::string case_, poisson_ratios_, check_name_;
  bool check_ = false, json_ = false;
  double pilot_cells_ = 1500;
  Wish wish_;
  std::filesystem::path measure_held_out_;
};

void AdviseCommand::add_options(CLI::App& command) {
  command.add_option("CASE", case_, "case file (*.toml) or built-in name (springproof list)");
  command.add_option("--error", wish_.error, "displacement error that is wanted, as a part of the displacement")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command.add_option("--budget-ms-per-step", wish_.ms_per_step, "milliseconds of one core per explicit step")
      ->check(positive());
  command.add_option("--budget-seconds", wish_.seconds, "CPU seconds of a static solve")->check(positive());
  command.add_option("--budget-memory", wish_.MiB, "MiB of a static solve")->check(positive());
  command
      .add_option("--cells-across", wish_.cells_across,
                  "of a block: predict for about so many cells across the thinnest part")
      ->check(positive());
  command.add_option("--models", wish_.models, "only these rows of the model table (default: seven of them)")
      ->delimiter(',');
  command.add_option("--nu", poisson_ratios_,
                     "Poisson's ratio, a range FIRST:LAST or a list; the worst counts (default: the case's ends)");
  command.add_flag("--json", json_, "print JSON");
  command.add_option("--measure-held-out", measure_held_out_,
                     "measure anew the cases of --check, into this file (resumes)");
  command
      .add_option("--check", check_name_, "predictions against held-out cases (of those whose names contain this; all)")
      ->expected(0, 1)
      ->each([this](const std::string&) {});
  command
      .add_option("--pilot-cells", pilot_cells_,
                  "cells of the finest lattice on which every model is solved; the reference takes 20 times as many")
      ->check(CLI::Range(50.0, 50000.0))
      ->capture_default_str();
  command.callback([this, &command] { check_ = command.count("--check") > 0; });
  command.footer(
      "Exit status: 0 a model reaches the error within the budget (--check: nine of ten predictions are within a "
      "factor "
      "of 1.5), 1 none does, 2 the input is unusable.");
}

Forecast AdviseCommand::forecast() const {
  if (case_.empty())
    throw InputError(
        "CASE: there is none (allowed: a case file or a built-in name, see springproof list; of a block: [body] geo = "
        "\"beam.geo\", size_m, cells, a [material] and [[load]]s, see docs/advise.md)");
  const Experiment e = read_experiment(find_case(case_));
  require_one_material(e, "advise");
  if (e.relaxation.acts())
    throw InputError(e.relaxation_where,
                     "material.relaxation: advise is for materials that do not relax (allowed: none)");
  if (wish_.cells_across && e.body.is_voxels())
    throw InputError(
        "--cells-across: is for blocks (allowed: a case with size_m and cells; this body is cut out of a "
        "lattice, whose cells across its thin parts differ)");
  std::vector<Pilot> pilots;
  Status status(json_);
  for (const IsotropicMaterial& material : ends_of(e, poisson_ratios_)) {
    const Status::Working working(status, fmt::format("{}, nu = {:g}", e.name, material.poisson_ratio));
    pilots.push_back(solve_pilot(e, material, wish_.models.empty() ? usual_models : wish_.models,
                                 {pilot_cells_, 20 * pilot_cells_}));
  }
  return forecast_from(pilots);
}

int AdviseCommand::check() const {
  const std::vector<Judged> judged = judge_predictions(read_measurements(advise_folder() / "held_out.csv"), check_name_,
                                                       {pilot_cells_, 20 * pilot_cells_});
  if (judged.empty()) throw InputError(fmt::format("--check: no held-out case is called '{}'", check_name_));
  to_stdout("{:<24}{:>7} {:<12}{:>8}{:>10}{:>10}{:>8}\n", "case", "nu", "model", "cells", "error", "predicted",
            "ratio");
  for (const Judged& j : judged)
    to_stdout("{:<24}{:>7g} {:<12}{:>8.0f}{:>10.3g}{:>10.3g}{:>8.2f}  {}{}\n", j.truth.case_name, j.truth.poisson_ratio,
              j.truth.model, j.truth.cells, j.truth.error, j.predicted.error, j.predicted.error / j.truth.error,
              hit(j.truth, j.predicted) ? "" : "MISS ", j.predicted.beyond ? "extrapolated" : "");
  const HitRate r = hit_rate(judged);
  const auto share = [](int part, int all) {
    return fmt::format("{} of {} ({:.1f} %)", part, all, 100.0 * part / std::max(1, all));
  };
  to_stdout("within a factor of 1.5: {}; of those extrapolated {}\n", share(r.hits, r.all),
            share(r.beyond_hits, r.beyond));
  to_stdout("within the stated range: {}\n", share(r.inside, r.all));
  return 10 * r.hits >= 9 * r.all ? 0 : 1;
}

int AdviseCommand::run() const {
  if (!measure_held_out_.empty()) return measure_held_out(measure_held_out_);
  if (check_) return check();
  check_models(wish_.models);
  const Advice advice = advise(forecast(), wish_);
  to_stdout("{}", json_ ? json_of(advice).dump(2) + "\n" : text_of(advice));
  return !advice.choices.empty() && advice.choices.front().suits() ? 0 : 1;
}

}  // namespace

RunCommand advise_command(CLI::App& parser) { return made<AdviseCommand>(parser); }

}  // namespace springproof
