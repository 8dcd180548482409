#include "comparisons/advise/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr double most_unknowns = 30000;  // of models and elements

/// The rows of a case at one of its materials.
void add_rows(Experiment e, const IsotropicMaterial& material, std::vector<Measurement>& out) {
  const std::string name = case_name(e.file);
  e.materials = {material};
  const Part part = run_part(prepare(e), 0, {});
  for (const Row& row : part.rows)
    if (row.measure == "displacement_error" && row.reference_uncertainty && !row.model.ends_with(extrapolated_suffix))
      out.push_back({name, row.poisson_ratio, row.model.substr(0, row.model.find(" seeds=")), cell_count(row.cells),
                     row.value, *row.reference_uncertainty});
}

constexpr const char* header =
    R"(# Displacement errors in cases that were not used to make the predictions, by which these are judged (springproof advise --check).
# Made by:  springproof advise --measure-held-out FILE
# error, uncertainty: as parts of the displacement.
)";

constexpr const char* heading = "case,nu,model,cells,error,uncertainty";

Measurement measurement_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  if (fields.size() != 6) throw std::invalid_argument(fmt::format("has {} fields", fields.size()));
  const auto number = [&](std::size_t i) {
    std::size_t read = 0;
    const double x = std::stod(fields[i], &read);
    if (read != fields[i].size()) throw std::invalid_argument(fields[i] + " is no number");
    return x;
  };
  return {fields[0], number(1), fields[2], number(3), number(4), number(5)};
}

constexpr double allowed_factor = 1.5;

bool both_below(const Measurement& truth, const Prediction& p) {
  return truth.error <= truth.uncertainty && p.error <= truth.uncertainty;
}

bool within(double truth, double predicted, double factor) {
  return truth > 0 && predicted > 0 && std::abs(std::log(predicted / truth)) <= std::log(factor);
}

}  // namespace

int measure_held_out(const fs::path& file) {
  std::vector<Measurement> out;
  if (fs::exists(file)) out = read_measurements(file);
  end_at_interrupts();
  Status status;
  for (const Experiment& e : held_out_cases())
    for (const IsotropicMaterial& material : e.materials) {
      const std::string name = case_name(e.file), title = fmt::format("{}, nu = {:g}", name, material.poisson_ratio);
      if (std::ranges::any_of(out, [&](const Measurement& m) {
            return m.case_name == name && same_poisson_ratio(m.poisson_ratio, material.poisson_ratio);
          }))
        continue;
      const std::size_t before = out.size();
      {
        const Status::Working working(status, title);
        add_rows(e, material, out);
      }
      if (children_interrupted()) return interrupted_status;
      write_measurements(file, out);
      status.print(fmt::format("{}: {} errors", title, out.size() - before));
    }
  return 0;
}

std::vector<Experiment> held_out_cases() {
  struct Chosen {
    std::string name;
    std::vector<double> poisson_ratios;
  };
  const std::vector<Chosen> chosen = {{"golec_2019/compression", {-0.5, 0.25, 0.499}},
                                      {"golec_2019/tension", {-0.5, 0.45}},
                                      {"golec_2019/shear", {0.25, 0.45}},
                                      {"golec_2019/torsion", {0.45}},
                                      {"golec_2019/bending", {-0.5, 0.25, 0.499}},
                                      {"kot_2014/fig_13", {}},
                                      {"bodies/l_bracket", {0.3}},
                                      {"bodies/rabbit", {0.25}},
                                      {"bodies/hand_pressed", {0.3}}};
  std::vector<Experiment> cases;
  const auto keep = [](Experiment e, const std::vector<double>& ratios) {
    std::erase_if(e.materials, [&](const IsotropicMaterial& m) {
      return !ratios.empty() &&
             std::ranges::none_of(ratios, [&](double nu) { return same_poisson_ratio(nu, m.poisson_ratio); });
    });
    // Only models that advice knows, without options.
    std::erase_if(e.models, [](const ModelChoice& m) { return std::ranges::count(usual_models, m.label) == 0; });
    e.measures = {"displacement_error"};
    e.elements = {"q1", "q2"};  // of bodies of voxels none: they would be on the staircase
    if (e.body.is_voxels()) e.elements.clear();
    e.max_unknowns = most_unknowns;
    e.probes.clear();
    e.section.reset();
    e.expectations.clear();
    e.published.clear();
    return e;
  };
  for (const fs::path& file : find_cases({(advise_folder() / "held_out").string()}))
    cases.push_back(keep(read_experiment(file), {}));
  for (const Chosen& c : chosen) cases.push_back(keep(read_experiment(find_case(c.name)), c.poisson_ratios));
  return cases;
}

