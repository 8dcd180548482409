#include "fem_reference/system/boundary_conditions.h"

#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools.h>
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "fem_reference/grid/processes.h"
#include "fem_reference/system/sample.h"
#include "problem/exact_field.h"
#include "problem/system/input_error.h"

namespace springproof::fem {
namespace {

using dealii::types::boundary_id;

Vec3 vec(const dealii::Point<3>& X) { return {X[0], X[1], X[2]}; }

bool on_patch(const Body3& body, const std::string& patch, boundary_id id) {
  return body.patches.at(patch).count(id) > 0;
}

// Indices of the loads that prescribe displacement on the faces of each boundary id.
std::map<boundary_id, std::vector<int>> prescribing_loads(const Body3& body, const std::vector<Load>& loads) {
  std::map<boundary_id, std::vector<int>> by_id;
  for (std::size_t l = 0; l < loads.size(); ++l)
    if (prescribes_displacement(loads[l]))
      for (const boundary_id id : body.patches.at(*patch_of(loads[l]))) by_id[id].push_back(int(l));
  return by_id;
}

// FE_SimplexP reports support on every face for every shape function, so the support point decides.
bool lives_on_face(const dealii::FiniteElement<3>& fe, unsigned int i, unsigned int face) {
  if (!fe.reference_cell().is_simplex()) return fe.has_support_on_face(i, face);
  const dealii::Point<3> X = fe.unit_support_point(i);
  const std::array<double, 4> away = {X[2], X[1], X[0], 1 - X[0] - X[1] - X[2]};
  return std::abs(away[face]) < 1e-10;
}

bool is_known(const dealii::DoFHandler<3>::active_cell_iterator& cell) { return !cell->is_artificial(); }
bool is_known(const dealii::DoFHandler<3>::level_cell_iterator& cell) { return !cell->is_artificial_on_level(); }

// Calls visit(cell, load, i, component, X) for every prescribed shape function i on active or level cells.
template <typename Cells, typename Visit>
void for_each_prescribed(const Cells& cells, const Body3& body, const std::vector<Load>& loads, const Visit& visit) {
  const auto by_id = prescribing_loads(body, loads);
  for (const auto& cell : cells) {
    if (!is_known(cell)) continue;
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary()) continue;
      const auto found = by_id.find(cell->face(f)->boundary_id());
      if (found == by_id.end()) continue;
      const auto& fe = cell->get_fe();
      for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i) {
        if (!lives_on_face(fe, i, f)) continue;
        const int component = fe.system_to_component_index(i).first;
        const Vec3 X = vec(body.mapping->transform_unit_to_real_cell(cell, fe.unit_support_point(i)));
        for (const int l : found->second)
          if (prescribed_displacement(loads[l], X, Kinematics::linear)[component]) visit(cell, l, i, component, X);
      }
    }
  }
}

// Integrates force(q) against the shape functions of one cell or face.
template <typename Values, typename Cell, typename Force>
void add_integral(const Values& values, const Cell& cell, const Force& force, DofVector& load) {
  const auto& fe = cell->get_fe();
  const auto dofs = dofs_in(cell, cell->get_dof_handler());
  for (const unsigned int q : values.quadrature_point_indices()) {
    const Vec3 weighted = values.JxW(q) * force(q);
    for (unsigned int i = 0; i < dofs.size(); ++i)
      load[dofs[i]] += values.shape_value(i, q) * weighted[fe.system_to_component_index(i).first];
  }
}

// Calls visit(cell, face_values) on every face of a patch on a locally owned cell.
template <typename Visit>
void for_each_face(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const std::string& patch,
                   const Visit& visit) {
  const auto& fe = dof_handler.get_fe();
  dealii::FEFaceValues<3> values(*body.mapping, fe, face_quadrature(body, fe.degree + 1),
                                 dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points |
                                     dealii::update_normal_vectors);
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary() && on_patch(body, patch, cell->face(f)->boundary_id())) {
        values.reinit(cell, f);
        visit(cell, values);
      }
  }
}

struct PatchGeometry {
  double area = 0;
  Vec3 centroid = Vec3::Zero();
};

PatchGeometry patch_geometry(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const std::string& patch) {
  PatchGeometry geometry;
  for_each_face(dof_handler, body, patch, [&](const auto&, const auto& values) {
    for (const unsigned int q : values.quadrature_point_indices()) {
      geometry.area += values.JxW(q);
      geometry.centroid += values.JxW(q) * vec(values.quadrature_point(q));
    }
  });
  const MPI_Comm comm = dof_handler.get_communicator();
  geometry.area = dealii::Utilities::MPI::sum(geometry.area, comm);
  sum_over_processes(geometry.centroid, comm);
  if (geometry.area > 0) geometry.centroid /= geometry.area;
  return geometry;
}

