// springproof-lattice: the block lattice of a case file on several processes, each with a slab of it.
#include <fmt/format.h>
#include <petsc.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/parallel/slab_multigrid.h"
#include "problem/case_file/experiment.h"
#include "problem/system/input_error.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

struct Options {
  std::string case_file, model = "hybmss", json_file;
  std::optional<std::array<int, 3>> cells;
  std::optional<double> poisson_ratio;
  double tolerance = 1e-10;
  long steps = 0;      ///< > 0: explicit steps instead of equilibrium
  double damping = 0;  ///< [1/s]
};

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

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

void check_case(const Experiment& e, const std::array<int, 3>& cells) {
  if (e.body.geo != "block.geo")
    throw InputError(
        fmt::format("{}: geo = \"{}\": only block.geo can be shared out in slabs", e.file.string(), e.body.geo));
  for (const Load& load : e.loads)
    if (std::holds_alternative<PatchForce>(load) || std::holds_alternative<PointForce>(load))
      throw InputError(
          fmt::format("{}: a force that is spread over a patch or acts at a point is not shared out (allowed: "
                      "displacements, rotations, traction_Pa, pressure_Pa, gravity_m_s2)",
                      e.file.string()));
  const Vec3 edge = e.body.size.cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));
  if ((edge.array() - edge[0]).abs().maxCoeff() > 1e-6 * edge[0])
    throw InputError(fmt::format("{} x {} x {} cells of a block of {:.6g} x {:.6g} x {:.6g} m are no cubes", cells[0],
                                 cells[1], cells[2], e.body.size[0], e.body.size[1], e.body.size[2]));
}

/// The stiffness of one cell of the model.
CellMatrix one_cell(const ModelParameters& model, double edge, const IsotropicMaterial& material) {
  if (model.row.topology != Topology::cells || model.has(Extension::momentum_dispersion))
    throw InputError(
        fmt::format("model \"{}\" is no lattice of cells (allowed: hybmss and its variants, msm_14, msm_18, msm_26)",
                    model.row.name));
  return cell_stiffness(build_model(model, block_mesh(Vec3::Constant(edge), {1, 1, 1}), material)).total;
}

/// Runs step(); an InputError of any process is thrown by all.
template <class Step>
void agree(const std::string& file, MPI_Comm communicator, Step step) {
  std::string message;
  try {
    step();
  } catch (const InputError& e) {
    message = e.what();
  }
  int rank, length = static_cast<int>(message.size());
  MPI_Comm_rank(communicator, &rank);
  struct {
    int length, rank;
  } own{length, rank}, worst;
  MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MAXLOC, communicator);
  if (worst.length == 0) return;
  message.resize(worst.length);
  MPI_Bcast(message.data(), worst.length, MPI_CHAR, worst.rank, communicator);
  throw InputError(file + ": " + message);
}

struct Sum {
  MPI_Comm communicator;
  double operator()(double own) const {
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_SUM, communicator);
    return own;
  }
  double largest(double own) const {
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_MAX, communicator);
    return own;
  }
};

/// Case data that every process needs before its slab is built.
struct BlockCase {
  Experiment experiment;
  std::array<int, 3> cells;
  IsotropicMaterial material;
  ModelParameters model;
};

BlockCase read_case(const Options& options) {
  BlockCase c{read_experiment(options.case_file), {}, {}, {}};
  c.cells = options.cells.value_or(c.experiment.body.cells.empty() ? Cells{0, 0, 0} : c.experiment.body.cells.back());
  check_case(c.experiment, c.cells);
  c.material = c.experiment.materials.front();
  if (options.poisson_ratio) c.material.poisson_ratio = *options.poisson_ratio;
  ModelChoice choice;
  choice.name = options.model;
  c.model = resolve(choice);
  return c;
}

/// Results common to all runs.
nlohmann::json describe(const Options& options, const BlockCase& c, MPI_Comm communicator) {
  int processes;
  MPI_Comm_size(communicator, &processes);
  return {{"processes", processes},
          {"cells", c.cells},
          {"poisson_ratio", c.material.poisson_ratio},
          {"model", options.model}};
}

