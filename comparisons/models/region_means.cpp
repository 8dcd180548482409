#include "comparisons/models/region_means.h"

#include "msm/laws/filled_volume.h"

namespace springproof {
namespace {

/// Mean of the corners' displacement over the filled part of a cell, but for its triple moment.
Vec3 mean_displacement(const Network& network, std::size_t cell, const NodalVectors& u) {
  const FilledPart& part = network.cells.part(cell);
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < 8; ++a) {
    const Vec3 s(corner_side(a, 0), corner_side(a, 1), corner_side(a, 2));
    const double mixed = s[1] * s[2] * part.mixed[0] + s[2] * s[0] * part.mixed[1] + s[0] * s[1] * part.mixed[2];
    sum += (1. / 8 + s.dot(part.mean) / 4 + mixed / 2) * u.row(network.cells.corners[cell][a]).transpose();
  }
  return sum;
}

}  // namespace

std::map<std::string, double> region_means(const Network& network, const std::vector<MaterialRegion>& regions,
                                           const NodalVectors& u) {
  constexpr const char* components[6] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  constexpr int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  std::map<std::string, double> out;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    double volume = 0, change = 0;
    Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
    Vec3 displacement = Vec3::Zero();
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      if (network.cells.material(c) != static_cast<int>(r + 1)) continue;
      const double V = filled_volume(network, c);
      const Eigen::Matrix3d H = mean_gradient(network, c, u);
      volume += V;
      change += V * ((Eigen::Matrix3d::Identity() + H).determinant() - 1);
      strain += V * (H + H.transpose()) / 2;
      displacement += V * mean_displacement(network, c, u);
    }
    if (!(volume > 0)) continue;
    strain /= volume;
    displacement /= volume;
    const IsotropicMaterial& m = regions[r].material;
    const Eigen::Matrix3d stress =
        2 * shear_modulus(m) * strain + lame_lambda(m) * strain.trace() * Eigen::Matrix3d::Identity();
    const std::string region = "region." + regions[r].name + ".";
    out[region + "volume_change"] = change / volume;
    out[region + "pressure"] = -stress.trace() / 3;
    for (int i = 0; i < 6; ++i) out[region + "mean_stress." + components[i]] = stress(pair[i][0], pair[i][1]);
    for (int d = 0; d < 3; ++d) out[region + "displacement." + "xyz"[d]] = displacement[d];
    out[region + "displacement.magnitude"] = displacement.norm();
  }
  return out;
}

}  // namespace springproof
