#include "comparisons/parallel/slab_run.h"

#include <fmt/format.h>

#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/parallel/petsc.h"
#include "msm/parallel/slab_multigrid.h"

namespace springproof {
namespace {

/// This process' slab of the block, with one plane of its neighbour's cells below; its patches are those of the whole
/// block.
Mesh slab_mesh(const Vec3& size, const std::array<int, 3>& cells, const LatticeLevel& slab) {
  const double edge = size[2] / cells[2];
  Mesh mesh = block_mesh({size[0], size[1], edge * slab.planes()}, {cells[0], cells[1], slab.planes()});
  const int first = slab.first_cell[2];
  mesh.nodes.col(2).array() += edge * first;
  mesh.grid->origin[2] = edge * first;
  for (Patch& p : mesh.patches)
    if ((p.name == "z_min" && first > 0) || (p.name == "z_max" && first + slab.planes() < cells[2])) p.facets.clear();
  return mesh;
}

/// The stiffness of one cell of the model.
CellMatrix one_cell(const ParallelCase& c) {
  const double edge = c.experiment.body.size[0] / c.cells[0];
  return cell_stiffness(build_model(c.model, block_mesh(Vec3::Constant(edge), {1, 1, 1}), c.material)).total;
}

/// The slab of this process, with the loads of the case.
struct Slab {
  SlabPartition partition;
  SlabLevel level;
  Mesh mesh;
  BoundaryConditions conditions;

