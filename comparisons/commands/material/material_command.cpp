#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "comparisons/commands/commands.h"
#include "comparisons/commands/material/material_options.h"
#include "comparisons/engines/engine_constants.h"
#include "comparisons/results/facts.h"
#include "msm/dynamics/time_step.h"
#include "msm/measure/moduli.h"
#include "msm/measure/statistics.h"
#include "msm/measure/validity.h"
#include "msm/measure/waves.h"
#include "msm/models.h"
#include "msm/parameters/model_table.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/case_file/experiment.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// Spring constants inside the lattice, by kind (1, 2, 3 axes apart): a cell's share times the cells that share it.
std::array<double, 3> lattice_constants(const MassSpringModel& model) {
  std::array<double, 3> k = {0, 0, 0};
  for (const Spring& s : model.network.cells.springs) {
    const int axes = static_cast<int>(std::lround(std::pow(s.rest_length / model.network.cells.edge, 2)));
    k[axes - 1] = s.stiffness * (axes == 1 ? 4 : axes == 2 ? 2 : 1);
  }
  return k;
}

/// A body for the row's safe time step: one cube where it bounds all meshes, else a block, or a sheet.
Mesh sample_mesh(const ModelRow& row, double l) {
  const int n = row.topology == Topology::cells && row.extension != Extension::momentum_dispersion ? 1 : 5;
  const int layers = row.topology == Topology::hexagonal ? 1 : n;
  return block_mesh(l * Vec3(n, n, layers), {n, n, layers});
}

/// What momentum dispersion and disorder add to the table.
struct DispersionFacts {
  double q = 0, spring_factor = 1;  ///< spring_factor: springs over those of eq. (20) of Kot et al. (2014)
  BlockStability stability;
  NetworkStatistics network;
};

DispersionFacts facts_of(const ModelParameters& p, const IsotropicMaterial& m, const MassSpringModel& model, double l) {
  DispersionFacts facts{0, 1, block_stability(p, m, l), statistics(model.network)};
  if (const MomentumDispersion* dispersion = dispersion_of(model)) facts.q = dispersion->q;
  facts.spring_factor = bulk_calibration(p, m).spring_shear_modulus / affine_calibration(p, m).spring_shear_modulus;
  return facts;
}

constexpr double wave_cells = 10;  // per wavelength

