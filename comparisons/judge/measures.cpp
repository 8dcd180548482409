#include "comparisons/judge/measures.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "meshes/locate/locate.h"

namespace springproof {
namespace {

constexpr const char* stress_components[6] = {"xx", "yy", "zz", "xy", "yz", "xz"};

void add_vector(const std::string& name, const Vec3& v, std::map<std::string, double>& out) {
  for (int d = 0; d < 3; ++d) out[name + '.' + "xyz"[d]] = v[d];
  out[name + ".magnitude"] = v.norm();
}

/// The components of a vector measure, each read from the map's value by `read`.
template <class Value, class Read>
std::optional<Vec3> vector_of(const std::map<std::string, Value>& values, const std::string& name, Read read) {
  const auto x = values.find(name + ".x"), y = values.find(name + ".y"), z = values.find(name + ".z");
  if (x == values.end() || y == values.end() || z == values.end()) return {};
  return Vec3(read(x->second), read(y->second), read(z->second));
}

std::optional<Vec3> vector_of(const std::map<std::string, double>& values, const std::string& name) {
  return vector_of(values, name, [](double x) { return x; });
}

/// Magnitude of a reaction of the reference; zero if unknown, or not larger than its uncertainty.
double size_of(const std::map<std::string, ReferenceValue>& truth, const std::string& name) {
  const auto value = vector_of(truth, name, [](const ReferenceValue& r) { return r.value; });
  const auto uncertainty = vector_of(truth, name, [](const ReferenceValue& r) { return r.uncertainty; });
  return value && value->norm() > uncertainty->norm() ? value->norm() : 0;
}

std::vector<int> nodes_on(const Section& section, const Mesh& mesh) {
  const Vec3 normal = section.normal.normalized();
  const double size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
  std::vector<int> nodes;
  for (int n = 0; n < mesh.nodes.rows(); ++n)
    if (std::abs(normal.dot(mesh.nodes.row(n).transpose() - section.point)) <= 1e-6 * size) nodes.push_back(n);
  if (nodes.empty())
    throw InputError(
        fmt::format("section: the plane through ({:.6g}, {:.6g}, {:.6g}) m holds no node of the lattice; "
                    "put it on a layer of nodes",
                    section.point[0], section.point[1], section.point[2]));
  return nodes;
}

}  // namespace

std::map<std::string, double> scalar_measures(const Field& field, const std::vector<Probe>& probes,
                                              const NodalVectors& probe_displacement) {
  std::map<std::string, double> out = {{"volume_change", field.volume_change},
                                       {"volume_change_magnitude", std::abs(field.volume_change)},
                                       {"volume_change_first_order", field.volume_change_first_order}};
  for (const PatchReaction& r : field.reactions) {
    add_vector("force." + r.patch, r.force, out);
    add_vector("torque." + r.patch, r.torque, out);
  }
  for (std::size_t i = 0; i < probes.size(); ++i)
    add_vector("displacement." + probes[i].name, probe_displacement.row(static_cast<Eigen::Index>(i)).transpose(), out);
  return out;
}

std::map<std::string, double> stress_measures(const std::vector<Probe>& probes, const ProbeStresses& stress) {
  std::map<std::string, double> out;
  for (std::size_t i = 0; i < probes.size(); ++i)
    for (int c = 0; c < 6; ++c)
      out["stress." + probes[i].name + "." + stress_components[c]] = stress(static_cast<Eigen::Index>(i), c);
  return out;
}

std::optional<ReactionDifference> reaction_difference(const std::map<std::string, double>& a,
                                                      const std::map<std::string, double>& b,
                                                      const std::map<std::string, ReferenceValue>& truth,
                                                      const std::vector<std::string>& patches, double length) {
  constexpr double vanishing = 0.1;
  std::optional<ReactionDifference> largest;
  for (const std::string& patch : patches) {
    const double force = size_of(truth, "force." + patch), torque = size_of(truth, "torque." + patch);
    const auto compare = [&](const std::string& name, double size, double other) {
      const auto u = vector_of(a, name), v = vector_of(b, name);
      if (!u || !v || !(size > 0 && size > vanishing * other)) return;
      if (const double error = (*u - *v).norm() / size; !largest || error > largest->error) largest = {error, name};
    };
    compare("force." + patch, force, torque / length);
    compare("torque." + patch, torque, force * length);
  }
  return largest;
}

std::map<std::string, double> values_of(const std::map<std::string, ReferenceValue>& limits, double off) {
  std::map<std::string, double> values;
  for (const auto& [measure, limit] : limits) values[measure] = limit.value + off * limit.uncertainty;
  return values;
}

double displacement_error(const NodalVectors& u, const NodalVectors& v, const Eigen::VectorXd& weights) {
  return weighted_norm(u - v, weights) / weighted_norm(v, weights);
}

double section_distance(const Mesh& mesh, const Section& section, const NodalVectors& u, const NodalVectors& v) {
  double sum = 0;
  const std::vector<int> nodes = nodes_on(section, mesh);
  for (int n : nodes) sum += (u.row(n) - v.row(n)).norm();
  return sum / static_cast<double>(nodes.size());
}

double section_axis_distance(const Mesh& mesh, const Section& section, const NodalVectors& u, const NodalVectors& v) {
  const Vec3 normal = section.normal.normalized();
  double sum = 0;
  const std::vector<int> nodes = nodes_on(section, mesh);
  for (int n : nodes) {
    const Vec3 w = (u.row(n) - v.row(n)).transpose();
    sum += (w - normal.dot(w) * normal).lpNorm<1>() / 2;
  }
  return sum / static_cast<double>(nodes.size());
}

NodalVectors interpolate(const Mesh& mesh, const NodalVectors& displacement, const NodalVectors& points) {
  NodalVectors out = NodalVectors::Zero(points.rows(), 3);
  const Locator locator(mesh);
  for (int i = 0; i < points.rows(); ++i) {
    const std::optional<Location> at = locator.find(points.row(i).transpose());
    if (!at)
      throw InputError(fmt::format("at_m: the point ({:.6g}, {:.6g}, {:.6g}) m lies outside the body", points(i, 0),
                                   points(i, 1), points(i, 2)));
    for (int n = 0; n < 8; ++n) out.row(i) += at->shape[n] * displacement.row(mesh.hexahedra[at->cell][n]);
  }
  return out;
}

}  // namespace springproof
