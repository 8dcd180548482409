#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <Eigen/Dense>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/commands/material/material_options.h"
#include "comparisons/sweep/status.h"
#include "msm/algebra/dense.h"
#include "msm/measure/statistics.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/periodic/homogenise.h"
#include "problem/case_file/experiment.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

constexpr int random_nodes = 1331, lattice_nodes = 27;
constexpr double spacing = 0.1;             // [m] of nodes; moduli do not depend on it
constexpr std::size_t telling_samples = 5;  // tell a bias from scatter

struct Sample {
  std::uint64_t seed;
  long nodes;
  double springs_per_node;
  Homogenised h;
};

/// A quantity of a sample: its names, and how to read it.
struct Quantity {
  const char* key;
  const char* label;
  double (*of)(const Homogenised&);
  bool modulus;  ///< in pascal
};

const std::vector<Quantity> quantities = {
    {"youngs_modulus_Pa", "E [Pa]", [](const Homogenised& h) { return h.youngs_modulus; }, true},
    {"poisson_ratio", "nu", [](const Homogenised& h) { return h.poisson_ratio; }, false},
    {"shear_modulus_Pa", "G [Pa]", [](const Homogenised& h) { return h.shear_modulus; }, true},
    {"bulk_modulus_Pa", "K [Pa]", [](const Homogenised& h) { return h.bulk_modulus; }, true},
    {"anisotropy", "anisotropy", [](const Homogenised& h) { return h.anisotropy; }, false},
    {"asymmetry", "asymmetry", [](const Homogenised& h) { return h.asymmetry; }, false}};

struct MeanAndSpread {
  double mean = 0, spread = 0;  ///< spread: standard deviation of a sample; 0 for a single one
};

MeanAndSpread over(const std::vector<Sample>& samples, const Quantity& quantity) {
  MeanAndSpread m;
  const auto n = static_cast<double>(samples.size());
  for (const Sample& s : samples) m.mean += quantity.of(s.h) / n;
  for (const Sample& s : samples) m.spread += std::pow(quantity.of(s.h) - m.mean, 2);
  m.spread = samples.size() > 1 ? std::sqrt(m.spread / (n - 1)) : 0;
  return m;
}

Sample measure(ModelParameters p, const IsotropicMaterial& material, int nodes, std::uint64_t seed) {
  p.random.seed = seed;
  const MassSpringModel model = periodic_model(p, material, spacing, nodes);
  const NetworkStatistics s = statistics(model.network);
  return {seed, s.nodes, s.springs_per_node, homogenise(model)};
}

std::vector<Sample> measure_seeds(const ModelParameters& p, const IsotropicMaterial& material, int nodes) {
  std::vector<Sample> samples;
  Status status;
  const Status::Working working(status, fmt::format("homogenise {}", p.row.name));
  for (int i = 0; i < p.seeds; ++i) {
    progress::phase(fmt::format("network {} of {}, about {} nodes", i + 1, p.seeds, nodes));
    samples.push_back(measure(p, material, nodes, p.random.seed + static_cast<std::uint64_t>(i)));
  }
  return samples;
}

bool stable(const Homogenised& h) { return symmetric_eigenvalues(h.C + h.C.transpose())[0] > 0; }

/// The value that the calibration aims at.
double wanted(const Quantity& quantity, const ModelParameters& p, const IsotropicMaterial& m) {
  const IsotropicMaterial aim =
      p.has(Extension::none) ? IsotropicMaterial{2.5 * spring_shear_modulus(p, m), 0.25, m.density} : m;
  Homogenised h{};
  h.youngs_modulus = aim.youngs_modulus;
  h.poisson_ratio = aim.poisson_ratio;
  h.shear_modulus = shear_modulus(aim);
  h.bulk_modulus = bulk_modulus(aim);
  return quantity.of(h);
}

nlohmann::json matrix_json(const Eigen::MatrixXd& C) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto row : C.rowwise()) rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

nlohmann::json to_json(const std::vector<Sample>& samples, const ModelParameters& p, const IsotropicMaterial& m) {
  nlohmann::json out = {{"model", {{"name", p.row.name}, {"spacing_m", spacing}}},
                        {"notation", "Voigt: xx yy zz yz zx xy, engineering shear strains"}};
  for (const Quantity& q : quantities) {
    const MeanAndSpread result = over(samples, q);
    out["calibrated_to"][q.key] = wanted(q, p, m);
    out["mean"][q.key] = result.mean;
    out["spread"][q.key] = result.spread;
  }
  out["samples"] = nlohmann::json::array();
  for (const Sample& s : samples) {
    nlohmann::json sample = {{"seed", s.seed},
                             {"nodes", s.nodes},
                             {"springs_per_node", s.springs_per_node},
                             {"C_Pa", matrix_json(s.h.C)},
                             {"stable", stable(s.h)},
                             {"iterations", s.h.iterations},
                             {"residual", s.h.residual}};
    for (const Quantity& q : quantities) sample[q.key] = q.of(s.h);
    out["samples"].push_back(sample);
  }
  return out;
}