/// All values printed for a material in a model.
struct MaterialFacts {
  const IsotropicMaterial& m;
  const ModelParameters& p;
  double l;          ///< edge of the cells [m]
  double frequency;  ///< that engines damp [Hz]
  MassSpringModel model = build_model(p, sample_mesh(p.row, l), m);
  bool lattice = p.row.topology == Topology::cells;
  std::array<double, 3> k = lattice_constants(model);
  double time_step = safe_time_step(model, m.density);
  MeasuredModuli measured = measure_moduli(p, m);
  bool has_limits = lattice && !p.has(Extension::momentum_dispersion);
  StrainLimits limits =
      has_limits ? strain_limits(p, m)
                 : StrainLimits{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::vector<StressAtStretch> stresses = has_limits ? stress_curve(p, m) : std::vector<StressAtStretch>{};
  DispersionFacts dispersion = facts_of(p, m, model, l);
  double correction = p.has(Extension::volume_correction) || p.has(Extension::averaging) ? kappa(m) : 0.0;

  double corner_mass() const { return m.density * l * l * l / 8; }
  EngineFacts for_engines() const {
    const bool springs = lattice && !model.network.springs.empty();
    return {m, l, springs ? k : std::array<double, 3>{0, 0, 0}, springs ? correction : 0, frequency};
  }
};

FactGroup material_facts(const IsotropicMaterial& m) {
  return {"material",
          {{"E", "Pa", {{"/material/youngs_modulus_Pa", m.youngs_modulus}}},
           {"nu", "", {{"/material/poisson_ratio", m.poisson_ratio}}},
           {"G", "Pa", {{"/material/shear_modulus_Pa", shear_modulus(m)}}},
           {"K", "Pa", {{"/material/bulk_modulus_Pa", bulk_modulus(m)}}},
           {"lambda", "Pa", {{"/material/lame_lambda_Pa", lame_lambda(m)}}},
           {"density", "kg/m^3", {{"/material/density_kg_m3", m.density}}}}};
}

FactGroup model_facts(const MaterialFacts& f) {
  const ModelParameters& p = f.p;
  const bool chosen = (f.lattice || p.row.topology == Topology::centres) && !p.has(Extension::averaging);
  const FactValue A = std::isinf(p.face_to_cube) ? FactValue("infinity") : FactValue(p.face_to_cube);
  return {fmt::format("model {}: {}", p.row.name, p.row.what),
          {{"", "", {{"/model/name", p.row.name}}},
           {chosen ? "A = k_f / k_c" : "", "", {{"/model/face_to_cube", A}}},
           {"cell edge l", "m", {{"/model/cell_size_m", f.l}}},
           {f.lattice ? "mass per cell corner" : "", "kg", {{"/corner_mass_kg", f.corner_mass()}}},
           {"safe time step",
            "s",
            {{"/safe_time_step_s", f.time_step}},
            f.has_limits ? "explicit, undamped, any mesh of these cells"
                         : "explicit, undamped, a block of 5 cells; safe_time_step() knows each network's"},
           {!f.lattice                    ? ""
            : p.has(Extension::averaging) ? "volume term"
                                          : "volume correction",
            "Pa",
            {{"/kappa_Pa", f.correction}},
            p.has(Extension::averaging)           ? "K, the whole bulk modulus, less that of the springs"
            : p.has(Extension::volume_correction) ? "kappa = lambda - G"
                                                  : "this model has none"}}};
}

FactGroup spring_facts(const MaterialFacts& f) {
  const auto length = [&](double axes) { return fmt::format("rest length {:.6g} m", f.l * std::sqrt(axes)); };
  return {"springs inside the lattice (a free edge has 1/4, a surface edge or face diagonal 1/2 of it)",
          {{"k_e  cell edge", "N/m", {{"/springs/k_e_N_m", f.k[0]}}, length(1)},
           {"k_f  face diagonal", "N/m", {{"/springs/k_f_N_m", f.k[1]}}, length(2)},
           {"k_c  cube diagonal", "N/m", {{"/springs/k_c_N_m", f.k[2]}}, length(3)}}};
}

FactGroup network_facts(const NetworkStatistics& network, double spring_factor) {
  return {"network, of a block of 5 x 5 x 5",
          {{"mean number of springs <S>", "", {{"/network/springs_per_node", network.springs_per_node}}},
           {"mean length <L>", "m", {{"/network/mean_length_m", network.mean_length}}},
           {"springs over those of eq. (20)", "", {{"/network/springs_over_eq_20", spring_factor}}}}};
}

FactGroup dispersion_facts(const MaterialFacts& f) {
  const bool conservative = has_energy(f.p.dispersion);
  const std::string weights = !conservative ? "counts" : exact_volumes(f.p, f.m) ? "volume" : "kL";
  return {"momentum dispersion",
          {{"q", "", {{"/dispersion/q", f.dispersion.q}}},
           {"form", "", {{"/dispersion/form", std::string(name_of(f.p.dispersion))}}},
           {"weights", "", {{"/dispersion/weights", weights}}},
           {"conservative", "", {{"/dispersion/conservative", conservative}}, "its stiffness is symmetric"}}};
}

FactGroup stability_facts(const MaterialFacts& f) {
  const BlockStability& s = f.dispersion.stability;
  return {"stability, measured on a small free block",
          {{"stable", "", {{"/stable_range", stable_range(f.p, f.m)}}},
           {"|K - K^T| / |K|", "", {{"/asymmetry", s.asymmetry}}},
           {"smallest eigenvalue over the largest", "", {{"/smallest_eigenvalue", s.smallest_eigenvalue}}},
           {"flutters below a damping of",
            "1/s",
            {{"/flutter_damping_1_s", if_finite(s.flutter_damping)}},
            s.flutter_damping > 0 ? "" : "no flutter"}}};
}

FactGroup limit_facts(const MaterialFacts& f) {
  const bool corrected = f.p.has(Extension::volume_correction);
  const auto note = [](double strain) { return std::isfinite(strain) ? "" : "up to 50 %"; };
  const auto [bounded, paper] = f.limits;
  return {"tension limit of a free-sided cell",
          {{!f.has_limits ? ""
            : corrected   ? "bounded volume energy"
                          : "strain",
            "%",
            {{"/tension_limit_strain/bounded", if_finite(bounded)}},
            note(bounded)},
           {corrected ? "the paper's" : "", "%", {{"/tension_limit_strain/paper", if_finite(paper)}}, note(paper)}}};
}

FactGroup stress_facts(const MaterialFacts& f) {
  FactGroup group{
      fmt::format("stress of a bar with free sides, force over area at rest: {}, Hencky, neo-Hooke", f.p.row.name)};
  const auto if_there = [](const std::optional<double>& stress) { return stress ? FactValue(*stress) : FactValue(); };
  for (std::size_t i = 0; i < f.stresses.size(); ++i) {
    const StressAtStretch& s = f.stresses[i];
    const std::string place = fmt::format("/stress_of_free_bar/{}/", i);
    group.rows.push_back({"", "", {{place + "stretch", s.stretch}}});
    group.rows.push_back({fmt::format("stretch {:.2f}", s.stretch),
                          "Pa",
                          {{place + "model_Pa", if_there(s.model)},
                           {place + "hencky_Pa", s.hencky},
                           {place + "neo_hooke_Pa", if_there(s.neo_hooke)}}});
  }
  return group;
}

FactValue direction(const Vec3& k) { return std::vector<double>{k[0], k[1], k[2]}; }

constexpr double asked_strain = 0.5;  // up to which the lattice without end is asked

FactGroup stable_strain_facts(const ModelParameters& p, const IsotropicMaterial& m) {
  FactGroup group{"the lattice without end, strained along an axis, is stable (no wave grows) up to",
                  {{"", "", {{"/stable_strains/asked", asked_strain}}}}};
  for (const auto& [sides, name] : {std::pair(Sides::free, "free"), {Sides::held, "held"}})
    for (const auto& [sign, way] : {std::pair(-1.0, "compression"), {1.0, "tension"}}) {
      const std::string place = fmt::format("/stable_strains/{}/{}", name, way),
                        label = fmt::format("sides {}, {}", name, way);
      if (const auto limit = strain_limit(p, m, sides, sign * asked_strain)) {
        group.rows.push_back({label, "%", {{place + "/strain", limit->strain}}, "beyond, " + describe_wave(limit->k)});
        group.rows.push_back({"", "", {{place + "/k_l_over_pi", direction(limit->k)}}});
      } else {
        group.rows.push_back({label, "%", {{place, {}}}, fmt::format("up to {:g} %", 100 * asked_strain)});
      }
    }
  return group;
}

FactGroup wave_facts(const MaterialFacts& f) {
  FactGroup group{
      fmt::format("waves of {:g} cells, error of the velocity of crests (phase) and of pulses (group) in the worst "
                  "direction",
                  wave_cells),
      {{"", "", {{"/waves/cells_per_wavelength", wave_cells}}}}};
  struct Masses {
    double consistent;
    const char* words;
    const char* suffix;
  };
  for (const auto& [consistent, words, suffix] :
       {Masses{0, "corner masses", ""}, {0.5, "half of the mass consistent", "_half_consistent"}}) {
    const WaveErrors e = wave_errors(f.model, shear_modulus(f.m), lame_lambda(f.m), wave_cells, consistent);
    const auto row = [&, suffix = suffix, words = words](const char* kind, double phase, double velocity) {
      group.rows.push_back({fmt::format("{}, {}", kind, words),
                            "%",
                            {{fmt::format("/waves/phase_error{}/{}", suffix, kind), phase},
                             {fmt::format("/waves/group_error{}/{}", suffix, kind), velocity}}});
    };
    row("longitudinal", e.phase.longitudinal, e.group.longitudinal);
    row("transverse", e.phase.transverse, e.group.transverse);
  }
  const SoftestWave softest = softest_wave(f.model, shear_modulus(f.m));
  group.rows.push_back({"softest wave of less than four cells",
                        "G l",
                        {{"/waves/softest_short_wave/stiffness_over_Gl", softest.stiffness}},
                        softest.stiffness < 1e-9 ? "it costs no energy" : ""});
  group.rows.push_back({"its k l", "pi", {{"/waves/softest_short_wave/k_l_over_pi", direction(softest.k)}}});
  return group;
}

FactGroup measured_facts(const MaterialFacts& f) {
  const auto relative = [](double measured, double wanted) {
    return fmt::format("{:+.2e} relative", measured / wanted - 1);
  };
  const double E = f.measured.youngs_modulus, nu = f.measured.poisson_ratio, G = f.measured.shear_modulus;
  return {
      fmt::format("measured back from {}", f.lattice                                 ? "a block of 4 x 4 x 4 cells"
                                           : f.p.row.topology == Topology::hexagonal ? "a sheet of 4 rows"
                                                                                     : "an infinite periodic network"),
      {{"E", "Pa", {{"/measured/youngs_modulus_Pa", E}}, relative(E, f.m.youngs_modulus)},
       {"nu", "", {{"/measured/poisson_ratio", nu}}, fmt::format("{:+.2e}", nu - f.m.poisson_ratio)},
       {"G", "Pa", {{"/measured/shear_modulus_Pa", G}}, relative(G, shear_modulus(f.m))}}};
}

/// Titles alone: in text.
std::vector<FactGroup> warnings(const ModelParameters& p, const IsotropicMaterial& m) {
  std::vector<FactGroup> all;
  if (p.has(Extension::none) && !same_poisson_ratio(m.poisson_ratio, 0.25))
    all.push_back({fmt::format(
        "warning: springs alone have nu = 1/4 (Cauchy relation); use hybmss or emsm for nu = {:g}", m.poisson_ratio)});
  if (p.row.topology == Topology::cells && !p.has(Extension::averaging) && p.face_to_cube < 0.2)
    all.push_back(
        {"warning: without face diagonals (A < 0.2) the lattice has (nearly) zero-energy modes and wrinkles"});
  if (p.paper_e_form) all.push_back({"warning: paper_e_form is right for nu = 1/4 only"});
  return all;
}

std::vector<FactGroup> facts_of(const MaterialFacts& f) {
  std::vector<FactGroup> all = {material_facts(f.m), model_facts(f)};
  if (f.lattice && !f.model.network.springs.empty()) all.push_back(spring_facts(f));
  if (f.p.row.topology == Topology::random)
    all.push_back(network_facts(f.dispersion.network, f.dispersion.spring_factor));
  if (f.p.has(Extension::momentum_dispersion)) all.push_back(dispersion_facts(f));
  all.push_back(stability_facts(f));
  all.push_back(limit_facts(f));
  if (f.has_limits) {
    all.push_back(stress_facts(f));
    all.push_back(stable_strain_facts(f.p, f.m));
    all.push_back(wave_facts(f));
  }
  all.push_back(measured_facts(f));
  all.push_back(facts_of(f.for_engines()));
  for (FactGroup& warning : warnings(f.p, f.m)) all.push_back(std::move(warning));
  return all;
}

class MaterialCommand {
 public:
  void add_options(CLI::App& command);

