#include "comparisons/judge/patch_mean.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "comparisons/judge/deformation.h"

namespace springproof {
namespace {

struct Sample {
  Vec3 point;
  double area;
};

/// Three points inside, each nearer to one corner: exact for quadratic functions.
void sample_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<Sample>& out) {
  const double area = (b - a).cross(c - a).norm() / 2;
  for (const Vec3& corner : {a, b, c}) out.push_back({(a + b + c + 3 * corner) / 6, area / 3});
}

/// The 3 x 3 points of Gauss on the bilinear facet.
void sample_quadrilateral(const std::array<Vec3, 4>& corner, std::vector<Sample>& out) {
  const double abscissa[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
               weight[] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
  const auto& [a, b, c, d] = corner;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double s = abscissa[i], t = abscissa[j];
      const Vec3 along_s = (1 - t) * (b - a) + t * (c - d), along_t = (1 - s) * (d - a) + s * (c - b);
      const Vec3 point = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d;
      out.push_back({point, weight[i] * weight[j] * along_s.cross(along_t).norm()});
    }
}

std::vector<Sample> samples_on(const Mesh& mesh, const Patch& patch) {
  const auto X = [&](int n) -> Vec3 { return mesh.nodes.row(n).transpose(); };
  std::vector<Sample> samples;
  for (const auto& f : patch.facets)
    if (f[3] < 0)
      sample_triangle(X(f[0]), X(f[1]), X(f[2]), samples);
    else
      sample_quadrilateral({X(f[0]), X(f[1]), X(f[2]), X(f[3])}, samples);
  return samples;
}

}  // namespace

std::vector<PatchSamples> samples_of_patches(const Mesh& mesh) {
  std::vector<PatchSamples> all;
  for (const Patch& patch : mesh.patches) {
    const std::vector<Sample> samples = samples_on(mesh, patch);
    const auto count = static_cast<Eigen::Index>(samples.size());
    PatchSamples s{patch.name, NodalVectors(count, 3), Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      s.points.row(i) = samples[static_cast<std::size_t>(i)].point.transpose();
      s.weights[i] = samples[static_cast<std::size_t>(i)].area;
    }
    if (s.weights.sum() <= 0) continue;
    s.weights /= s.weights.sum();
    all.push_back(std::move(s));
  }
  return all;
}

std::map<std::string, double> mean_displacements(const std::vector<PatchSamples>& patches, const NodalVectors& u) {
  std::map<std::string, double> out;
  Eigen::Index first = 0;
  for (const PatchSamples& p : patches) {
    const Vec3 mean = u.middleRows(first, p.points.rows()).transpose() * p.weights;
    for (int d = 0; d < 3; ++d) out["mean_displacement." + p.patch + '.' + "xyz"[d]] = mean[d];
    out["mean_displacement." + p.patch + ".magnitude"] = mean.norm();
    first += p.points.rows();
  }
  return out;
}

std::map<std::string, double> turns(const std::vector<PatchSamples>& patches, const NodalVectors& u) {
  std::map<std::string, double> out;
  Eigen::Index first = 0;
  for (const PatchSamples& p : patches) {
    const auto moved = u.middleRows(first, p.points.rows());
    const Eigen::RowVector3d middle = p.weights.transpose() * p.points, mean = p.weights.transpose() * moved;
    const NodalVectors rest = p.points.rowwise() - middle, now = rest + (moved.rowwise() - mean);
    const Eigen::AngleAxisd turn(nearest_rotation(rest, now, p.weights));
    for (int d = 0; d < 3; ++d)
      out["turn." + p.patch + '.' + "xyz"[d]] = turn.angle() * turn.axis()[d] * 180 / std::numbers::pi;
    first += p.points.rows();
  }
  return out;
}

}  // namespace springproof
