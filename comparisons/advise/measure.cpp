#include "comparisons/advise/measure.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "comparisons/sweep/status.h"
#include "fem_reference/exchange/reference.h"
#include "problem/processes/child.h"
#include "problem/processes/interrupts.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr double most_unknowns = 30000;  // of models and elements

/// The rows of a case at one of its materials.
void add_rows(Experiment e, const IsotropicMaterial& material, MeasuredFile& out) {
  const std::string name = case_name(e.file);
  e.materials = {material};
  const Part part = run_part(prepare(e), 0, {});
  for (const Row& row : part.rows)
    if (row.measure == "displacement_error" && row.reference_uncertainty && !row.model.ends_with(extrapolated_suffix))
      out.rows.push_back({name, row.poisson_ratio, row.model.substr(0, row.model.find(" seeds=")),
                          cell_count(row.cells), row.value, *row.reference_uncertainty});
}

constexpr const char* header =
    R"( Displacement errors in cases that were not used to make the predictions, by which these are judged (springproof advise --check).
 Made by:  springproof advise --measure-held-out FILE
 error, uncertainty: as parts of the displacement.
)";

}  // namespace

int measure_held_out(const fs::path& file) {
  MeasuredFile out;
  if (fs::exists(file)) out = read_measurements(file);
  out.header = header;
  end_at_interrupts();
  Status status;
  for (const Experiment& e : held_out_cases())
    for (const IsotropicMaterial& material : e.materials) {
      const std::string name = case_name(e.file), title = fmt::format("{}, nu = {:g}", name, material.poisson_ratio);
      if (std::any_of(out.rows.begin(), out.rows.end(), [&](const Measurement& m) {
            return m.case_name == name && same_poisson_ratio(m.poisson_ratio, material.poisson_ratio);
          }))
        continue;
      const std::size_t before = out.rows.size();
      {
        const Status::Working working(status, title);
        add_rows(e, material, out);
      }
      if (children_interrupted()) return interrupted_status;
      write_measurements(file, out);
      status.print(fmt::format("{}: {} errors", title, out.rows.size() - before));
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
      return !ratios.empty() && std::none_of(ratios.begin(), ratios.end(),
                                             [&](double nu) { return same_poisson_ratio(nu, m.poisson_ratio); });
    });
    // Only models that advice knows, without options.
    static const std::vector<std::string> known = {"hybmss_avg", "hybmss_bt", "hybmss", "emsm", "msm_18", "emsm_patch"};
    std::erase_if(e.models,
                  [&](const ModelChoice& m) { return std::find(known.begin(), known.end(), m.label) == known.end(); });
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
  for (const Chosen& c : chosen) cases.push_back(keep(read_experiment(find_cases({c.name}).front()), c.poisson_ratios));
  return cases;
}

}  // namespace springproof