  /// Prints the table (or JSON).  @return 0.
  /// @throws InputError if the moduli or the model cannot be used.
  int run() const;

 private:
  Moduli moduli_;
  double density_ = 1000;
  double cell_size_ = 0.1, frequency_ = 1;
  ModelChoice choice_{recommended_model().name, {}, recommended_model().name, {}};
  bool json_ = false;
};

void MaterialCommand::add_options(CLI::App& command) {
  add_moduli(command, moduli_);
  command.add_option("--density", density_, "density [kg/m^3]")->capture_default_str();
  command.add_option("--cell-size", cell_size_, "edge of the cubic cells [m]")
      ->check(positive())
      ->capture_default_str();
  add_model(command, choice_);
  command.add_option("--frequency", frequency_, "a vibration [Hz] whose damping by implicit Euler is printed")
      ->check(positive())
      ->capture_default_str();
  command.add_flag("--json", json_, "print JSON");
}

int MaterialCommand::run() const {
  const IsotropicMaterial m = material_of(moduli_, density_);
  const ModelParameters p = resolve(choice_);
  const std::vector<FactGroup> facts = facts_of(MaterialFacts{m, p, cell_size_, frequency_});
  to_stdout("{}", json_ ? json_of(facts).dump(2) + "\n" : text_of(facts));
  return 0;
}

}  // namespace

RunCommand material_command(CLI::App& parser) { return made<MaterialCommand>(parser); }

}  // namespace springproof
