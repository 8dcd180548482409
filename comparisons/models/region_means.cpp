#include "comparisons/models/region_means.h"

#include <limits>

#include "comparisons/reference/reference_grids.h"
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
  constexpr int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  std::vector<fem::RegionMeans> means;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    double volume = 0;
    Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
    fem::RegionMeans& mean = means.emplace_back();
    mean.energy = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      if (network.cells.material(c) != static_cast<int>(r + 1)) continue;
      const double V = filled_volume(network, c);
      const Eigen::Matrix3d H = mean_gradient(network, c, u);
      volume += V;
      mean.volume_change += V * ((Eigen::Matrix3d::Identity() + H).determinant() - 1);
      strain += V * (H + H.transpose()) / 2;
      mean.displacement += V * mean_displacement(network, c, u);
    }
    strain /= volume;
    mean.volume_change /= volume;
    mean.displacement /= volume;
    const IsotropicMaterial& m = regions[r].material;
    const Eigen::Matrix3d stress =
        2 * shear_modulus(m) * strain + lame_lambda(m) * strain.trace() * Eigen::Matrix3d::Identity();
    for (int i = 0; i < 6; ++i) mean.stress(0, i) = stress(pair[i][0], pair[i][1]);
  }
  return region_measures(regions, means);
}

}  // namespace springproof
