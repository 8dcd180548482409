#include "msm/periodic/bulk_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include "msm/parameters/calibrate.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/homogenise.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

constexpr int sample_nodes = 1331;
constexpr std::uint64_t sample_seed = 1ull << 32;  // beyond those of case files: no case measures this sample
constexpr double wanted = 1e-3;
constexpr int most_rounds = 12;
constexpr double largest_step = 2, largest_x = 12;  // of log(1 + 2 q)

Network periodic_lattice(const ModelParameters& p, double spacing, int nodes) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(nodes))));
  const Vec3 box = n * spacing * Vec3::Ones();
  Network network = cubic_lattice(block_mesh(box, {n, n, n}), isotropic_pattern(p.face_to_cube));
  make_periodic(box, network);
  return network;
}

Homogenised measured(const MassSpringModel& sample) { return homogenise(sample, {1e-6, 20000}); }

/// A periodic sample with unit affine shear modulus, and the model on it.
MassSpringModel sample_of(ModelParameters p) {
  p.random.seed = sample_seed;
  return periodic_random_model(p, {1, 0}, 1, sample_nodes);
}

/// q for the required K/G, by the secant method on log(K/G) over log(1 + 2 q): K is nearly proportional to 1 + 2 q, and
/// q > -1/2.
BulkCalibration fit_dispersion(const ModelParameters& p, const IsotropicMaterial& m, double least_q) {
  MassSpringModel sample = sample_of(p);
  double& q = std::get<MomentumDispersion>(sample.laws.back()).q;
  const double goal = bulk_modulus(m) / shear_modulus(m), least = std::log1p(2 * least_q);
  double x = std::max(least, std::log1p(2 * affine_calibration(p, m).q)), before = 0, miss_before = 0;
  for (int round = 0; round < most_rounds && x < largest_x; ++round) {
    q = std::expm1(x) / 2;
    const Homogenised h = measured(sample);
    const double miss = std::log(h.bulk_modulus / h.shear_modulus / goal);
    if (std::abs(miss) < wanted) return {shear_modulus(m) / h.shear_modulus, q};
    const double slope = round == 0 ? 1 : (miss - miss_before) / (x - before);
    before = x;
    miss_before = miss;
    x = std::max(least, x - std::clamp(miss / slope, -largest_step, largest_step));
  }
  throw std::runtime_error(fmt::format(
      "no dispersed fraction gives this network nu = {:g}: its bulk modulus saturates (weights = \"volume\" does not)",
      m.poisson_ratio));
}

BulkCalibration fit(ModelParameters p, const IsotropicMaterial& m) {
  if (!p.has(Extension::momentum_dispersion)) return {m.youngs_modulus / measured(sample_of(p)).youngs_modulus, 0};
  // If the weights are chosen by the sign of q, q must have that sign, to the last bit: with q >= 0 exact volumes are a
  // sum of squares.
  const bool sum_of_squares = has_energy(p.dispersion) && !p.exact_volumes && exact_volumes(p, m);
  if (has_energy(p.dispersion)) p.exact_volumes = exact_volumes(p, m);
  return fit_dispersion(p, m, sum_of_squares ? 0 : -0.5);
}

/// Key of the parameters that determine the bulk of a random network.
std::string key_of(const RandomParameters& r) {
  return fmt::format("{} {} {} {} {}", r.min_length, r.max_length.value_or(0), r.max_length ? 0 : r.springs_per_node,
                     r.stiffness_exponent, r.surface_nodes);
}

/// Result of compute(), cached by key for the lifetime of the program.
template <class Value, class Compute>
Value kept(const std::string& key, const Compute& compute) {
  static std::mutex one_at_a_time;
  static std::map<std::string, Value> known;
  {
    const std::scoped_lock lock(one_at_a_time);
    if (const auto at = known.find(key); at != known.end()) return at->second;
  }
  const Value value = compute();
  const std::scoped_lock lock(one_at_a_time);
  return known.emplace(key, value).first->second;
}

}  // namespace

BulkCalibration affine_calibration(const ModelParameters& p, const IsotropicMaterial& m) {
  const int dimensions = p.row.topology == Topology::hexagonal ? 2 : 3;
  return {spring_shear_modulus(p, m), dispersed_fraction(lame_lambda(m), shear_modulus(m), dimensions)};
}

BulkCalibration calibrate_in_bulk(const ModelParameters& p, const IsotropicMaterial& m) {
  const int weights = p.exact_volumes ? *p.exact_volumes : 2;
  const std::string key = fmt::format("{} {} {} {} {}", p.row.name, static_cast<int>(p.dispersion), weights,
                                      key_of(p.random), m.poisson_ratio);
  const BulkCalibration c = kept<BulkCalibration>(key, [&] { return fit(p, {1, m.poisson_ratio, m.density}); });
  return {c.spring_shear_modulus * m.youngs_modulus, c.q};
}

BulkCalibration bulk_calibration(const ModelParameters& p, const IsotropicMaterial& m) {
  return p.row.topology == Topology::random && p.homogenised ? calibrate_in_bulk(p, m) : affine_calibration(p, m);
}

double springs_poisson_ratio(const ModelParameters& parameters) {
  if (parameters.row.topology != Topology::random || !parameters.homogenised) return 0.25;
  return kept<double>(key_of(parameters.random), [&] {
    ModelParameters p = parameters;
    p.row.extension = Extension::none;
    return measured(sample_of(p)).poisson_ratio;
  });
}

bool exact_volumes(const ModelParameters& p, const IsotropicMaterial& material) {
  return p.exact_volumes ? *p.exact_volumes : material.poisson_ratio >= springs_poisson_ratio(p);
}

MassSpringModel periodic_random_model(const ModelParameters& p, const BulkCalibration& c, double spacing, int nodes) {
  RandomParameters random = p.random;
  random.spacing = spacing;
  random.windows = false;  // they compensate for walls, which a periodic cell does not have
  MassSpringModel model{periodic_random_network(spacing * std::cbrt(nodes) * Vec3::Ones(), random), {Springs{}}};
  const NodalVectors no_surface = NodalVectors::Zero(model.network.nodes(), 3);
  if (passes_patch_test(p.row))
    fit_patch(no_surface, c.spring_shear_modulus, model.network);
  else if (random.surface_nodes)
    correct_surface(model.network);
  calibrate(c.spring_shear_modulus, model.network);
  if (p.has(Extension::momentum_dispersion)) model.laws.push_back(dispersion_law(p, model.network, c, no_surface));
  return model;
}

MassSpringModel periodic_model(const ModelParameters& parameters, const IsotropicMaterial& material, double spacing,
                               int nodes) try {
  ModelParameters p = parameters;
  if (p.row.topology == Topology::hexagonal)
    throw InputError(fmt::format("{}: a planar model has no three-dimensional bulk to homogenise", p.row.name));
  const BulkCalibration bulk = bulk_calibration(parameters, material);
  if (p.has(Extension::momentum_dispersion) && has_energy(p.dispersion)) p.exact_volumes = exact_volumes(p, material);
  if (p.row.topology == Topology::random) return periodic_random_model(p, bulk, spacing, nodes);
  MassSpringModel model{periodic_lattice(p, spacing, nodes), {}};
  calibrate(bulk.spring_shear_modulus, model.network);
  model.laws = laws_of(p, model.network, material, bulk, NodalVectors::Zero(model.network.nodes(), 3));
  return model;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", parameters.row.name, e.what()));
}

}  // namespace springproof
