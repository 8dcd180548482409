#include "comparisons/commands/material_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "comparisons/commands/number_checks.h"
#include "comparisons/engines/engine_facts.h"
#include "msm/dynamics/time_step.h"
#include "msm/measure/moduli.h"
#include "msm/measure/stability.h"
#include "msm/measure/statistics.h"
#include "msm/measure/validity.h"
#include "msm/measure/waves.h"
#include "msm/models.h"
#include "msm/parameters/calibrate.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// Spring constants inside the lattice, by kind (1, 2, 3 axes apart): a cell's share times the cells that share it.
std::array<double, 3> lattice_constants(const MassSpringModel& model) {
  std::array<double, 3> k = {0, 0, 0};
  for (const Spring& s : model.network.cell_springs) {
    const int axes = static_cast<int>(std::lround(std::pow(s.rest_length / model.network.cell_edge, 2)));
    k[axes - 1] = s.stiffness * (axes == 1 ? 4 : axes == 2 ? 2 : 1);
  }
  return k;
}

const char* name_of(Dispersion form) {
  switch (form) {
    case Dispersion::symmetric:
      return "symmetric";
    case Dispersion::share_weighted:
      return "share_weighted";
    case Dispersion::published:
      return "published";
    case Dispersion::published_transposed:
      return "published_transposed";
    case Dispersion::finite_strain:
      return "finite_strain";
  }
  return "";
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

nlohmann::json json_of(const DispersionFacts& f, const ModelParameters& p, const IsotropicMaterial& m) {
  nlohmann::json out = {
      {"stable_range", stable_range(p, m)},
      {"asymmetry", f.stability.asymmetry},
      {"smallest_eigenvalue", f.stability.smallest_eigenvalue},
      {"flutter_damping_1_s", std::isfinite(f.stability.flutter_damping) ? nlohmann::json(f.stability.flutter_damping)
                                                                         : nlohmann::json(nullptr)}};
  if (p.has(Extension::momentum_dispersion))
    out["dispersion"] = {{"q", f.q},
                         {"form", name_of(p.dispersion)},
                         {"conservative", has_energy(p.dispersion)},
                         {"weights", !has_energy(p.dispersion) ? "counts"
                                     : exact_volumes(p, m)     ? "volume"
                                                               : "kL"}};
  if (p.row.topology == Topology::random)
    out["network"] = {{"springs_per_node", f.network.springs_per_node},
                      {"mean_length_m", f.network.mean_length},
                      {"springs_over_eq_20", f.spring_factor}};
  return out;
}

void print(const DispersionFacts& f, const ModelParameters& p, const IsotropicMaterial& m) {
  if (p.row.topology == Topology::random)
    to_stdout(
        "network    <S> = {:.3g}   <L> = {:.4g} m (of a block of 5 x 5 x 5)   springs = {:.4g} times those of eq. "
        "(20)\n",
        f.network.springs_per_node, f.network.mean_length, f.spring_factor);
  if (p.has(Extension::momentum_dispersion))
    to_stdout(
        "dispersion q = {:.6g}   form {}{}   {}\n", f.q, name_of(p.dispersion),
        !has_energy(p.dispersion) ? ""
        : exact_volumes(p, m)     ? ", weights volume"
                                  : ", weights kL",
        has_energy(p.dispersion) ? "conservative, symmetric stiffness" : "not conservative, stiffness not symmetric");
  to_stdout("stable     {}\n", stable_range(p, m));
  to_stdout(
      "           measured on a small free block: |K - K^T| / |K| = {:.2g}, smallest eigenvalue {:.2g} of the largest, "
      "{}\n\n",
      f.stability.asymmetry, f.stability.smallest_eigenvalue,
      f.stability.flutter_damping > 0
          ? fmt::format("flutters below a damping of {:.3g} 1/s", f.stability.flutter_damping)
          : "no flutter");
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

/// What stable_strains_json() and print_stable_strains() tell of: sides, and strains up to which the lattice is asked.
constexpr std::array<std::pair<Sides, const char*>, 2> kinds_of_sides = {
    {{Sides::free, "free"}, {Sides::held, "held"}}};
constexpr double asked_strain = 0.5;

nlohmann::json stable_strains_json(const ModelParameters& p, const IsotropicMaterial& m) {
  nlohmann::json out = {{"asked", asked_strain}};
  for (const auto& [sides, name] : kinds_of_sides)
    for (const double sign : {-1.0, 1.0}) {
      nlohmann::json& entry = out[name][sign < 0 ? "compression" : "tension"];
      if (const auto limit = strain_limit(p, m, sides, sign * asked_strain))
        entry = {{"strain", limit->strain}, {"k_l_over_pi", {limit->k[0], limit->k[1], limit->k[2]}}};
    }
  return out;
}

void print_stable_strains(const ModelParameters& p, const IsotropicMaterial& m) {
  to_stdout("\nthe lattice without end, strained along an axis, is stable (no wave grows)\n");
  for (const auto& [sides, name] : kinds_of_sides)
    for (const double sign : {-1.0, 1.0}) {
      const auto limit = strain_limit(p, m, sides, sign * asked_strain);
      to_stdout("  sides {}, {:<11} {}\n", name, sign < 0 ? "compression" : "tension",
                limit
                    ? fmt::format("up to {:.1f} %; beyond, {}", 100 * std::abs(limit->strain), describe_wave(limit->k))
                    : fmt::format("up to {:g} % and more", 100 * asked_strain));
    }
}

nlohmann::json moduli_json(double E, double nu, double G) {
  return {{"youngs_modulus_Pa", E}, {"poisson_ratio", nu}, {"shear_modulus_Pa", G}};
}

WaveErrors wave_errors_of(const MaterialFacts& f, double consistent) {
  return wave_errors(f.model, shear_modulus(f.m), lame_lambda(f.m), wave_cells, consistent);
}

nlohmann::json waves_json(const MaterialFacts& f) {
  const auto json = [](const VelocityError& e) {
    return nlohmann::json{{"longitudinal", e.longitudinal}, {"transverse", e.transverse}};
  };
  const WaveErrors lumped = wave_errors_of(f, 0), half = wave_errors_of(f, 0.5);
  const SoftestWave softest = softest_wave(f.model, shear_modulus(f.m));
  return {{"cells_per_wavelength", wave_cells},
          {"phase_error", json(lumped.phase)},
          {"group_error", json(lumped.group)},
          {"phase_error_half_consistent", json(half.phase)},
          {"group_error_half_consistent", json(half.group)},
          {"softest_short_wave",
           {{"stiffness_over_Gl", softest.stiffness}, {"k_l_over_pi", {softest.k[0], softest.k[1], softest.k[2]}}}}};
}

nlohmann::json json_of(const MaterialFacts& f) {
  const auto limit = [](double strain) {
    return std::isfinite(strain) ? nlohmann::json(strain) : nlohmann::json(nullptr);
  };
  const ModelParameters& p = f.p;
  nlohmann::json material = moduli_json(f.m.youngs_modulus, f.m.poisson_ratio, shear_modulus(f.m));
  material.update(
      {{"bulk_modulus_Pa", bulk_modulus(f.m)}, {"lame_lambda_Pa", lame_lambda(f.m)}, {"density_kg_m3", f.m.density}});
  nlohmann::json out = {
      {"material", material},
      {"model",
       {{"name", p.row.name},
        {"face_to_cube", std::isinf(p.face_to_cube) ? nlohmann::json("infinity") : nlohmann::json(p.face_to_cube)},
        {"cell_size_m", f.l}}},
      {"springs", {{"k_e_N_m", f.k[0]}, {"k_f_N_m", f.k[1]}, {"k_c_N_m", f.k[2]}}},
      {"kappa_Pa", f.correction},
      {"corner_mass_kg", f.corner_mass()},
      {"safe_time_step_s", f.time_step},
      {"tension_limit_strain", {{"bounded", limit(f.limits.bounded_energy)}, {"paper", limit(f.limits.paper_energy)}}},
      {"measured", moduli_json(f.measured.youngs_modulus, f.measured.poisson_ratio, f.measured.shear_modulus)}};
  const auto or_null = [](const std::optional<double>& stress) {
    return stress ? nlohmann::json(*stress) : nlohmann::json(nullptr);
  };
  for (const StressAtStretch& s : f.stresses)
    out["stress_of_free_bar"].push_back({{"stretch", s.stretch},
                                         {"model_Pa", or_null(s.model)},
                                         {"hencky_Pa", s.hencky},
                                         {"neo_hooke_Pa", or_null(s.neo_hooke)}});
  if (f.has_limits) {
    out["waves"] = waves_json(f);
    out["stable_strains"] = stable_strains_json(p, f.m);
  }
  if (f.model.network.springs.empty() || !f.lattice) out.erase("springs");
  out["engines"] = json_of(f.for_engines());
  out.update(json_of(f.dispersion, p, f.m));
  return out;
}

void print_model(const MaterialFacts& f) {
  const IsotropicMaterial& m = f.m;
  to_stdout(
      "material   E = {:.6g} Pa   nu = {:.6g}   G = {:.6g} Pa   K = {:.6g} Pa   lambda = {:.6g} Pa   rho = {:.6g} "
      "kg/m^3\n",
      m.youngs_modulus, m.poisson_ratio, shear_modulus(m), bulk_modulus(m), lame_lambda(m), m.density);
  const bool has_face_to_cube = f.lattice || f.p.row.topology == Topology::centres;
  to_stdout("model      {}: {}{}   cell edge l = {:.6g} m\n\n", f.p.row.name, f.p.row.what,
            has_face_to_cube && !f.p.has(Extension::averaging) ? fmt::format("   A = {:g}", f.p.face_to_cube) : "",
            f.l);
}

void print_springs(const MaterialFacts& f) {
  to_stdout("springs inside the lattice (a free edge has 1/4, a surface edge or face diagonal 1/2 of it)\n");
  const char* names[] = {"k_e  cell edge    ", "k_f  face diagonal", "k_c  cube diagonal"};
  for (int i = 0; i < 3; ++i)
    to_stdout("  {}   {:>14.6g} N/m   rest length {:.6g} m\n", names[i], f.k[i], f.l * std::sqrt(i + 1.0));
}

void print_limits(const MaterialFacts& f) {
  if (f.lattice) {
    if (f.p.has(Extension::averaging))
      to_stdout("volume term            {:>14.6g} Pa    (K, the whole bulk modulus)\n", bulk_modulus(f.m));
    else
      to_stdout("volume correction\n  kappa = lambda - G   {:>14.6g} Pa{}\n", f.correction,
                f.p.has(Extension::volume_correction) ? "" : "    (this model has none)");
    to_stdout("mass per cell corner   {:>14.6g} kg\n", f.corner_mass());
  }
  to_stdout("safe time step         {:>14.6g} s     (explicit, undamped, {})\n", f.time_step,
            f.has_limits ? "any mesh of these cells" : "a block of 5 cells; safe_time_step() knows each network's");
  const auto strain = [](double limit) {
    return std::isfinite(limit) ? fmt::format("{:.1f} %", 100 * limit) : std::string("none up to 50 %");
  };
  if (f.p.has(Extension::volume_correction))
    to_stdout("tension limit of a free-sided cell: {} (bounded volume energy), {} (the paper's)\n",
              strain(f.limits.bounded_energy), strain(f.limits.paper_energy));
  else if (f.has_limits)
    to_stdout("tension limit of a free-sided cell: {}\n", strain(f.limits.bounded_energy));
}

void print_waves(const MaterialFacts& f) {
  const SoftestWave softest = softest_wave(f.model, shear_modulus(f.m));
  to_stdout("\nwaves of {:g} cells, velocity of crests (phase) and of pulses (group) in the worst direction\n",
            wave_cells);
  for (const auto& [consistent, masses] : {std::pair(0.0, "corner masses"), {0.5, "half of the mass consistent"}}) {
    const auto [phase, group] = wave_errors_of(f, consistent);
    to_stdout("  longitudinal {:+.2f} %, group {:+.2f} %; transverse {:+.2f} %, group {:+.2f} %   ({})\n",
              100 * phase.longitudinal, 100 * group.longitudinal, 100 * phase.transverse, 100 * group.transverse,
              masses);
  }
  to_stdout("softest wave of less than four cells: {:.2g} G l at k l = ({:.2g}, {:.2g}, {:.2g}) pi{}\n",
            std::max(0.0, softest.stiffness), softest.k[0], softest.k[1], softest.k[2],
            softest.stiffness < 1e-9 ? ", which costs no energy" : "");
}

void print_stresses(const MaterialFacts& f) {
  if (f.stresses.empty()) return;
  to_stdout("\nstress of a bar with free sides, force over area at rest [Pa]\n");
  to_stdout("  stretch {:>14} {:>14} {:>14}\n", f.p.row.name, "Hencky", "neo-Hooke");
  const auto text = [](const std::optional<double>& stress) {
    return stress ? fmt::format("{:.5g}", *stress) : "none found";
  };
  for (const StressAtStretch& s : f.stresses)
    to_stdout("  {:>7.2f} {:>14} {:>14.5g} {:>14}\n", s.stretch, text(s.model), s.hencky, text(s.neo_hooke));
}

void print_measured(const MaterialFacts& f) {
  const IsotropicMaterial& m = f.m;
  to_stdout("\nmeasured back from {}\n", f.lattice                                 ? "a block of 4 x 4 x 4 cells"
                                         : f.p.row.topology == Topology::hexagonal ? "a sheet of 4 rows"
                                                                                   : "an infinite periodic network");
  to_stdout("  E  = {:.8g} Pa   ({:+.2e} relative)\n", f.measured.youngs_modulus,
            f.measured.youngs_modulus / m.youngs_modulus - 1);
  to_stdout("  nu = {:.8g}   ({:+.2e})\n", f.measured.poisson_ratio, f.measured.poisson_ratio - m.poisson_ratio);
  to_stdout("  G  = {:.8g} Pa   ({:+.2e} relative)\n", f.measured.shear_modulus,
            f.measured.shear_modulus / shear_modulus(m) - 1);
}

void print_warnings(const ModelParameters& p, const IsotropicMaterial& m) {
  if (p.has(Extension::none) && !same_poisson_ratio(m.poisson_ratio, 0.25))
    to_stdout("\nwarning: springs alone have nu = 1/4 (Cauchy relation); use hybmss or emsm for nu = {:g}\n",
              m.poisson_ratio);
  if (p.row.topology == Topology::cells && !p.has(Extension::averaging) && p.face_to_cube < 0.2)
    to_stdout("\nwarning: without face diagonals (A < 0.2) the lattice has (nearly) zero-energy modes and wrinkles\n");
  if (p.paper_e_form) to_stdout("\nwarning: paper_e_form is right for nu = 1/4 only\n");
}

}  // namespace

void MaterialCommand::add_options(CLI::App& command) {
  command.add_option("--youngs-modulus,-E", moduli_.youngs_modulus, "Young's modulus [Pa]");
  command.add_option("--poisson-ratio,--nu", moduli_.poisson_ratio, "Poisson's ratio, -1 < nu < 0.5");
  command.add_option("--shear-modulus,-G", moduli_.shear_modulus, "shear modulus [Pa]");
  command.add_option("--bulk-modulus,-K", moduli_.bulk_modulus, "bulk modulus [Pa]");
  command.add_option("--lame-lambda", moduli_.lame_lambda, "Lame's first parameter [Pa]");
  command.add_option("--density", density_, "density [kg/m^3]")->capture_default_str();
  command.add_option("--cell-size", cell_size_, "edge of the cubic cells [m]")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--model", choice_.name, "row of the model table (springproof list)")->capture_default_str();
  command.add_option("--face-to-cube", face_to_cube_, "A = k_f / k_c");
  command.add_option("--dispersion", dispersion_,
                     "eMSM: symmetric, share_weighted, published, published_transposed or finite_strain");
  command.add_option("--weights", weights_,
                     "eMSM, symmetric or finite_strain: volume or kL (default: by the sign of q)");
  command.add_option("--springs-per-node", springs_per_node_, "random: mean number of springs at a node (default 15)");
  command.add_option("--frequency", frequency_, "a vibration [Hz] whose damping by implicit Euler is printed")
      ->check(positive())
      ->capture_default_str();
  command.add_flag("--json", json_, "print JSON");
}

int MaterialCommand::run() const {
  IsotropicMaterial m;
  try {
    m = material_from(moduli_, density_);
  } catch (const std::invalid_argument& e) {
    throw InputError(e.what());
  }
  ModelChoice choice = choice_;
  if (face_to_cube_) choice.options["face_to_cube"] = *face_to_cube_;
  if (dispersion_) choice.options["dispersion"] = *dispersion_;
  if (weights_) choice.options["weights"] = *weights_;
  if (springs_per_node_) choice.options["springs_per_node"] = *springs_per_node_;
  const ModelParameters p = resolve(choice);
  const MaterialFacts facts{m, p, cell_size_, frequency_};
  if (json_) {
    to_stdout("{}\n", json_of(facts).dump(2));
    return 0;
  }
  print_model(facts);
  if (facts.lattice && !facts.model.network.springs.empty()) print_springs(facts);
  print(facts.dispersion, p, m);
  print_limits(facts);
  print_stresses(facts);
  if (facts.has_limits) {
    print_stable_strains(p, m);
    print_waves(facts);
  }
  print_measured(facts);
  to_stdout("{}", text_of(facts.for_engines()));
  print_warnings(p, m);
  return 0;
}

}  // namespace springproof
