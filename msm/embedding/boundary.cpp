#include "msm/embedding/boundary.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "meshes/locate/locate.h"
#include "msm/embedding/rigid_motions.h"

namespace springproof {
namespace {

/// Prescribes the load's displacement at the nodes `held` by its patch; X: rest positions of all nodes.
void prescribe(const Load& load, int number, const std::vector<int>& held, const NodalVectors& X, Kinematics kinematics,
               double factor, BoundaryConditions& bc) {
  const double size = (X.colwise().maxCoeff() - X.colwise().minCoeff()).norm();
  for (int node : held) {
    const PrescribedValue value = prescribed_displacement(load, X.row(node).transpose(), kinematics, factor);
    for (int d = 0; d < 3; ++d) {
      if (!value[d]) continue;
      const int unknown = 3 * node + d;
      if (bc.fixed[unknown] && std::abs(bc.prescribed(node, d) - *value[d]) > 1e-9 * size)
        throw InputError(fmt::format(
            "load {}: patch '{}' prescribes displacement {} = {:.6g} m at a node where load {} already prescribes "
            "{:.6g} m",
            number + 1, *patch_of(load), "xyz"[d], *value[d], bc.owner[unknown] + 1, bc.prescribed(node, d)));
      if (!bc.fixed[unknown])
        bc.owner[unknown] = number;
      else
        bc.shared.push_back({unknown, number, 0});
      bc.fixed[unknown] = 1;
      bc.prescribed(node, d) = *value[d];
    }
  }
}

/// Divides the unknowns that loads on several patches prescribe; area_at(patch): of the nodes [m^2].
template <class AreaAt>
void divide_shared(const std::vector<Load>& loads, const AreaAt& area_at, BoundaryConditions& bc) {
  const auto on = [&](int load) -> const std::string& { return *patch_of(loads[load]); };
  std::map<int, std::set<std::string>> patches;  // of an unknown
  std::erase_if(bc.shared, [&](const SharedUnknown& s) {
    std::set<std::string>& of = patches.try_emplace(s.unknown, std::set{on(bc.owner[s.unknown])}).first->second;
    return !of.insert(on(s.load)).second;
  });
  std::map<std::string, Eigen::VectorXd> areas;
  for (const auto& [unknown, names] : patches)
    for (const std::string& name : names)
      if (!areas.contains(name)) areas[name] = area_at(name).cwiseAbs();
  for (SharedUnknown& s : bc.shared) {
    const std::set<std::string>& of = patches.at(s.unknown);
    double all = 0;
    for (const std::string& name : of) all += areas.at(name)[s.unknown / 3];
    s.share = all > 0 ? areas.at(on(s.load))[s.unknown / 3] / all : 1.0 / static_cast<double>(of.size());
  }
}

void add_point_force(const PointForce& load, const Mesh& mesh, NodalVectors& external) {
  const std::optional<Location> at = locate(mesh, load.at);
  if (!at)
    throw InputError(fmt::format(
        "at_m: the point force at ({:.6g}, {:.6g}, {:.6g}) m lies outside the body (of voxels: outside its cubes, "
        "which may end half a cube below the surface)",
        load.at[0], load.at[1], load.at[2]));
  for (int n = 0; n < 8; ++n) external.row(mesh.hexahedra[at->cell][n]) += at->shape[n] * load.force.transpose();
}

void add_uniform(const Mesh& mesh, const std::string& on, const Vec3& traction, bool is_total, NodalVectors& external) {
  const Eigen::VectorXd area = nodal_areas(mesh, patch(mesh, on));
  external += (is_total ? area / area.sum() : area) * traction.transpose();
}

/// Adds the nodal forces of a pressure on a facet: integral of N_i * (area vector); by 2 x 2 Gauss points, which is
/// exact.
void add_facet_pressure(const Mesh& mesh, const std::array<int, 4>& facet, double pressure, NodalVectors& external) {
  const auto X = [&](int i) -> Vec3 { return mesh.nodes.row(facet[i]).transpose(); };
  if (facet[3] < 0) {
    const Vec3 share = -pressure / 6 * (X(1) - X(0)).cross(X(2) - X(0));
    for (int i = 0; i < 3; ++i) external.row(facet[i]) += share.transpose();
    return;
  }
  const double gauss[2] = {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)};
  for (const double s : gauss)
    for (const double t : gauss) {
      const Vec3 along_s = (1 - t) * (X(1) - X(0)) + t * (X(2) - X(3));
      const Vec3 along_t = (1 - s) * (X(3) - X(0)) + s * (X(2) - X(1));
      const Vec3 force = -pressure / 4 * along_s.cross(along_t);
      const double shape[4] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
      for (int i = 0; i < 4; ++i) external.row(facet[i]) += shape[i] * force.transpose();
    }
}

void add_pressure(const Mesh& mesh, const std::string& on, double pressure, NodalVectors& external) {
  for (const auto& facet : patch(mesh, on).facets) add_facet_pressure(mesh, facet, pressure, external);
}

BoundaryConditions nothing(Eigen::Index n) {
  return {std::vector<char>(3 * n, 0), std::vector<int>(3 * n, -1), NodalVectors::Zero(n, 3), NodalVectors::Zero(n, 3)};
}

/// Calls `act` for each load; error messages name the load.
template <class Action>
void for_each(const std::vector<Load>& loads, const Action& act) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    try {
      act(loads[i], static_cast<int>(i));
    } catch (const std::invalid_argument& e) {
      throw InputError(fmt::format("load {}: {}", i + 1, e.what()));
    }
  }
}

