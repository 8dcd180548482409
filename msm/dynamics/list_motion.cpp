#include "msm/dynamics/list_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msm/dynamics/inertia.h"
#include "msm/kernels/cell_forces.h"
#include "msm/kernels/list_forces.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

constexpr int gain = 3;  // index of dt / m * decay in a node's entry of external_

/// Number of threads up to which they do not wait for each other.
int useful_threads(const Wavefront& wavefront, int wanted) {
  return static_cast<int>(std::clamp(static_cast<long>(wanted), 1L, std::max(1L, wavefront.pieces() / wavefront.lag)));
}

/// Number of pieces that a worker has completed in all its steps; read by the worker of the following step.
struct alignas(64) PiecesDone {
  std::atomic<long> value = 0;
};

}  // namespace

template <class Real>
ListMotion<Real>::ListMotion(std::unique_ptr<BlockForces<Real>> forces, const MassSpringModel& model, double density,
                             const MotionOptions& options)
    : forces_(std::move(forces)),
      order_(forces_->plan().order),
      wavefront_(forces_->plan()),
      workers_(std::make_unique<Workers>(
          forces_->coupled() || options.mass_consistency > 0 ? 1 : useful_threads(wavefront_, options.threads))),
      network_(model.network),
      origin_(forces_->origin()),
      instructions_(options.instructions),
      time_step_(options.time_step.value()),
      decay_(1 / (1 + time_step_ * options.damping)),
      lagged_(options.lagged) {
  const Eigen::VectorXd per_mass = inverse_inertia(network_, density, options).col(0);
  x_ = s_ = f_ = external_ = std::vector<Padded<Real>>(order_.size(), Padded<Real>{});
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const int n = order_[p];
    for (int d = 0; d < 3; ++d) x_[p].v[d] = static_cast<Real>(network_.X(n, d) - origin_(n, d));
    external_[p].v[gain] = static_cast<Real>(time_step_ * per_mass[n] * decay_);
    if (forces_->viscous()) x_[p].v[3] = external_[p].v[gain] / static_cast<Real>(decay_);
  }
  if (options.branch_energies && forces_->relaxing()) watched_ = options.relaxation.relaxation.branches;
  if (options.mass_consistency > 0) set_up(mass_average(network_, density, options));
}

template <class Real>
void ListMotion<Real>::set_up(const MassAverage& average) {
  const std::vector<Hexahedron>& cells = average.network().cells.corners;
  std::vector<int> place(order_.size());
  for (std::size_t p = 0; p < order_.size(); ++p) place[order_[p]] = static_cast<int>(p);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::size_t first = corners_.size();
    corners_.resize(first + 8);
    for (int n = 0; n < 8; ++n) {
      const auto& at = hexahedron_corners[n];
      corners_[first + at[0] + 2 * at[1] + 4 * at[2]] = place[cells[c][n]];
    }
    factors_.push_back(static_cast<Real>(time_step_ * average.part(c)));
  }
  for (const int node : order_) shares_.push_back(static_cast<Real>(average.share(node)));
  v_.assign(order_.size(), Padded<Real>{});
}

template <class Real>
void ListMotion<Real>::set_conditions(const BoundaryConditions& conditions) {
  held_.clear();
  for (int p = 0; p < static_cast<int>(order_.size()); ++p)
    for (int d = 0; d < 3; ++d) {
      const int n = order_[p];
      external_[p].v[d] = static_cast<Real>(conditions.external(n, d));
      if (conditions.fixed[3 * n + d])
        held_.push_back({p, d, static_cast<Real>(network_.X(n, d) - origin_(n, d) + conditions.prescribed(n, d))});
    }
  supports_wait_ = true;
}

template <class Real>
void ListMotion<Real>::move_supports() {
  for (const Held& h : held_) x_[h.place].v[h.component] = h.x;
  supports_wait_ = false;
}

