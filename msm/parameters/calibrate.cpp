#include "msm/parameters/calibrate.h"

#include <algorithm>

namespace springproof {
namespace {

constexpr int correction_rounds = 5;
constexpr double largest_correction = 4;

double sum_kL2(const Network& network) {
  double sum = 0;
  for (const Spring& s : network.springs) sum += s.stiffness * s.rest_length * s.rest_length;
  return sum;
}

/// Per node, half of sum k L^2 over its springs [J]: the node's part of sum_kL2(); an image counts for its master.
Eigen::VectorXd shares_of_kL2(const Network& network) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(network.nodes());
  for (const Spring& s : network.springs) {
    const double half = s.stiffness * s.rest_length * s.rest_length / 2;
    share[network.master(s.i)] += half;
    share[network.master(s.j)] += half;
  }
  return share;
}

std::vector<char> well_connected(const Network& network) {
  std::vector<int> springs(network.nodes(), 0);
  for (const Spring& s : network.springs) {
    ++springs[s.i];
    ++springs[s.j];
  }
  const double mean = 2.0 * double(network.springs.size()) / network.nodes();
  std::vector<char> marked(springs.size());
  std::transform(springs.begin(), springs.end(), marked.begin(), [&](int n) { return n >= mean; });
  return marked;
}

/// sum k L^2 / V of the marked nodes [Pa].
double density_of_kL2(const Network& network, const std::vector<char>& marked) {
  const Eigen::VectorXd share = shares_of_kL2(network);
  double sum = 0, volume = 0;
  for (int n = 0; n < network.nodes(); ++n)
    if (marked[n]) {
      sum += share[n];
      volume += network.volume[n];
    }
  return sum / volume;
}

}  // namespace

double affine_shear_modulus(const Network& network) {
  const double d = network.triangles.empty() ? 3 : 2;
  return sum_kL2(network) / (d * (d + 2) * network.volume.sum());
}

double affine_shear_modulus(const MassSpringModel& model) {
  const AveragedSprings* averaged = averaged_springs_of(model);
  return averaged ? averaged->shear_modulus : affine_shear_modulus(model.network);
}

double volume_stiffness_ratio(const MassSpringModel& model) {
  if (const MomentumDispersion* dispersion = dispersion_of(model))
    return added_lambda(*dispersion, model.network.triangles.empty() ? 3 : 2);
  if (const AveragedSprings* averaged = averaged_springs_of(model)) {
    double largest = averaged->lame_lambda / averaged->shear_modulus;
    for (const AveragedSprings& other : averaged->regions)
      largest = std::max(largest, other.lame_lambda / other.shear_modulus);
    return largest - 1;
  }
  const auto* volume = law_of<VolumeCorrection>(model);
  if (!volume) return 0;
  double largest = volume->kappa;
  for (const VolumeCorrection& other : volume->regions) largest = std::max(largest, other.kappa);
  return largest / affine_shear_modulus(model);
}

void calibrate(double shear_modulus, Network& network) {
  const double factor = shear_modulus / affine_shear_modulus(network);
  for (Spring& s : network.springs) s.stiffness *= factor;
  for (Spring& s : network.cells.springs) s.stiffness *= factor;
}

void correct_surface(Network& network, const std::vector<char>& bulk) {
  const bool known = std::find(bulk.begin(), bulk.end(), 1) != bulk.end(), periodic = !network.image_of.empty();
  const double c = periodic ? sum_kL2(network) / network.volume.sum()
                            : density_of_kL2(network, known ? bulk : well_connected(network));
  const std::vector<Spring> before = network.springs;
  for (int round = 0; round < correction_rounds; ++round) {
    const Eigen::VectorXd factor = (c * network.volume).cwiseQuotient(shares_of_kL2(network));
    for (std::size_t n = 0; n < before.size(); ++n) {
      Spring& s = network.springs[n];
      const double k = before[n].stiffness;
      s.stiffness = std::clamp(s.stiffness * (factor[network.master(s.i)] + factor[network.master(s.j)]) / 2,
                               k / largest_correction, k * largest_correction);
    }
  }
  const double scale = c * network.volume.sum() / sum_kL2(network);
  for (Spring& s : network.springs) s.stiffness *= scale;
}

}  // namespace springproof