nlohmann::json solve_static(const Options& options, MPI_Comm communicator) {
  const BlockCase c = read_case(options);
  const CellMatrix cell = one_cell(c.model, c.experiment.body.size[0] / c.cells[0], c.material);
  const double start = seconds();
  const SlabPartition partition(c.cells, communicator);
  const SlabLevel slab = partition.level(0, communicator);
  const Mesh mesh = slab_mesh(c.experiment.body.size, c.cells, slab.lattice);
  BoundaryConditions bc;
  agree(options.case_file, communicator,
        [&] { bc = transfer(c.experiment.loads, mesh, c.material.density, Kinematics::linear); });
  SlabMultigrid multigrid(partition, bc.fixed, cell, communicator);
  const double set_up = seconds() - start;

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
  const double solve_start = seconds();
  const KrylovResult k = multigrid.solve(b, options.tolerance, 1000, du);
  const double solve = seconds() - solve_start;
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
  nlohmann::json result = describe(options, c, communicator);
  result.update({{"converged", k.converged},
                 {"unknowns", values - sum(fixed)},
                 {"iterations", k.iterations},
                 {"residual", k.residual},
                 {"set_up_seconds", sum.largest(set_up)},
                 {"solve_seconds", sum.largest(solve)},
                 {"MiB_per_process", sum.largest(peak_memory_MiB())},
                 {"displacement_rms_m", std::sqrt(sum(square) / values)}});
  for (std::size_t i = 0; i < support.size(); ++i) {
    for (int a = 0; a < 3; ++a) support[i][a] = sum(support[i][a]);
    if (prescribes_displacement(c.experiment.loads[i]))
      result["support_N"].push_back(
          {{"patch", *patch_of(c.experiment.loads[i])}, {"force", {support[i][0], support[i][1], support[i][2]}}});
  }
  return result;
}

/// Explicit steps of the loaded block from rest, the supports moved at once; positions and velocities of the planes
/// beside a slab come from their owners after every step.
nlohmann::json move(const Options& options, MPI_Comm communicator) {
  const BlockCase c = read_case(options);
  const double start = seconds();
  const SlabPartition partition(c.cells, communicator);
  const SlabLevel slab = partition.level(0, communicator);
  const Mesh mesh = slab_mesh(c.experiment.body.size, c.cells, slab.lattice);
  const MassSpringModel model = build_model(c.model, mesh, c.material);
  if (!LatticeMotion::suits(model)) throw InputError(fmt::format("model \"{}\" has no lattice kernel", options.model));
  BoundaryConditions bc;
  agree(options.case_file, communicator,
        [&] { bc = transfer(c.experiment.loads, mesh, c.material.density, Kinematics::finite); });
  const Sum sum{communicator};
  const double dt = -sum.largest(-0.95 * safe_time_step(model, c.material.density));
  LatticeMotion motion(model, c.material.density);
  motion.set_conditions(bc);
  motion.move_supports();
  PlaneExchange neighbours(slab, communicator);
  const double set_up = seconds() - start;
  const double loop_start = seconds();
  for (long n = 0; n < options.steps; ++n) {
    motion.advance(1, dt, options.damping);
    neighbours.complete(motion);
  }
  const double loop = seconds() - loop_start;
  const NodalVectors u = motion.positions() - model.network.X, v = motion.velocities();
  double square = 0, energy = 0;
  const Eigen::VectorXd m = masses(model.network, c.material.density);
  for (long n = slab.own_first(); n < slab.own_first() + slab.own_points(); ++n) {
    square += u.row(n).squaredNorm();
    energy += 0.5 * m[n] * v.row(n).squaredNorm();
  }
  nlohmann::json result = describe(options, c, communicator);
  const double values = sum(3.0 * static_cast<double>(slab.own_points()));
  result.update({{"converged", std::isfinite(square)},
                 {"unknowns", values},
                 {"steps", options.steps},
                 {"time_step_s", dt},
                 {"set_up_seconds", sum.largest(set_up)},
                 {"solve_seconds", sum.largest(loop)},
                 {"MiB_per_process", sum.largest(peak_memory_MiB())},
                 {"displacement_rms_m", std::sqrt(sum(square) / values)},
                 {"kinetic_energy_J", sum(energy)}});
  return result;
}

