#include "comparisons/models/motion_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/judge/swings.h"
#include "msm/cells/filled_volume.h"

namespace springproof {

const std::vector<double>* series(const HistoryRecord& h, const std::string& name) {
  const auto at = std::ranges::find(h.names, name);
  return at == h.names.end() ? nullptr : &h.values[at - h.names.begin()];
}

std::string liveliest(const HistoryRecord& h, const std::string& probe) {
  std::string best;
  double most = -1;
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string name = fmt::format("displacement.{}.{}", probe, axis);
    const auto [low, high] = std::minmax_element(series(h, name)->begin(), series(h, name)->end());
    if (*high - *low > most) {
      most = *high - *low;
      best = name;
    }
  }
  return best;
}

std::map<std::string, double> measured_in_time(const Experiment& e, const HistoryRecord& h) {
  const MotionChoice& motion = *e.dynamics;
  const std::vector<double>& u = *series(h, h.probe);
  const double settled = motion.course.settled();
  const auto first = std::isfinite(settled) ? std::ranges::lower_bound(h.time, settled) - h.time.begin() : 0;
  std::map<std::string, double> out;
  if (const auto swings = swings_of({h.time.begin() + first, h.time.end()}, {u.begin() + first, u.end()})) {
    out["period"] = swings->period;
    out["amplitude"] = swings->amplitude;
    const bool damped = motion.damping > 0 || motion.viscosity > 0 || e.relaxation.acts();
    if (const auto mode = damped ? damped_swings_of(h.time, u, *swings, e.relaxation) : std::nullopt) {
      out["period"] = mode->period;
      out["damping_ratio"] = mode->damping_ratio;
    }
  }
  if (motion.course.pulse > 0)
    if (const auto arrival = arrival_of(h.time, u)) out["arrival"] = *arrival;
  return out;
}

namespace {

/// By how much a body of corner masses turns too slowly: the largest excess of their moments of inertia about x, y and
/// z over those of its cells, as a fraction of these.  A corner's mass has l^2 / 4 about the middle of a cell, the cell
/// l^2 / 12; a share of consistent mass has the cell's.
double inertia_excess(const Network& network, const Eigen::VectorXd& mass, double mass_consistency) {
  double volume = 0;  // times the density over that of the body's own material, as all here
  Vec3 own = Vec3::Zero();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const std::vector<double>& densities = network.cells.relative_densities;
    const double V = filled_volume(network, c) * (densities.empty() ? 1 : densities[network.cells.material(c)]);
    volume += V;
    own += V * (network.cells.edge_of(c) * network.cells.proportions).array().square().matrix() / 6;
  }
  own *= mass.sum() / volume;
  const Eigen::RowVector3d centre = mass.transpose() * network.X / mass.sum();
  const Vec3 second = (network.X.rowwise() - centre).array().square().matrix().transpose() * mass;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double excess = own.sum() - own[axis], all = second.sum() - second[axis];
    most = std::max(most, (1 - mass_consistency) * excess / (all - excess));
  }
  return most;
}

/// The first sample that only settled loads have moved: the loads of a sample are those of the step before it.
std::size_t first_settled(const MotionChoice& motion, const HistoryRecord& h) {
  std::size_t first = 0;
  const double settled = motion.course.settled();
  while (first < h.time.size() && settled > 0 && h.time[first] < settled + h.time_step) ++first;
  return first;
}

/// The largest deviation from a value, from that value on.
double drift_of(const std::vector<double>& values, std::size_t first) {
  double drift = 0;
  for (std::size_t i = first; i < values.size(); ++i) drift = std::max(drift, std::abs(values[i] - values[first]));
  return drift;
}

/// Whether the plane gave the body an impulse, and took energy: PlaneContact.
bool landed(const HistoryRecord& h) {
  const auto pushed = [&](char axis) {
    const std::vector<double>* impulse = series(h, fmt::format("contact_impulse.{}", axis));
    return impulse && impulse->back() != 0;
  };
  return pushed('x') || pushed('y') || pushed('z');
}

/// Of the total energy, with what branches have stored and dissipated, relative to the largest kinetic energy.
void measure_energy(std::size_t first, HistoryRecord& h) {
  const std::vector<double>*kinetic = series(h, "kinetic_energy"), *elastic = series(h, "elastic_energy"),
        *load = series(h, "load_potential");
  if (!elastic || first >= h.time.size()) return;
  std::vector<double> total(h.time.size());
  for (std::size_t i = first; i < total.size(); ++i) total[i] = (*kinetic)[i] + (*elastic)[i] + (*load)[i];
  for (const char* of_branches : {"branch_energy", "dissipated_energy"})
    if (const std::vector<double>* more = series(h, of_branches))
      for (std::size_t i = first; i < total.size(); ++i) total[i] += (*more)[i];
  const double largest = std::max(0.0, *std::max_element(kinetic->begin() + static_cast<long>(first), kinetic->end()));
  if (largest > 0) h.measured["energy_drift"] = drift_of(total, first) / largest;
}

/// Relative to the momentum `scale` at half the size of the body.
void measure_spin(const MovingNetwork& moving, double scale, HistoryRecord& h) {
  double drift = 0;
  for (const char axis : {'x', 'y', 'z'})
    drift = std::max(drift, drift_of(*series(h, fmt::format("angular_momentum.{}", axis)), 0));
  if (scale > 0) h.measured["angular_momentum_drift"] = drift / (scale * moving.prepared.body.size.norm() / 2);
}

/// Along axes in which nothing is held, loaded or pushed by a plane, relative to `scale`.
void measure_momentum(const MotionChoice& motion, const BoundaryConditions& last, double scale, HistoryRecord& h) {
  const std::size_t first = first_settled(motion, h);
  if (first >= h.time.size()) return;
  double drift = -1;
  for (int axis = 0; axis < 3; ++axis) {
    bool free = last.external.col(axis).isZero(0) &&
                !(motion.plane && (motion.plane->friction > 0 || motion.plane->normal[axis] != 0));
    for (std::size_t i = axis; i < last.fixed.size(); i += 3) free = free && !last.fixed[i];
    if (free) drift = std::max(drift, drift_of(*series(h, fmt::format("linear_momentum.{}", "xyz"[axis])), first));
  }
  if (drift >= 0 && scale > 0) h.measured["momentum_drift"] = drift / scale;
}

}  // namespace

void measure(const MovingNetwork& moving, const BoundaryConditions& last, HistoryRecord& h) {
  const Experiment& e = moving.prepared.experiment;
  const MotionChoice& motion = moving.motion();
  const Eigen::VectorXd masses = moving.masses();
  if (!e.probes.empty() && h.time.size() > 1) {
    h.probe = liveliest(h, e.probes.front().name);
    h.measured = measured_in_time(e, h);
  }
  const bool damped = motion.damping > 0;
  if (!damped && motion.viscosity == 0 && !landed(h)) measure_energy(first_settled(motion, h), h);
  const std::vector<double>& kinetic = *series(h, "kinetic_energy");
  const double scale = std::sqrt(2 * masses.sum() * *std::ranges::max_element(kinetic));
  const bool flies = std::ranges::none_of(last.fixed, [](bool f) { return f; });
  if (flies && !moving.network().cells.empty())
    h.measured["inertia_excess"] = inertia_excess(
        moving.network(), moving.material.density * volumes_by_mass(moving.network()), motion.mass_consistency);
  if (flies && !motion.plane && last.external.isZero(0) && !damped) measure_spin(moving, scale, h);
  if (!damped) measure_momentum(motion, last, scale, h);
}

}  // namespace springproof
