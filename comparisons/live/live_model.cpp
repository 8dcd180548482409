#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "comparisons/live/live_body.h"
#include "meshes/materials.h"
#include "meshes/volume.h"
#include "msm/dynamics/time_step.h"
#include "msm/parameters/calibrate.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

constexpr double safety = 0.9;          // share of the safe step at rest
constexpr int steps_per_kick = 2;       // the grip's force is renewed so often
constexpr double grip_reach = 1.6;      // cubes
constexpr double stiffest_step = 0.1;   // share of the step below which a squeezed cell is not followed
constexpr double stiffest_grip = 0.25;  // of its (frequency * step)^2, which is unstable from 4 on without the body
constexpr double most_caution = 1.0 / 64;
constexpr double widest = 8;  // stretch of a cell's mean edge that no pull reaches: the motion has become unstable

ModelParameters parameters_of(const std::string& name) {
  for (const ModelRow& row : model_table())
    if (row.name == name && row.topology == Topology::cells && can(row, Capability::large_displacements)) {
      ModelParameters p;
      p.row = row;
      p.face_to_cube = row.face_to_cube;
      return p;
    }
  throw InputError(name + ": no model of the cells of a lattice at large displacement");
}

/// The model of the table on the cubes of a mesh, by the same functions as build_embedded().
MassSpringModel model_of(const Mesh& mesh, const std::string& name, const IsotropicMaterial& material) {
  require_one_material(mesh);
  ModelParameters p = parameters_of(name);
  MassSpringModel model;
  model.network = cubic_lattice(mesh, p.has(Extension::averaging) ? CubicPattern{} : isotropic_pattern(p.face_to_cube));
  if (p.has(Extension::averaging)) {
    model.laws = {averaged_law(p, material)};
    return model;
  }
  const double G = spring_shear_modulus(p, material);
  calibrate(G, model.network);
  model.laws = {Springs{}};
  if (p.has(Extension::momentum_dispersion)) {
    const double q = dispersed_fraction(lame_lambda(material), G);
    p.exact_volumes = q >= 0;  // as exact_volumes(), whose homogenisation a lattice does not need
    model.laws.push_back(dispersion_law(p, model.network, {G, q}, volume_gradient(mesh)));
  }
  if (p.has(Extension::volume_correction)) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  return model;
}

Vec3 at(const LivePoint& place, const Hexahedron& cell, const NodalVectors& x) {
  Vec3 p = Vec3::Zero();
  for (int n = 0; n < 8; ++n) p += place.weights[n] * x.row(cell[n]).transpose();
  return p;
}

/// Four times the mean edges of a cell at x, as columns.
Eigen::Matrix3d edges_of(const Hexahedron& c, const NodalVectors& x) {
  Eigen::Matrix3d A;
  A.col(0) =
      (x.row(c[1]) - x.row(c[0]) + x.row(c[2]) - x.row(c[3]) + x.row(c[5]) - x.row(c[4]) + x.row(c[6]) - x.row(c[7]))
          .transpose();
  A.col(1) =
      (x.row(c[3]) - x.row(c[0]) + x.row(c[2]) - x.row(c[1]) + x.row(c[7]) - x.row(c[4]) + x.row(c[6]) - x.row(c[5]))
          .transpose();
  A.col(2) =
      (x.row(c[4]) - x.row(c[0]) + x.row(c[5]) - x.row(c[1]) + x.row(c[6]) - x.row(c[2]) + x.row(c[7]) - x.row(c[3]))
          .transpose();
  return A;
}

}  // namespace

Precision sufficient_precision(const std::string& name) {
  const ModelParameters p = parameters_of(name);
  return p.has(Extension::volume_correction) || p.has(Extension::averaging) ? Precision::float32 : Precision::float64;
}

LiveModel::LiveModel(const LiveBody& body, const std::string& name, const IsotropicMaterial& material,
                     Precision precision)
    : body_(body), name_(name), precision_(precision), x_(body.mesh.nodes) {
  v_ = NodalVectors::Zero(x_.rows(), 3);
  build(material);
}