/// Adds to a load's nodal forces a rigid field, weighted by the nodes' areas or volumes, so that their wrench is the
/// load's.
void complete(const std::optional<Wrench>& wrench, double factor, const NodalVectors& X, const Eigen::VectorXd& weights,
              NodalVectors& force) {
  if (!wrench) return;
  RegionMoments region;
  Wrench missing{factor * wrench->force, factor * wrench->moment, wrench->about};
  for (Eigen::Index n = 0; n < force.rows(); ++n) {
    const Vec3 at = X.row(n).transpose(), f = force.row(n).transpose();
    if (weights[n] > 0) region.add(weights[n], at);
    missing.force -= f;
    missing.moment -= (at - wrench->about).cross(f);
  }
  const RigidField field = rigid_field(region, missing);
  for (Eigen::Index n = 0; n < force.rows(); ++n)
    force.row(n) += weights[n] * field.at(X.row(n).transpose()).transpose();
}

/// Forces of one load on the mesh's nodes [N].
NodalVectors forces_of(const Load& load, const Mesh& mesh, double density, double factor) {
  NodalVectors force = NodalVectors::Zero(mesh.nodes.rows(), 3);
  if (const auto* t = std::get_if<Traction>(&load))
    add_uniform(mesh, t->on, factor * t->traction, false, force);
  else if (const auto* q = std::get_if<Pressure>(&load))
    add_pressure(mesh, q->on, factor * q->pressure, force);
  else if (const auto* f = std::get_if<PatchForce>(&load))
    add_uniform(mesh, f->on, factor * f->force, true, force);
  else if (const auto* g = std::get_if<Gravity>(&load))
    force += factor * density * nodal_volumes(mesh) * g->acceleration.transpose();
  else if (const auto* p = std::get_if<PointForce>(&load))
    add_point_force({p->at, factor * p->force}, mesh, force);
  if (const auto* wrench = wrench_of(load); wrench && *wrench)
    complete(*wrench, factor, mesh.nodes,
             patch_of(load) ? nodal_areas(mesh, patch(mesh, *patch_of(load))) : nodal_volumes(mesh), force);
  return force;
}

/// Forces on the mesh's nodes [N].
NodalVectors mesh_forces(const std::vector<Load>& loads, const Mesh& mesh, double density, double factor) {
  NodalVectors external = NodalVectors::Zero(mesh.nodes.rows(), 3);
  for_each(loads, [&](const Load& load, int number) {
    if (std::holds_alternative<FieldBodyForce>(load))
      throw InputError(fmt::format("load {}: body_force_of: the mass-spring models take no such load", number + 1));
    if (!prescribes_displacement(load)) external += forces_of(load, mesh, density, factor);
  });
  return external;
}

/// Forces of a load on the nodes of a network that knows the true body [N]; nothing for a force at a point.
std::optional<NodalVectors> true_forces(const Load& load, const Embedding& e, const NodalVectors& X, double density,
                                        double factor) {
  NodalVectors force;
  if (const auto* t = std::get_if<Traction>(&load))
    force = e.patches.at(t->on).area * (factor * t->traction).transpose();
  if (const auto* q = std::get_if<Pressure>(&load)) force = -factor * q->pressure * e.patches.at(q->on).normal;
  if (const auto* f = std::get_if<PatchForce>(&load)) {
    const Eigen::VectorXd& area = e.patches.at(f->on).area;
    force = area / area.sum() * (factor * f->force).transpose();
  }
  if (const auto* g = std::get_if<Gravity>(&load)) force = factor * density * e.volumes * g->acceleration.transpose();
  if (force.rows() == 0) return {};
  if (const auto* wrench = wrench_of(load); wrench && *wrench)
    complete(*wrench, factor, X, patch_of(load) ? e.patches.at(*patch_of(load)).area : e.volumes, force);
  return force;
}