std::vector<Measurement> parse_measurements(const std::string& text, const std::filesystem::path& file) {
  std::vector<Measurement> out;
  std::istringstream in(text);
  int number = 0;
  bool has_heading = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with('#')) continue;
    if (!has_heading) {
      if (line != heading)
        throw InputError({file.string(), number, 1}, fmt::format("the heading is '{}' (allowed: '{}')", line, heading));
      has_heading = true;
    } else if (!line.empty()) {
      try {
        out.push_back(measurement_of(line));
      } catch (const std::exception& e) {
        throw InputError({file.string(), number, 1},
                         fmt::format("'{}': {} (allowed: text or numbers under '{}')", line, e.what(), heading));
      }
    }
  }
  if (!has_heading)
    throw InputError(fmt::format(
        "{}: holds no measurements (allowed: a file written by springproof advise --measure-held-out)", file.string()));
  return out;
}

std::vector<Measurement> read_measurements(const std::filesystem::path& file) {
  return parse_measurements(read_named_file(file, "a table that springproof advise --measure wrote"), file);
}

void write_measurements(const std::filesystem::path& file, const std::vector<Measurement>& measured) {
  std::string text = fmt::format("{}{}\n", header, heading);
  for (const Measurement& m : measured)
    text += fmt::format("{},{:g},{},{:.0f},{:.4e},{:.2e}\n", m.case_name, m.poisson_ratio, m.model, m.cells, m.error,
                        m.uncertainty);
  write_named_file(file, text);
}

std::filesystem::path advise_folder() { return data_folder("advise", SPRINGPROOF_ADVISE_DIR); }

bool hit(const Measurement& truth, const Prediction& p) {
  return both_below(truth, p) || within(truth.error, p.error, allowed_factor);
}

bool inside(const Measurement& truth, const Prediction& p) {
  return both_below(truth, p) || within(truth.error, p.error, p.factor);
}

HitRate hit_rate(const std::vector<Judged>& judged) {
  HitRate out;
  for (const Judged& j : judged) {
    const bool good = hit(j.truth, j.predicted);
    ++out.all;
    out.hits += good;
    out.inside += inside(j.truth, j.predicted);
    out.beyond += j.predicted.beyond;
    out.beyond_hits += j.predicted.beyond && good;
  }
  return out;
}

std::vector<Judged> judge_predictions(const std::vector<Measurement>& held_out, const std::string& name,
                                      const PilotSize& size) {
  std::vector<Judged> out;
  for (const Experiment& e : held_out_cases()) {
    if (case_name(e.file).find(name) == std::string::npos) continue;
    for (const IsotropicMaterial& material : e.materials) {
      std::vector<Measurement> rows;
      std::vector<std::string> models;  // rows of the model table that these are of
      for (const Measurement& m : held_out) {
        if (m.case_name != case_name(e.file) || !same_poisson_ratio(m.poisson_ratio, material.poisson_ratio)) continue;
        rows.push_back(m);
        const std::string row = m.model.substr(0, m.model.find(' '));
        if (!row.starts_with("fem_") && std::ranges::find(models, row) == models.end()) models.push_back(row);
      }
      if (rows.empty()) continue;
      const Pilot pilot = solve_pilot(e, material, models, size);
      for (const Measurement& m : rows) {
        const bool whole = e.body.is_voxels() && !e.body.cut;
        const PilotModel* model = whole ? pilot.find(m.model + " cut=false") : nullptr;
        if (!model) model = pilot.find(m.model);
        if (model) out.push_back({m, predict(pilot, *model, m.cells)});
      }
    }
  }
  return out;
}

}  // namespace springproof