/// Moves the supports; dashpots see the speeds in the next step.
template <class Real>
void ListMotion<Real>::move_with_speed() {
  if (forces_->viscous())
    for (const Held& h : held_)
      if (const Real per_s = x_[h.place].v[3] * static_cast<Real>(time_step_); per_s > 0)
        s_[h.place].v[h.component] = (h.x - x_[h.place].v[h.component]) / per_s;
  move_supports();
}

template <class Real>
void ListMotion<Real>::set_state(const NodalVectors& x, const NodalVectors& v) {
  auto held = held_.begin();
  for (int p = 0; p < static_cast<int>(order_.size()); ++p)
    for (int d = 0; d < 3; ++d) {
      const int n = order_[p];
      const Real per_s = external_[p].v[gain] / static_cast<Real>(decay_);  // as velocities() reads it
      x_[p].v[d] = static_cast<Real>(x(n, d) - origin_(n, d));
      if (held != held_.end() && held->place == p && held->component == d)
        ++held;  // it keeps the speed of move_with_speed()
      else
        s_[p].v[d] = per_s > 0 ? static_cast<Real>(v(n, d)) / per_s : 0;
    }
}

template <class Real>
void ListMotion<Real>::relax() {
  if (forces_->relaxing()) forces_->relax(x_.data());
  energies_ = {};
  power_ = 0;
}

/// Of steps that are made.
template <class Real>
void ListMotion<Real>::watch_branches(double duration) {
  const std::vector<double> stored = forces_->branch_energies(x_.data());
  const double before = power_;
  power_ = energies_.stored = 0;
  for (std::size_t b = 0; b < watched_.size(); ++b) {
    energies_.stored += stored[b];
    power_ += 2 * stored[b] / watched_[b].time;
  }
  energies_.dissipated += duration * (before + power_) / 2;
}

template <class Real>
std::optional<BranchEnergies> ListMotion<Real>::branch_energies() const {
  return watched_.empty() ? std::nullopt : std::optional(energies_);
}

template <class Real>
NodalVectors ListMotion<Real>::relaxing_forces() const {
  if (!forces_->relaxing()) return {};
  std::vector<Padded<Real>> f(order_.size(), Padded<Real>{});
  forces_->add_relaxing(x_.data(), f.data());
  return in_network_order(f);
}

/// Moves the nodes begin <= n < end, whose forces are complete, and `apart` in f_.  The total force on fixed unknowns
/// is set to 0 first, so that they stay.
template <class Real>
typename ListMotion<Real>::Squares ListMotion<Real>::move(int begin, int end, bool apart) {
  Squares sum;
  const auto below = [](const Held& h, int place) { return h.place < place; };
  for (auto h = std::lower_bound(held_.begin(), held_.end(), begin, below); h != held_.end() && h->place < end; ++h) {
    const Real external = external_[h->place].v[h->component];
    Real& f = f_[h->place].v[h->component];
    if (apart) {
      sum.support += double(f + external) * double(f + external);
      f = -external;
    }
    s_[h->place].v[h->component] = apart ? 0 : -external;
  }
  ListStep<Real> s;
  s.nodes = end - begin;
  s.dt = static_cast<Real>(time_step_);
  s.decay = static_cast<Real>(decay_);
  s.external = external_.data() + begin;
  s.x = x_.data() + begin;
  s.s = s_.data() + begin;
  s.f = apart ? f_.data() + begin : nullptr;
  sum.unbalanced = forces_->kernels().step(s);
  return sum;
}

/// Moves the nodes by what averaged momenta add to a step.  Supports, whose velocities have part in it, stay.
template <class Real>
void ListMotion<Real>::move_by_averages() {
  for (std::size_t p = 0; p < order_.size(); ++p)
    for (int d = 0; d < 3; ++d) v_[p].v[d] = s_[p].v[d] * external_[p].v[gain] / static_cast<Real>(decay_);
  std::vector<Real> stay;
  for (const Held& h : held_) {
    stay.push_back(x_[h.place].v[h.component]);
    v_[h.place].v[h.component] = supports_wait_ ? (h.x - stay.back()) / static_cast<Real>(time_step_) : 0;
  }
  forces_->kernels().average(
      {static_cast<long>(factors_.size()), corners_.data(), factors_.data(), shares_.data(), v_.data(), x_.data()});
  for (std::size_t h = 0; h < held_.size(); ++h) x_[held_[h].place].v[held_[h].component] = stay[h];
}