// Calls visit(cell, values) on every locally owned cell.
template <typename Visit>
void for_each_cell(const dealii::DoFHandler<3>& dof_handler, const Body3& body, unsigned int quadrature_points,
                   const Visit& visit) {
  dealii::FEValues<3> values(*body.mapping, dof_handler.get_fe(), cell_quadrature(body, quadrature_points),
                             dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    visit(cell, values);
  }
}

// The load vector, or what of it acts on cells of one material.
struct LoadOn {
  DofVector load;
  std::optional<unsigned int> material;
  bool takes(const auto& cell) const { return !material || cell->material_id() == *material; }
};

// Adds force(values, q), per area or volume, over a region: region(visit) calls visit(cell, values).
template <typename Region, typename Force>
void add_force(const Region& region, const Force& force, LoadOn& to) {
  region([&](const auto& cell, const auto& values) {
    if (!to.takes(cell)) return;
    add_integral(
        values, cell, [&](unsigned int q) { return force(values, q); }, to.load);
  });
}

// Adds the rigid field that, together with `force` (added elsewhere), has the given resultant.
template <typename Region, typename Force>
void complete(const Region& region, const Force& force, const std::optional<Wrench>& wrench, MPI_Comm comm,
              LoadOn& to) {
  if (!wrench) return;
  RegionMoments moments;
  Wrench own{Vec3::Zero(), Vec3::Zero(), wrench->about};
  region([&](const auto&, const auto& values) {
    for (const unsigned int q : values.quadrature_point_indices()) {
      const Vec3 X = vec(values.quadrature_point(q)), f = values.JxW(q) * force(values, q);
      moments.add(values.JxW(q), X);
      own.force += f;
      own.moment += (X - own.about).cross(f);
    }
  });
  moments.measure = dealii::Utilities::MPI::sum(moments.measure, comm);
  sum_over_processes(moments.first, comm);
  sum_over_processes(moments.second, comm);
  sum_over_processes(own.force, comm);
  sum_over_processes(own.moment, comm);
  const Wrench missing{wrench->force - own.force, wrench->moment - own.moment, wrench->about};
  const RigidField field = rigid_field(moments, missing);
  add_force(
      region, [&](const auto& values, unsigned int q) { return field.at(vec(values.quadrature_point(q))); }, to);
}

void add_point_force(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const PointForce& point, LoadOn& to) {
  const Location place = locate(body, point.at.transpose()).front();
  if (!place.answers || !to.takes(place.cell)) return;
  const auto& fe = dof_handler.get_fe();
  const auto dofs = dofs_in(place.cell, dof_handler);
  for (unsigned int i = 0; i < dofs.size(); ++i)
    to.load[dofs[i]] += fe.shape_value(i, place.unit) * point.force[fe.system_to_component_index(i).first];
}

}  // namespace

void check_patches(const Body3& body, const std::vector<Load>& loads) {
  for (const Load& load : loads) {
    const std::string* name = patch_of(load);
    if (!name) continue;
    const auto found = body.patches.find(*name);
    if (found != body.patches.end() && !found->second.empty()) continue;
    std::string known;
    for (const auto& [patch, ids] : body.patches)
      if (!ids.empty()) known += (known.empty() ? "" : ", ") + patch;
    throw InputError(fmt::format("no patch \"{}\" on this body; there are: {}", *name, known));
  }
}

std::vector<Prescribed> prescribed(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                   const std::vector<Load>& loads) {
  std::map<unsigned int, Prescribed> by_dof;
  std::vector<dealii::types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
  const auto [low, high] = dealii::GridTools::compute_bounding_box(body.triangulation).get_boundary_points();
  const double size = dealii::Utilities::MPI::max(low.distance(high), dof_handler.get_communicator());
  const auto value = [&](const Prescribed& p) {
    return *prescribed_displacement(loads[p.load()], p.X, Kinematics::linear)[p.component];
  };
  const auto add = [&](const auto& cell, int l, unsigned int i, int component, const Vec3& X) {
    cell->get_dof_indices(dofs);
    const Prescribed p{unsigned(dofs[i]), component, {l}, X};
    const auto [at, is_new] = by_dof.try_emplace(p.dof, p);
    Prescribed& first = at->second;
    if (std::abs(value(p) - value(first)) > 1e-9 * size)
      throw InputError(
          fmt::format("patches \"{}\" and \"{}\" prescribe different {}-displacements, {:.6g} m "
                      "and {:.6g} m, at ({:.6g}, {:.6g}, {:.6g})",
                      *patch_of(loads[first.load()]), *patch_of(loads[l]), "xyz"[component], value(first), value(p),
                      X[0], X[1], X[2]));
    first.loads.insert(l);
  };
  together([&] { for_each_prescribed(dof_handler.active_cell_iterators(), body, loads, add); });
  std::vector<Prescribed> all;
  for (const auto& [dof, p] : by_dof) all.push_back(p);
  return all;
}