void print(const nlohmann::json& r) {
  fmt::print("{} on {} x {} x {} cells, nu = {}: {:.0f} unknowns, {} process{}\n", r["model"].get<std::string>(),
             r["cells"][0].get<int>(), r["cells"][1].get<int>(), r["cells"][2].get<int>(),
             r["poisson_ratio"].get<double>(), r["unknowns"].get<double>(), r["processes"].get<int>(),
             r["processes"] == 1 ? "" : "es");
  if (r.contains("steps"))
    fmt::print("{} steps of {:.3g} s\n", r["steps"].get<long>(), r["time_step_s"].get<double>());
  else
    fmt::print("{} iterations, residual {:.2e}{}\n", r["iterations"].get<int>(), r["residual"].get<double>(),
               r["converged"].get<bool>() ? "" : ": NOT CONVERGED");
  fmt::print("set-up {:.3f} s, then {:.3f} s, {:.0f} MiB per process\n", r["set_up_seconds"].get<double>(),
             r["solve_seconds"].get<double>(), r["MiB_per_process"].get<double>());
  fmt::print("displacement, root mean square: {:.12e} m\n", r["displacement_rms_m"].get<double>());
  if (r.contains("kinetic_energy_J"))
    fmt::print("kinetic energy of this displacement: {:.12e} J\n", r["kinetic_energy_J"].get<double>());
  for (const auto& s : r.value("support_N", nlohmann::json::array()))
    fmt::print("force of {}: ({:.12e}, {:.12e}, {:.12e}) N\n", s["patch"].get<std::string>(),
               s["force"][0].get<double>(), s["force"][1].get<double>(), s["force"][2].get<double>());
}

int parse_and_run(int argc, char** argv) {
  int rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  CLI::App app{
      "A block lattice on the processes of mpirun: linear static equilibrium (displacement form), or explicit steps.",
      "springproof-lattice"};
  Options options;
  app.add_option("CASE", options.case_file, "case file whose body is block.geo")->required()->check(CLI::ExistingFile);
  app.add_option("--cells", options.cells, "cubes along x, y, z instead of the case's");
  app.add_option("--poisson-ratio", options.poisson_ratio, "instead of the case's first")
      ->check(CLI::Range(-0.999, 0.4999));
  app.add_option("--model", options.model, "model of a lattice of cells")->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "relative residual")
      ->capture_default_str()
      ->check(CLI::Range(1e-13, 1e-2));
  app.add_option("--steps", options.steps, "so many explicit steps (large displacements) instead of equilibrium")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--damping", options.damping, "of explicit steps [1/s]")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--json", options.json_file, "write the result as JSON too");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return rank == 0 ? app.exit(e) : (e.get_exit_code() ? 2 : 0);
  }
  try {
    const nlohmann::json result = (options.steps > 0 ? move : solve_static)(options, PETSC_COMM_WORLD);
    if (rank > 0) return 0;
    print(result);
    if (!options.json_file.empty()) {
      std::ofstream out(options.json_file);
      out << result.dump(2) << "\n";
      if (!out.flush()) throw InputError("cannot write " + options.json_file);
    }
    return result["converged"].get<bool>() ? 0 : 1;
  } catch (const InputError& e) {
    if (rank == 0) fmt::print(stderr, "{}\n", e.what());
    return 2;
  } catch (const std::invalid_argument& e) {  // thrown by all processes alike, as is the next
    if (rank == 0) fmt::print(stderr, "{}: {}\n", options.case_file, e.what());
    return 2;
  } catch (const std::runtime_error& e) {
    if (rank == 0) fmt::print(stderr, "{}: {}\n", options.case_file, e.what());
    return 2;
  }
}

}  // namespace
}  // namespace springproof

int main(int argc, char** argv) {
  int none = 0;
  PetscInitialize(&none, nullptr, nullptr, nullptr);
  PetscPopSignalHandler();
  int status = 1;
  try {
    status = springproof::parse_and_run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "springproof-lattice: {}\n", e.what());
    MPI_Abort(PETSC_COMM_WORLD, 1);
  }
  PetscFinalize();
  return status;
}