/// Gravity on the masses of the nodes [N]; with `wrench_factor` times the wrench of the true body, if that is known.
NodalVectors weight_of(const Gravity& load, const Network& network, double density, double wrench_factor) {
  const Eigen::VectorXd volumes = volumes_by_mass(network);
  NodalVectors force = density * volumes * load.acceleration.transpose();
  if (wrench_factor != 0 && load.wrench) complete(*load.wrench, wrench_factor, network.X, volumes, force);
  return force;
}

/// Forces on the nodes of a network [N].
NodalVectors network_forces(const std::vector<Load>& loads, const Mesh& mesh, const Embedding& e,
                            const Network& network, double density, double factor) {
  NodalVectors external = NodalVectors::Zero(e.weights.cols(), 3);
  std::vector<Load> on_mesh;
  for (const Load& load : loads) {
    const auto* gravity = std::get_if<Gravity>(&load);
    const bool of_densities = e.patches.empty() && !network.cells.relative_densities.empty();
    if (gravity && (e.free_fall || of_densities))
      external += weight_of(*gravity, network, factor * density, e.free_fall ? 0 : factor);
    else if (const auto forces = e.patches.empty() ? std::nullopt : true_forces(load, e, network.X, density, factor))
      external += *forces;
    else
      on_mesh.push_back(load);
  }
  return external + e.weights.transpose() * mesh_forces(on_mesh, mesh, density, factor);
}

}  // namespace

BoundaryConditions transfer(const std::vector<Load>& loads, const Mesh& mesh, double density, Kinematics kinematics,
                            double factor) {
  BoundaryConditions bc = nothing(mesh.nodes.rows());
  for_each(loads, [&](const Load& load, int number) {
    if (prescribes_displacement(load))
      prescribe(load, number, nodes_of(patch(mesh, *patch_of(load))), mesh.nodes, kinematics, factor, bc);
  });
  divide_shared(
      loads, [&](const std::string& name) { return nodal_areas(mesh, patch(mesh, name)); }, bc);
  bc.external = mesh_forces(loads, mesh, density, factor);
  return bc;
}

BoundaryConditions transfer(const std::vector<Load>& loads, const Mesh& mesh, const Embedding& embedding,
                            const Network& network, double density, Kinematics kinematics, double factor) {
  BoundaryConditions bc = nothing(network.nodes());
  for_each(loads, [&](const Load& load, int number) {
    if (!prescribes_displacement(load)) return;
    const std::vector<int>& held = embedding.held.at(patch(mesh, *patch_of(load)).name);
    if (held.empty())
      throw std::invalid_argument(fmt::format(
          "no node of the network is near enough to patch '{}' to be held; choose a larger grip", *patch_of(load)));
    prescribe(load, number, held, network.X, kinematics, factor, bc);
  });
  const auto area_at = [&](const std::string& name) -> Eigen::VectorXd {
    const auto known = embedding.patches.find(name);
    if (known != embedding.patches.end()) return known->second.area;
    return embedding.weights.transpose() * nodal_areas(mesh, patch(mesh, name));
  };
  divide_shared(loads, area_at, bc);
  bc.external = network_forces(loads, mesh, embedding, network, density, factor);
  hand_back(network.cells.carried, bc.external);
  if (!network.triangles.empty())
    for (int n = 0; n < network.nodes(); ++n) bc.fixed[3 * n + 2] = 1;
  return bc;
}

namespace {

/// The rigid motion that the fixed unknowns constrain least; nothing if they constrain all six.
std::optional<Eigen::Matrix<double, 6, 1>> free_motion(const BoundaryConditions& bc, const RigidMotions& rigid) {
  const auto motions = free_motions(bc.fixed, rigid);
  if (motions.cols() == 0) return {};
  return motions.col(0);
}

}  // namespace