std::vector<dealii::IndexSet> prescribed_on_levels(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                                   const std::vector<Load>& loads) {
  std::vector<dealii::IndexSet> sets;
  std::vector<dealii::types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
  for (unsigned int level = 0; level < dof_handler.get_triangulation().n_global_levels(); ++level) {
    std::set<dealii::types::global_dof_index> found;
    const auto add = [&](const auto& cell, int, unsigned int i, int, const Vec3&) {
      cell->get_mg_dof_indices(dofs);
      found.insert(dofs[i]);
    };
    if (level < dof_handler.get_triangulation().n_levels())
      for_each_prescribed(dof_handler.mg_cell_iterators_on_level(level), body, loads, add);
    dealii::IndexSet set(dof_handler.n_dofs(level));
    set.add_indices(found.begin(), found.end());
    set.compress();
    sets.push_back(set);
  }
  return sets;
}

void check_held(const std::vector<Prescribed>& prescribed, MPI_Comm comm) {
  const char* help = "prescribe displacement on more patches or components";
  const auto count = dealii::Utilities::MPI::sum(double(prescribed.size()), comm);
  if (count == 0) throw InputError(fmt::format("the body is not held anywhere: {}", help));
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Prescribed& p : prescribed) {
    low = low.cwiseMin(p.X);
    high = high.cwiseMax(p.X);
  }
  for (int c = 0; c < 3; ++c) {
    low[c] = dealii::Utilities::MPI::min(low[c], comm);
    high[c] = dealii::Utilities::MPI::max(high[c], comm);
  }
  const Vec3 middle = (low + high) / 2;
  const double length = std::max((high - low).norm() / 2, 1e-300);
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Matrix6 gram = Matrix6::Zero();
  for (const Prescribed& p : prescribed) {
    Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
    row[p.component] = 1;
    for (int k = 0; k < 3; ++k) row[3 + k] = Vec3::Unit(k).cross((p.X - middle) / length)[p.component];
    gram += row * row.transpose() / count;
  }
  sum_over_processes(gram, comm);
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(gram);
  if (eigen.eigenvalues()[0] > 1e-10) return;
  const auto free = eigen.eigenvectors().col(0);
  const bool turns = free.tail<3>().norm() > free.head<3>().norm();
  const Vec3 along = (turns ? free.tail<3>() : free.head<3>()).normalized();
  throw InputError(fmt::format("the body is not held: it can still {} ({:.3g}, {:.3g}, {:.3g}); {}",
                               turns ? "turn about" : "move along", along[0], along[1], along[2], help));
}

DofVector load_vector(const dealii::DoFHandler<3>& dof_handler, const Body3& body, const GridProblem& problem,
                      double time, std::optional<unsigned int> material) {
  LoadOn to{zero_vector(dof_handler), material};
  const unsigned int points = dof_handler.get_fe().degree + 1;
  const MPI_Comm comm = dof_handler.get_communicator();
  const auto over_patch = [&](const std::string& patch) {
    return [&](const auto& visit) { for_each_face(dof_handler, body, patch, visit); };
  };
  const auto over_body = [&](unsigned int n) {
    return [&, n](const auto& visit) { for_each_cell(dof_handler, body, n, visit); };
  };
  const auto add = [&](const auto& region, const auto& force, const std::optional<Wrench>& wrench) {
    add_force(region, force, to);
    complete(region, force, wrench, comm, to);
  };
  const auto add_field = [&](const std::function<Vec3(const Vec3&)>& f) {
    add_force(
        over_body(std::min(points + 2, 4u)),
        [&](const auto& values, unsigned int q) { return f(vec(values.quadrature_point(q))); }, to);
  };
  for (const Load& l : problem.loads) {
    if (const auto* traction = std::get_if<Traction>(&l))
      add(
          over_patch(traction->on), [&](const auto&, unsigned int) { return traction->traction; }, traction->wrench);
    if (const auto* pressure = std::get_if<Pressure>(&l))
      add(
          over_patch(pressure->on),
          [&](const auto& values, unsigned int q) -> Vec3 {
            const dealii::Tensor<1, 3> n = values.normal_vector(q);
            return -pressure->pressure * Vec3(n[0], n[1], n[2]);
          },
          pressure->wrench);
    if (const auto* total = std::get_if<PatchForce>(&l)) {
      const Vec3 traction = total->force / patch_geometry(dof_handler, body, total->on).area;
      add(
          over_patch(total->on), [&](const auto&, unsigned int) { return traction; }, total->wrench);
    }
    if (const auto* gravity = std::get_if<Gravity>(&l))
      add(
          over_body(points),
          [&](const auto& values, unsigned int) -> Vec3 {
            return problem.material_of(values.get_cell()->material_id()).density * gravity->acceleration;
          },
          gravity->wrench);
    if (const auto* field = std::get_if<FieldBodyForce>(&l))
      add_field([&](const Vec3& X) { return exact_body_force(field->field, X, problem.material); });
    if (const auto* point = std::get_if<PointForce>(&l)) add_point_force(dof_handler, body, *point, to);
  }
  if (problem.body_force) add_field([&](const Vec3& X) { return problem.body_force(X, time); });
  to.load.compress(dealii::VectorOperation::add);
  return to.load;
}