/// "E by +1.2 %, 7 standard errors of its mean; ...": moduli whose means are off by more than four times their standard
/// error.
std::string biases(const std::vector<Sample>& samples, const ModelParameters& p, const IsotropicMaterial& m) {
  std::vector<std::string> off;
  for (const Quantity& q : quantities) {
    const MeanAndSpread result = over(samples, q);
    const double aim = wanted(q, p, m), error = result.spread / std::sqrt(static_cast<double>(samples.size()));
    if (q.modulus && std::abs(result.mean - aim) > 4 * error)
      off.push_back(fmt::format("{} by {:+.2g} %, {:.0f} standard errors of its mean", std::string(1, q.label[0]),
                                100 * (result.mean / aim - 1), std::abs(result.mean - aim) / error));
  }
  return fmt::format("{}", fmt::join(off, "; "));
}

/// What the column of ratios is.
std::string ratio_words(const std::vector<Sample>& samples, const ModelParameters& p, const IsotropicMaterial& m) {
  if (p.row.topology != Topology::random || !p.homogenised)
    return "The calibration takes the strain as affine; ratio is what is left once the nodes have found their places.";
  const std::string how = "The network that compare uses, calibrated on another sample of the same kind; ";
  if (samples.size() < telling_samples)
    return how + "ratio is scatter and the model's bias, which --seeds 10 tells apart.";
  const std::string off = biases(samples, p, m);
  return how + (off.empty() ? "ratio is what networks of this size scatter."
                            : fmt::format("beyond scatter, ratio is a bias of the model: {}.", off));
}

void print(const std::vector<Sample>& samples, const ModelParameters& p, const IsotropicMaterial& m) {
  const Sample& first = samples.front();
  to_stdout("model      {}: {}\n", p.row.name, p.row.what);
  to_stdout("cell       {} nodes, {:.3g} springs per node, spacing {:.6g} m, {} sample{}\n\n", first.nodes,
            first.springs_per_node, spacing, samples.size(), samples.size() > 1 ? "s" : "");
  to_stdout("C [Pa]     xx yy zz yz zx xy{}\n", samples.size() > 1 ? fmt::format(", seed {}", first.seed) : "");
  const double round_off = 1e-12 * first.h.C.cwiseAbs().maxCoeff();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) to_stdout("{:>14.6g}", std::abs(first.h.C(i, j)) > round_off ? first.h.C(i, j) : 0.0);
    to_stdout("\n");
  }
  to_stdout("\n{:<12}{:>14}{:>14}{:>14}{:>10}\n", "", "mean", "spread", "calibrated to", "ratio");
  for (const Quantity& q : quantities) {
    const MeanAndSpread result = over(samples, q);
    const double aim = wanted(q, p, m);
    to_stdout("{:<12}{:>14.6g}{:>14.2g}", q.label, result.mean, result.spread);
    if (q.modulus) to_stdout("{:>14.6g}{:>10.4f}", aim, result.mean / aim);
    if (std::string(q.key) == "poisson_ratio") to_stdout("{:>14.6g}", aim);
    to_stdout("\n");
  }
  for (const Sample& s : samples)
    if (!stable(s.h))
      to_stdout("\nwarning: seed {}: the stiffness is not positive definite; such a body is unstable\n", s.seed);
  to_stdout("\n{}\n", ratio_words(samples, p, m));
}

class HomogeniseCommand {
 public:
  void add_options(CLI::App& command);

  /// Prints the table (or JSON).  @return 0.
  /// @throws InputError if the moduli or the model cannot be used; std::runtime_error if the network is unstable.
  int run() const;

 private:
  Moduli moduli_;
  std::optional<int> nodes_;
  ModelChoice choice_{"msm_random", {}, "msm_random", {}};
  bool json_ = false;
};

void HomogeniseCommand::add_options(CLI::App& command) {
  add_moduli(command, moduli_);
  add_model(command, choice_);
  command
      .add_option(
          "--nodes", nodes_,
          fmt::format("nodes of the periodic cell (default {} random, {} on a lattice)", random_nodes, lattice_nodes))
      ->check(CLI::Range(1, 1000000));
  command.add_flag("--json", json_, "print JSON");
}

int HomogeniseCommand::run() const {
  const IsotropicMaterial m = material_of(moduli_);
  const ModelParameters p = resolve(choice_);
  const int nodes = nodes_.value_or(p.row.topology == Topology::random ? random_nodes : lattice_nodes);
  const std::vector<Sample> samples = measure_seeds(p, m, nodes);
  if (json_)
    to_stdout("{}\n", to_json(samples, p, m).dump(2));
  else
    print(samples, p, m);
  return 0;
}

}  // namespace

RunCommand homogenise_command(CLI::App& parser) { return made<HomogeniseCommand>(parser); }

}  // namespace springproof