void LiveModel::build(const IsotropicMaterial& material) {
  material_ = material;
  motion_.reset();
  model_ = model_of(body_.mesh, name_, material);
  mass_ = masses(model_.network, material.density);
  safe_step_ = safe_time_step(model_, material.density);
  motion_ = lattice_on_processor(model_, material.density, {.time_step = safe_step_, .precision = precision_});
  const double edge = model_.network.cells.edge;
  grip_stiffness_ = 4 * material.youngs_modulus * edge;
  grip_limit_ = 6 * material.youngs_modulus * edge * edge;
  set_conditions();
  motion_->set_state(x_, v_);
  measure();
}

void LiveModel::set_material(const IsotropicMaterial& material) { build(material); }

void LiveModel::rest() {
  x_ = model_.network.X;
  v_.setZero();
  motion_->set_state(x_, v_);
  caution_ = 1;
  measure();
}

void LiveModel::set_conditions() {
  BoundaryConditions c;
  c.fixed.assign(3 * model_.network.nodes(), 0);
  c.prescribed = c.external = NodalVectors::Zero(model_.network.nodes(), 3);
  for (const int n : body_.held)
    for (int d = 0; d < 3; ++d) c.fixed[3 * n + d] = 1;
  c.external = body_.pull * force_.transpose();
  motion_->set_conditions(c);
  motion_->move_supports();
}

void LiveModel::load(const Vec3& force) {
  force_ = force;
  set_conditions();
}

void LiveModel::grab(int point) {
  grip_ = {};
  pulling_.setZero();
  if (point < 0) return;
  const LivePoint& place = body_.places[point];
  const Hexahedron& cell = body_.mesh.hexahedra[place.cell];
  const Vec3 centre = at(place, cell, model_.network.X);
  const double radius = grip_reach * model_.network.cells.edge;
  std::vector<char> held(model_.network.nodes(), 0);
  for (const int n : body_.held) held[n] = 1;
  double sum = 0;
  for (int n = 0; n < model_.network.nodes(); ++n) {
    const double distance = (model_.network.X.row(n).transpose() - centre).norm();
    if (held[n] || distance >= radius) continue;
    grip_.nodes.push_back(n);
    grip_.weights.push_back(1 - distance / radius);
    sum += grip_.weights.back();
  }
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < grip_.nodes.size(); ++i) {
    grip_.weights[i] /= sum;
    mean += grip_.weights[i] * x_.row(grip_.nodes[i]).transpose();
  }
  target_ = at(place, cell, x_);
  grip_.offset = target_ - mean;
}

void LiveModel::pull_to(const Vec3& target) { target_ = target; }

/// Changes the velocities of the gripped nodes by the grip's force over this time.
void LiveModel::kick(double duration) {
  const std::size_t count = grip_.nodes.size();
  std::vector<std::array<double, 6>> state(count);
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const int n = grip_.nodes[i];
    motion_->read(n, n + 1, state[i].data());
    mean += grip_.weights[i] * (model_.network.X.row(n).transpose() + Eigen::Map<const Vec3>(state[i].data()));
  }
  double inertia = 0;  // of the mean: sum w^2 / m; a stiffer grip than this would not be stable at this step
  for (std::size_t i = 0; i < count; ++i) inertia += grip_.weights[i] * grip_.weights[i] / mass_[grip_.nodes[i]];
  const double stiffness = std::min(grip_stiffness_, stiffest_grip / (duration * duration * inertia));
  pulling_ = caution_ * stiffness * (target_ - grip_.offset - mean);
  if (const double size = pulling_.norm(); size > caution_ * grip_limit_) pulling_ *= caution_ * grip_limit_ / size;
  for (std::size_t i = 0; i < count; ++i) {
    const int n = grip_.nodes[i];
    for (int d = 0; d < 3; ++d) state[i][3 + d] += duration * grip_.weights[i] * pulling_[d] / mass_[n];
    motion_->write(n, n + 1, state[i].data());
  }
}