namespace {

// Integrals of the shape functions over the patches; empty if no degree of freedom is prescribed by two loads.
std::vector<DofVector> areas_of_patches(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                        const std::vector<PatchReaction>& patches,
                                        const std::vector<Prescribed>& prescribed) {
  std::vector<DofVector> areas;
  const bool shared =
      std::any_of(prescribed.begin(), prescribed.end(), [](const auto& p) { return p.loads.size() > 1; });
  if (!dealii::Utilities::MPI::max(int(shared), dof_handler.get_communicator())) return areas;
  for (const PatchReaction& of : patches) {
    LoadOn ones{zero_vector(dof_handler), {}};
    add_force([&](const auto& visit) { for_each_face(dof_handler, body, of.patch, visit); },
              [](const auto&, unsigned int) -> Vec3 { return Vec3::Ones(); }, ones);
    ones.load.compress(dealii::VectorOperation::add);
    areas.push_back(std::move(ones.load));
    const double round_off = 1e-12 * areas.back().linfty_norm();
    for (double& area : areas.back()) area = std::abs(area) > round_off ? std::abs(area) : 0;
  }
  return areas;
}

// Quadratic triangles have none at their vertices.
void divide_by_areas(const std::vector<DofVector>& areas, unsigned int dof, std::map<int, double>& share) {
  double all = 0;
  for (const auto& [r, part] : share) all += areas[r][dof];
  for (auto& [r, part] : share) part = all > 0 ? areas[r][dof] / all : 1.0 / static_cast<double>(share.size());
}

}  // namespace

std::vector<PatchReaction> reactions(const dealii::DoFHandler<3>& dof_handler, const Body3& body,
                                     const std::vector<Load>& loads, const std::vector<Prescribed>& prescribed,
                                     const DofVector& imbalance, const DofVector* arm) {
  std::vector<PatchReaction> all;
  std::vector<Vec3> centroids;
  std::vector<int> reaction_of_load(loads.size(), -1);
  for (std::size_t l = 0; l < loads.size(); ++l) {
    if (!prescribes_displacement(loads[l])) continue;
    const std::string& patch = *patch_of(loads[l]);
    const auto same = std::find_if(all.begin(), all.end(), [&](const auto& r) { return r.patch == patch; });
    reaction_of_load[l] = int(same - all.begin());
    if (same != all.end()) continue;
    all.push_back({patch, Vec3::Zero(), Vec3::Zero()});
    centroids.push_back(patch_geometry(dof_handler, body, patch).centroid);
  }
  const std::vector<DofVector> areas = areas_of_patches(dof_handler, body, all, prescribed);
  for (const Prescribed& p : prescribed) {
    const Vec3 force = imbalance[p.dof] * Vec3::Unit(p.component);
    Vec3 x = p.X;
    // FE_Q systems number the three components of a support point one after the other.
    if (arm)
      for (int c = 0; c < 3; ++c) x[c] += (*arm)[p.dof - p.component + c];
    std::map<int, double> share;  // of a reaction
    for (const int l : p.loads) share[reaction_of_load[l]] = 1;
    if (share.size() > 1) divide_by_areas(areas, p.dof, share);
    for (const auto& [r, part] : share) {
      all[r].force += part * force;
      all[r].torque += part * (x - centroids[r]).cross(force);
    }
  }
  for (PatchReaction& r : all) {
    sum_over_processes(r.force, dof_handler.get_communicator());
    sum_over_processes(r.torque, dof_handler.get_communicator());
  }
  return all;
}

}  // namespace springproof::fem