template <class Real>
typename ListMotion<Real>::Squares ListMotion<Real>::whole_step() {
  if (forces_->coupled())
    forces_->add(x_.data(), s_.data(), f_.data(), lagged_);
  else
    forces_->add_blocks(0, wavefront_.begin.back(), x_.data(), s_.data(), f_.data());
  const Squares sum = move(0, static_cast<int>(order_.size()), true);
  if (!factors_.empty()) move_by_averages();
  return sum;
}

template <class Real>
typename ListMotion<Real>::Squares ListMotion<Real>::run(long steps) {
  Squares sum;
  if (forces_->coupled() || !factors_.empty()) {
    for (; steps > 0; --steps) sum = whole_step();
    return sum;
  }
  run_steps(wavefront_, steps, *workers_, [&](long step, long piece) {
    const bool last = step == steps - 1, apart = last || forces_->viscous();
    forces_->add_blocks(wavefront_.begin[piece], wavefront_.begin[piece + 1], x_.data(), s_.data(),
                        apart ? f_.data() : s_.data());
    const Squares more = move(wavefront_.complete[piece], wavefront_.complete[piece + 1], apart);
    if (!last) return;  // one thread computes all pieces of a step
    sum.unbalanced += more.unbalanced;
    sum.support += more.support;
  });
  return sum;
}

template <class Real>
ForceNorms ListMotion<Real>::advance(long steps) {
  const double duration = static_cast<double>(steps) * time_step_;
  Squares sum;
  if (steps > 0 && supports_wait_) {
    sum = run(1);
    move_with_speed();
    --steps;
  }
  if (steps > 0) sum = run(steps);
  if (!watched_.empty()) watch_branches(duration);
  return {std::sqrt(sum.unbalanced), std::sqrt(sum.support)};
}

template <class Real>
NodalVectors ListMotion<Real>::in_network_order(const std::vector<Padded<Real>>& v) const {
  NodalVectors out(network_.nodes(), 3);
  by_node(order_, v, 1, out.data());
  return out;
}

template <class Real>
NodalVectors ListMotion<Real>::positions() const {
  NodalVectors x = origin_ + in_network_order(x_);
  carry(network_.cells.carried, x);
  return x;
}

template <class Real>
NodalVectors ListMotion<Real>::velocities() const {
  std::vector<Padded<Real>> v = s_;
  for (const Held& h : held_) v[h.place].v[h.component] = 0;
  for (std::size_t p = 0; p < v.size(); ++p)
    for (int d = 0; d < 3; ++d) v[p].v[d] *= external_[p].v[gain] / static_cast<Real>(decay_);
  NodalVectors of_nodes = in_network_order(v);
  carry(network_.cells.carried, of_nodes);
  return of_nodes;
}

template <class Real>
std::string ListMotion<Real>::description() const {
  return fmt::format("{}, {}, {}, {}", kernel(), sizeof(Real) == 4 ? "FP32" : "FP64", name_of(instructions_),
                     threads() == 1 ? "1 thread" : fmt::format("{} threads", threads()));
}

template class ListMotion<double>;
template class ListMotion<float>;