void attach(const std::vector<AttachedMass>& masses, const Mesh& mesh, const Embedding& embedding, Network& network) {
  network.attached = {};
  if (masses.empty()) return;
  network.attached = Eigen::VectorXd::Zero(network.nodes());
  for (const AttachedMass& mass : masses) try {
      const Eigen::VectorXd force =
          network_forces(loads_of(mass, Vec3::UnitX()), mesh, embedding, network, 0, 1).col(0);
      const Eigen::VectorXd share = force.cwiseMax(0);
      network.attached += mass.mass / share.sum() * share;
    } catch (const InputError& e) {
      throw InputError(fmt::format("mass '{}': {}", mass.name, e.what()));
    }
  hand_back(network.cells.carried, network.attached, 1);
}

void require_supported(const BoundaryConditions& bc, const NodalVectors& X) {
  const auto motion = free_motion(bc, {X});
  if (!motion) return;
  static const char* names[6] = {"translation along x", "translation along y", "translation along z",
                                 "rotation about x",    "rotation about y",    "rotation about z"};
  int dominant = 0;
  motion->cwiseAbs().maxCoeff(&dominant);
  const bool any = std::find(bc.fixed.begin(), bc.fixed.end(), 1) != bc.fixed.end();
  throw InputError(fmt::format(
      "the body is not held: the loads leave a rigid motion free ({}); prescribe displacements that prevent it",
      any ? names[dominant] : "all six"));
}

void hold_free_motions(const NodalVectors& X, BoundaryConditions& bc, const std::vector<CarriedPoint>& carried) {
  const RigidMotions rigid{X};
  std::vector<char> follows(bc.fixed.size(), 0);
  for (const CarriedPoint& p : carried) std::fill_n(follows.begin() + 3 * p.point, 3, 1);
  while (const auto motion = free_motion(bc, rigid)) {
    int best = 0;
    double most = -1;
    for (int i = 0; i < static_cast<int>(bc.fixed.size()); ++i)
      if (const double moved = std::abs(rigid.at(i).dot(*motion)); !bc.fixed[i] && !follows[i] && moved > most + 1e-9) {
        most = moved;
        best = i;
      }
    bc.fixed[best] = 1;
  }
}

std::set<std::string> patches_sharing_supports(const std::vector<Load>& loads, const Mesh& mesh,
                                               Kinematics kinematics) {
  std::set<std::string> sharing;
  std::map<int, std::string> first;
  for (const Load& load : loads) {
    if (!prescribes_displacement(load)) continue;
    const std::string& name = *patch_of(load);
    for (int node : nodes_of(patch(mesh, name))) {
      const PrescribedValue value = prescribed_displacement(load, mesh.nodes.row(node).transpose(), kinematics);
      for (int d = 0; d < 3; ++d) {
        if (!value[d]) continue;
        const std::string& other = first.emplace(3 * node + d, name).first->second;
        if (other != name) sharing.insert({name, other});
      }
    }
  }
  return sharing;
}

std::vector<PatchReaction> patch_reactions(const std::vector<Load>& loads, const Mesh& mesh, const NodalVectors& X,
                                           const BoundaryConditions& bc, const NodalVectors& support,
                                           const NodalVectors& displacement, Kinematics kinematics) {
  std::vector<PatchReaction> reactions;
  std::vector<Vec3> centres;
  std::vector<std::size_t> of_load(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (!prescribes_displacement(loads[i])) continue;
    const Patch& p = patch(mesh, *patch_of(loads[i]));
    const auto known =
        std::find_if(reactions.begin(), reactions.end(), [&](const PatchReaction& r) { return r.patch == p.name; });
    of_load[i] = static_cast<std::size_t>(known - reactions.begin());
    if (known != reactions.end()) continue;
    reactions.push_back({p.name, Vec3::Zero(), Vec3::Zero()});
    centres.push_back(centroid(mesh, p));
  }
  std::vector<double> of_owner(bc.fixed.size(), 1);
  const auto add = [&](int load, int unknown, double share) {
    const int node = unknown / 3, d = unknown % 3;
    const Vec3 force = share * support(node, d) * Vec3::Unit(d);
    Vec3 arm = X.row(node).transpose() - centres[of_load[load]];
    if (kinematics == Kinematics::finite) arm += displacement.row(node).transpose();
    reactions[of_load[load]].force += force;
    reactions[of_load[load]].torque += arm.cross(force);
  };
  for (const SharedUnknown& s : bc.shared) {
    add(s.load, s.unknown, s.share);
    of_owner[s.unknown] -= s.share;
  }
  for (int i = 0; i < static_cast<int>(bc.owner.size()); ++i)
    if (const int load = bc.owner[i]; load >= 0 && load < static_cast<int>(loads.size())) add(load, i, of_owner[i]);
  return reactions;
}

}  // namespace springproof
