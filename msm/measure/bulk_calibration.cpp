#include "msm/measure/bulk_calibration.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include "msm/calibrate.h"
#include "msm/dispersion_weights.h"
#include "msm/measure/homogenise.h"

namespace springproof {
namespace {

constexpr int sample_nodes = 1331;
constexpr double wanted = 1e-3;
constexpr int most_rounds = 12;

/// A periodic sample with unit affine shear modulus, and the model on it.
struct SampleNetwork {
  MassSpringModel model;

  explicit SampleNetwork(const ModelParameters& p) {
    RandomParameters random = p.random;
    random.spacing = 1;
    random.seed = 1;
    model.network = periodic_random_network(std::cbrt(sample_nodes) * Vec3::Ones(), random);
    calibrate(1, model.network);
    model.laws = {Springs{}};
    if (!p.has(Extension::momentum_dispersion)) return;
    MomentumDispersion law{0, p.dispersion, {}};
    if (p.dispersion == Dispersion::symmetric && *p.exact_volumes) {
      DispersionWeights exact = volume_weights(model.network, NodalVectors::Zero(model.network.nodes(), 3), 1);
      law.weight = std::move(exact.weight);
      law.group = std::move(exact.group);
    }
    model.laws.push_back(law);
  }

  Homogenised at(double q) {
    if (auto* law = const_cast<MomentumDispersion*>(dispersion_of(model))) law->q = q;
    return homogenise(model, {1e-6, 20000});
  }
};

/// q with K/G as wanted, by secants on log(K/G), and the shear modulus at it.
BulkCalibration fit(const ModelParameters& p, const IsotropicMaterial& m) {
  SampleNetwork sample(p);
  if (!p.has(Extension::momentum_dispersion))
    return {0.4 * m.youngs_modulus * 2.5 / sample.at(0).youngs_modulus, 0};
  const double goal = bulk_modulus(m) / shear_modulus(m);
  double q = affine_calibration(p, m).q, before = 0, miss_before = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const Homogenised h = sample.at(q);
    const double ratio = h.bulk_modulus / h.shear_modulus, miss = std::log(ratio / goal);
    if (std::abs(miss) < wanted) return {shear_modulus(m) / h.shear_modulus, q};
    // K grows in proportion to 1 + 2 q at most: the first step takes that slope.
    const double slope = round == 0 ? 2 / (1 + 2 * q) : (miss - miss_before) / (q - before);
    before = q;
    miss_before = miss;
    const double step = -miss / slope;
    q = std::max(-0.499, q + std::copysign(std::min(std::abs(step), 0.5 + 2 * std::abs(q)), step));
    if (!std::isfinite(q) || q > 1e5) break;
  }
  throw std::runtime_error(fmt::format(
      "no dispersed fraction gives this network nu = {:g}: its bulk modulus saturates (weights = \"volume\" does not)", m.poisson_ratio));
}

}  // namespace

BulkCalibration affine_calibration(const ModelParameters& p, const IsotropicMaterial& m) {
  return {spring_shear_modulus(p, m), dispersed_fraction(lame_lambda(m), shear_modulus(m))};
}

BulkCalibration calibrate_in_bulk(const ModelParameters& p, const IsotropicMaterial& m) {
  static std::mutex one_at_a_time;
  static std::map<std::string, BulkCalibration> known;  // for E = 1
  const IsotropicMaterial unit{1, m.poisson_ratio, m.density};
  const RandomParameters& r = p.random;
  const std::string key = fmt::format("{} {} {} {} {} {} {} {}", p.row.name, static_cast<int>(p.dispersion), p.exact_volumes.value_or(false), r.min_length,
                                      r.max_length.value_or(0), r.max_length ? 0 : r.springs_per_node, r.stiffness_exponent, m.poisson_ratio);
  {
    const std::scoped_lock lock(one_at_a_time);
    if (const auto at = known.find(key); at != known.end()) return {at->second.spring_shear_modulus * m.youngs_modulus, at->second.q};
  }
  const BulkCalibration c = fit(p, unit);
  const std::scoped_lock lock(one_at_a_time);
  known.emplace(key, c);
  return {c.spring_shear_modulus * m.youngs_modulus, c.q};
}

}  // namespace springproof