namespace {

/// Whether kernels have the branches: beside averaged springs those whose long-time moduli are theirs but for bending;
/// and none so slow that a step changes them by little more than round-off.
template <class Real>
bool kernels_relax(const MassSpringModel& model, const RelaxingCells& relaxing, double time_step) {
  constexpr double round_off = 0.01;  // of what a branch has relaxed
  for (const RelaxationBranch& b : relaxing.relaxation.branches)
    if (round_off * time_step / b.time < std::numeric_limits<Real>::epsilon()) return false;
  const AveragedSprings* own = averaged_springs_of(model);
  if (!own || !relaxing.acts()) return true;
  const HourglassStiffness &a = own->hourglass, &b = relaxing.cells.hourglass;
  return own->shear_modulus == relaxing.cells.shear_modulus && a.torsion == b.torsion && a.twist == b.twist &&
         a.warping == b.warping && a.bending > std::abs(a.coupling);
}

template <class Real>
std::unique_ptr<BlockForces<Real>> block_forces(const MassSpringModel& model, const MotionOptions& options) {
  if (options.mass_consistency > 0 && options.viscosity.acts()) return nullptr;
  const std::vector<Anchor>& anchors = model.network.anchors;  // one support mass for all axes of a node
  if (std::any_of(anchors.begin(), anchors.end(), [](const Anchor& a) { return a.axes != 7; })) return nullptr;
  const AveragedSprings& dashpots = options.viscosity.cells();
  if (can(model, Capability::cell_kernels) && !options.viscosity.along_springs() && dashpots.shift == 0 &&
      kernels_relax<Real>(model, options.relaxation, options.time_step.value())) {
    auto cells = std::make_unique<CellForces<Real>>(model, options.instructions, dashpots, options.viscosity.time());
    cells->set_branches(options.relaxation.relaxation, options.relaxation.cells, options.time_step.value());
    return cells;
  }
  if (can(model, Capability::list_kernels) && !options.viscosity.acts() && !options.relaxation.acts())
    return std::make_unique<ListForces<Real>>(model, options.instructions);
  return nullptr;
}

template <class Real>
std::unique_ptr<Motion> list_motion_of(const MassSpringModel& model, double density, const MotionOptions& options) {
  std::unique_ptr<BlockForces<Real>> forces = block_forces<Real>(model, options);
  if (!forces) return nullptr;
  return std::make_unique<ListMotion<Real>>(std::move(forces), model, density, options);
}

}  // namespace

std::unique_ptr<Motion> list_motion(const MassSpringModel& model, double density, const MotionOptions& options) {
  return options.precision == Precision::float32 ? list_motion_of<float>(model, density, options)
                                                 : list_motion_of<double>(model, density, options);
}

Wavefront::Wavefront(const BlockPlan& plan) : complete{0} {
  for (long b = 0; b == 0 || b < plan.blocks; b += plan.blocks_of_piece)
    begin.push_back(b);  // nodes that no block touches move as well
  begin.push_back(plan.blocks);
  std::size_t node = 0;  // they are moved in their order
  for (long piece = 0; piece < pieces(); ++piece) {
    for (; node < plan.touched.size() && plan.touched[node].last / plan.blocks_of_piece <= piece; ++node)
      lag = std::max(lag, piece - plan.touched[node].first / plan.blocks_of_piece + 1);
    complete.push_back(static_cast<int>(node));
  }
}

void run_steps(const Wavefront& wavefront, long steps, Workers& workers, const PieceOfStep& compute) {
  const long count = workers.count(), together = count == 1 ? 2 : 1, pieces = wavefront.pieces(), lag = wavefront.lag;
  std::vector<PiecesDone> done(count);
  const std::function<void(int)> work = [&](int worker) {
    for (long first = worker * together; first < steps; first += count * together)
      for (long position = 0; position < pieces + (together - 1) * lag; ++position)
        for (long step = first; step < std::min(first + together, steps); ++step) {
          const long piece = position - (step - first) * lag;
          if (piece < 0 || piece >= pieces) continue;
          const long before = step - 1;  // the previous step, which must be ahead by `lag` pieces
          if (count > 1 && before >= 0)
            wait_until(done[before % count].value, before / count * pieces + std::min(piece + lag, pieces));
          compute(step, piece);
          done[worker].value.fetch_add(1, std::memory_order_release);
        }
  };
  workers.run(work);
}

}  // namespace springproof