/// Share of the safe step at rest that is safe for the most squeezed cell, Hencky's modulus along a stretch s being
/// that at rest times (1 - ln s) / s^2; and for the widest: the volume correction pushes with the area of a cell's
/// face.
double LiveModel::shrink() const {
  const double s = std::clamp(least_stretch_, 1e-3, 1.0);
  return std::clamp(std::min(s / std::sqrt(1 - std::log(s)), 1 / largest_area_), stiffest_step, 1.0);
}

double LiveModel::time_step() const { return safety * safe_step_ * shrink() * std::sqrt(caution_); }

int LiveModel::advance(double duration, double damping) {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / time_step())));
  const double dt = duration / steps;
  motion_->set_step(dt, damping);
  if (grip_.nodes.empty()) {
    unbalanced_ = motion_->advance(steps).unbalanced;
  } else {
    for (int done = 0; done < steps; done += steps_per_kick) {
      const int now = std::min(steps_per_kick, steps - done);
      kick(now * dt);
      unbalanced_ = motion_->advance(now).unbalanced;
    }
  }
  const NodalVectors x = x_;
  if (measure()) {
    caution_ = std::min(1.0, caution_ * 1.05);
  } else {
    ++rescues_;
    caution_ = std::max(most_caution, caution_ / 4);
    x_ = x;
    v_.setZero();
    motion_->set_state(x_, v_);
    measure();
  }
  return steps;
}

/// Positions, volumes and energy of the state; false if it is not finite, or a cell is wider than a pull can make it.
bool LiveModel::measure() {
  x_ = motion_->positions();
  v_ = motion_->velocities();
  const Network& network = model_.network;
  if (!x_.allFinite() || !v_.allFinite()) return false;
  kinetic_energy_ = (mass_.array() * v_.rowwise().squaredNorm().array()).sum() / 2;
  const NodalVectors u = x_ - network.X;
  const double work = force_.dot(u.transpose() * body_.pull);
  const double moved = (mass_.array() * u.rowwise().squaredNorm().array()).sum();
  frequency_ = work > 0 && moved > 0 ? std::sqrt(work / moved) : 0;

  const double rest = 64 * network.cells.volume();
  Eigen::VectorXd dilatation = Eigen::VectorXd::Zero(network.nodes()), count = dilatation;
  double sum = 0;
  least_volume_ = least_stretch_ = 1e9;
  largest_area_ = 1;
  const bool corrected = law_of<VolumeCorrection>(model_) != nullptr;
  for (const Hexahedron& cell : network.cells.corners) {
    const Eigen::Matrix3d A = edges_of(cell, x_);
    const double J = A.determinant() / rest;
    sum += J - 1;
    least_volume_ = std::min(least_volume_, J);
    const Eigen::Vector3d stretch = A.colwise().norm().transpose() / (4 * network.cells.edge);
    if (stretch.maxCoeff() > widest) return false;
    least_stretch_ = std::min({least_stretch_, J, stretch.minCoeff()});
    if (corrected)
      largest_area_ =
          std::max({largest_area_, stretch[0] * stretch[1], stretch[1] * stretch[2], stretch[2] * stretch[0]});
    for (const int n : cell) dilatation[n] += J - 1, count[n] += 1;
  }
  volume_change_ = sum / double(network.cells.size());
  dilatation.array() /= count.array().max(1);

  points_.resize(3 * body_.places.size());
  dilatation_.resize(body_.places.size());
  for (std::size_t p = 0; p < body_.places.size(); ++p) {
    const Hexahedron& cell = body_.mesh.hexahedra[body_.places[p].cell];
    const Vec3 position = at(body_.places[p], cell, x_);
    double value = 0, weight = 0;
    for (int n = 0; n < 8; ++n) {
      const double w = std::max(0.0, body_.places[p].weights[n]);
      value += w * dilatation[cell[n]];
      weight += w;
    }
    for (int d = 0; d < 3; ++d) points_[3 * p + d] = static_cast<float>(position[d]);
    dilatation_[p] = static_cast<float>(value / weight);
  }
  return true;
}

}  // namespace springproof