  Slab(const ParallelCase& c, Kinematics kinematics, MPI_Comm communicator)
      : partition(c.cells, communicator),
        level(partition.level(0, communicator)),
        mesh(slab_mesh(c.experiment.body.size, c.cells, level.lattice)) {
    agree(communicator, [&] { conditions = transfer(c.experiment.loads, mesh, c.material.density, kinematics); });
  }
};

/// Displacement of a point in a cell whose lowest corner is this process', else zero; u: three arrays of `stride`.
Vec3 displacement_at(const Vec3& at, const ParallelCase& c, const Slab& slab, const Eigen::VectorXd& u) {
  const double edge = c.experiment.body.size[0] / c.cells[0];
  std::array<int, 3> cell;
  for (int d = 0; d < 3; ++d)
    cell[d] =
        std::clamp(static_cast<int>(std::floor(at[d] / edge)), 0, c.cells[d] - 1) - slab.level.lattice.first_cell[d];
  Vec3 sum = Vec3::Zero();
  if (cell[2] < slab.level.own_begin || cell[2] >= slab.level.own_end) return sum;
  const auto number = cell[0] + static_cast<std::size_t>(c.cells[0]) * (cell[1] + std::size_t(c.cells[1]) * cell[2]);
  for (const int n : slab.mesh.hexahedra[number]) {
    const Vec3 away = (at - slab.mesh.nodes.row(n).transpose()).cwiseAbs() / edge;
    for (int d = 0; d < 3; ++d) sum[d] += (1 - away.array()).prod() * u[d * slab.level.lattice.stride() + n];
  }
  return sum;
}

void check_probes(const ParallelCase& c) {
  for (const Probe& p : c.experiment.probes)
    if (!((p.at.array() >= 0).all() && (p.at.array() <= c.experiment.body.size.array()).all()))
      throw InputError(fmt::format("probe '{}': at_m: the point ({:.6g}, {:.6g}, {:.6g}) m lies outside the body",
                                   p.name, p.at[0], p.at[1], p.at[2]));
}

void add_vector(const std::string& name, const Vec3& v, nlohmann::json& measures) {
  for (int d = 0; d < 3; ++d) measures[name + '.' + "xyz"[d]] = v[d];
  measures[name + ".magnitude"] = v.norm();
}

}  // namespace

std::string why_no_slabs(const ParallelCase& c) {
  const Body& body = c.experiment.body;
  if (body.geo != "block.geo" || body.is_voxels()) return fmt::format("geo = \"{}\" is no full block", body.geo);
  const Vec3 edge = body.size.cwiseQuotient(Vec3(c.cells[0], c.cells[1], c.cells[2]));
  if ((edge.array() - edge[0]).abs().maxCoeff() > 1e-6 * edge[0])
    return fmt::format("{} x {} x {} cells of a block of {:.6g} x {:.6g} x {:.6g} m are no cubes", c.cells[0],
                       c.cells[1], c.cells[2], body.size[0], body.size[1], body.size[2]);
  if (c.model.row.topology != Topology::cells || c.model.has(Extension::momentum_dispersion))
    return fmt::format("model \"{}\" is no lattice of cells without momentum dispersion", c.model.row.name);
  if (c.model.hold_rigid_motions) return "hold_rigid_motions: a slab does not see the motions of the whole";
  for (const Load& load : c.experiment.loads)
    if (std::holds_alternative<PatchForce>(load) || std::holds_alternative<PointForce>(load))
      return "a force that is spread over a patch or acts at a point is not shared out";
  return {};
}

nlohmann::json solve_in_slabs(const ParallelCase& c, double tolerance, MPI_Comm communicator) {
  const double start = wall_seconds();
  agree(communicator, [&] { check_probes(c); });
  const Slab own(c, Kinematics::linear, communicator);
  const SlabLevel& slab = own.level;
  const BoundaryConditions& bc = own.conditions;
  SlabMultigrid multigrid(own.partition, bc.fixed, one_cell(c), communicator);
  const double set_up = wall_seconds() - start;

  const long stride = slab.lattice.stride(), points = slab.lattice.points();
  Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(3 * stride), external = prescribed, force, du;
  for (long n = 0; n < points; ++n)
    for (int a = 0; a < 3; ++a) {
      prescribed[a * stride + n] = bc.prescribed(n, a);
      external[a * stride + n] = bc.external(n, a);
    }
  multigrid.multiply(prescribed, force);
  Eigen::VectorXd b = external - force;
  multigrid.finest().lattice.clear_fixed(b);
  const double solve_start = wall_seconds();
  const KrylovResult k = multigrid.solve(b, tolerance, 1000, du);
  const double solve = wall_seconds() - solve_start;
  Eigen::VectorXd u = prescribed + du;
  multigrid.multiply(u, force);

  const Sum sum{communicator};
  std::vector<Vec3> support(c.experiment.loads.size(), Vec3::Zero());
  double square = 0, fixed = 0;
  for (long n = slab.own_first(); n < slab.own_first() + slab.own_points(); ++n)
    for (int a = 0; a < 3; ++a) {
      const long at = a * stride + n;
      square += u[at] * u[at];
      fixed += bc.fixed[3 * n + a];
      if (const int owner = bc.owner[3 * n + a]; owner >= 0) support[owner][a] += force[at] - external[at];
    }
  const double values = sum(3.0 * static_cast<double>(slab.own_points()));
  nlohmann::json result = {{"converged", k.converged},
                           {"unknowns", values - sum(fixed)},
                           {"solver", "CG + multigrid in slabs"},
                           {"iterations", k.iterations},
                           {"residual", k.residual},
                           {"set_up_seconds", sum.largest(set_up)},
                           {"solve_seconds", sum.largest(solve)},
                           {"MiB_per_process", sum.largest(peak_memory_MiB())},
                           {"displacement_rms_m", std::sqrt(sum(square) / values)},
                           {"measures", nlohmann::json::object()}};
  for (std::size_t i = 0; i < support.size(); ++i) {
    sum.all(support[i].data(), 3);
    if (prescribes_displacement(c.experiment.loads[i]))
      add_vector("force." + *patch_of(c.experiment.loads[i]), support[i], result["measures"]);
  }
  for (const Probe& p : c.experiment.probes) {
    Vec3 moved = displacement_at(p.at, c, own, u);
    sum.all(moved.data(), 3);
    add_vector("displacement." + p.name, moved, result["measures"]);
  }
  return result;
}

nlohmann::json move_in_slabs(const ParallelCase& c, long steps, double damping, MPI_Comm communicator) {
  const double start = wall_seconds();
  const Slab own(c, Kinematics::finite, communicator);
  const SlabLevel& slab = own.level;
  const MassSpringModel model = build_model(c.model, own.mesh, c.material);
  if (!LatticeMotion::suits(model))
    throw InputError(fmt::format("model \"{}\" has no lattice kernel", c.model.row.name));
  const Sum sum{communicator};
  const double dt = -sum.largest(-0.95 * safe_time_step(model, c.material.density));
  const auto motion = lattice_motion(model, c.material.density, {.time_step = dt, .damping = damping});
  motion->set_conditions(own.conditions);
  motion->move_supports();
  PlaneExchange neighbours(slab, communicator);
  const double set_up = wall_seconds() - start;
  const double loop_start = wall_seconds();
  for (long n = 0; n < steps; ++n) {
    motion->advance(1);
    neighbours.complete(*motion);
  }
  const double loop = wall_seconds() - loop_start;
  const NodalVectors u = motion->positions() - model.network.X, v = motion->velocities();
  double square = 0, energy = 0;
  const Eigen::VectorXd m = masses(model.network, c.material.density);
  for (long n = slab.own_first(); n < slab.own_first() + slab.own_points(); ++n) {
    square += u.row(n).squaredNorm();
    energy += 0.5 * m[n] * v.row(n).squaredNorm();
  }
  const double values = sum(3.0 * static_cast<double>(slab.own_points()));
  return {{"converged", std::isfinite(square)},
          {"unknowns", values},
          {"steps", steps},
          {"time_step_s", dt},
          {"set_up_seconds", sum.largest(set_up)},
          {"solve_seconds", sum.largest(loop)},
          {"MiB_per_process", sum.largest(peak_memory_MiB())},
          {"displacement_rms_m", std::sqrt(sum(square) / values)},
          {"measures", {{"kinetic_energy", sum(energy)}}}};
}

}  // namespace springproof
