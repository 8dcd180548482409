#include "msm/kernels/cell_forces.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "msm/kernels/lattice_constants.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

/// Corner of a hexahedron at x + 2 y + 4 z.
int corner_at(int place) {
  for (int n = 0; n < 8; ++n)
    if (hexahedron_corners[n][0] + 2 * hexahedron_corners[n][1] + 4 * hexahedron_corners[n][2] == place) return n;
  return -1;
}

}  // namespace

template <class Real>
CellForces<Real>::CellForces(const MassSpringModel& model, InstructionSet set, const AveragedSprings& dashpots,
                             double time)
    : kernels_(&kernels_of<Real>(set)),
      X_(model.network.X),
      viscous_(time > 0),
      order_(model.network, kernels_->cell_list.cells),
      carried_(model.network.cells.carried) {
  for (CarriedPoint& c : carried_) {
    c.point = order_.place[c.point];
    for (int& by : c.by) by = order_.place[by];
  }
  if (!can(model, Capability::cell_kernels) || (viscous_ && dashpots.shift > 0))
    throw std::invalid_argument("cell forces are of averaged springs, without shift, or measured cells");
  const AveragedSprings* averaged = averaged_springs_of(model);
  const std::size_t materials = averaged ? 1 + averaged->regions.size() : 1;
  for (int m = 0; m < static_cast<int>(materials); ++m)
    constants_.push_back({averaged ? averaged_constants<Real>(averaged->in(m), 1) : LatticeAveraged<Real>{},
                          averaged_constants<Real>(viscous_ ? dashpots.in(m) : dashpots, time)});
  list_.retardation = static_cast<Real>(time);
  list_.boxes = model.network.cells.kind() == CellKind::boxes;
  for (int i = 0; i < 3; ++i) {
    list_.proportions[i] = static_cast<Real>(model.network.cells.proportions[i]);
    list_.per_proportion[i] = static_cast<Real>(1 / model.network.cells.proportions[i]);
  }
  store_cells(model.network);
  if (!averaged) store_forms(*law_of<MeasuredCells>(model));
  if (!law_of<Anchors>(model)) return;
  store_anchors(model.network);
  store_bonds(model.network);
}

template <class Real>
void CellForces<Real>::store_cells(const Network& network) {
  const long cells = kernels_->cell_list.cells, count = static_cast<long>(order_.cells.size());
  list_.blocks = order_.plan.blocks;
  corners_.resize(8 * cells * list_.blocks);
  numbers_ = {static_cast<std::size_t>(cell_number::count * cells * list_.blocks), Real(0)};
  int cell = 0;  // the one before, with nothing in it, in the rest of a block
  for (long at = 0; at < cells * list_.blocks; ++at) {
    const bool is_cell = at < count && order_.cells[at] >= 0;
    if (is_cell) cell = order_.cells[at];
    const CellShape shape = network.cells.shape(cell);
    const FilledPart& part = shape.part;
    const double l = shape.edge;
    for (int n = 0; n < 8; ++n)
      corners_[8 * cells * (at / cells) + n * cells + at % cells] =
          order_.place[network.cells.corners[cell][corner_at(n)]];
    const auto set = [&](int number, double value) {
      numbers_.data()[cell_number::count * cells * (at / cells) + number * cells + at % cells] =
          static_cast<Real>(value);
    };
    set(cell_number::area, is_cell ? part.fraction * l * l : 0);
    set(cell_number::per_edge, 1 / l);
    for (int i = 0; i < 3; ++i) {
      set(cell_number::mean + i, part.mean[i] / 2);
      set(cell_number::mixed + i, part.mixed[i]);
      set(cell_number::variance + i,
          std::max(12 * part.variance[i], AveragedSprings::least_variance) * std::pow(shape.proportions[i], 2));
    }
  }
}

template <class Real>
void CellForces<Real>::store_forms(const MeasuredCells& law) {
  static_assert(cell_number::of_form == numbers_of_form);
  const std::size_t cells = kernels_->cell_list.cells;
  forms_ = {numbers_of_form * cells * order_.plan.blocks, Real(0)};
  for (std::size_t at = 0; at < order_.cells.size(); ++at)
    for (int number = 0; number < numbers_of_form; ++number)
      forms_.data()[numbers_of_form * cells * (at / cells) + number * cells + at % cells] =
          static_cast<Real>(law.form[numbers_of_form * order_.cells[at] + number]);
}

template <class Real>
void CellForces<Real>::store_anchors(const Network& network) {
  for (const int number : order_.anchors) {
    const Anchor& a = network.anchors[number];
    Held held;
    Eigen::RowVector3d stretch = -network.X.row(a.node);
    for (int n = 0; n < 8; ++n) {
      held.corners[n] = order_.place[a.corners[n]];
      held.weights[n] = static_cast<Real>(a.weights[n]);
      stretch += a.weights[n] * network.X.row(a.corners[n]);
    }
    held.node = order_.place[a.node];
    for (int d = 0; d < 3; ++d) {
      held.stretch[d] = static_cast<Real>(stretch[d]);
      for (int e = 0; e < 3; ++e) held.stiffness[d][e] = static_cast<Real>(a.stiffness(d, e));
    }
    anchors_.push_back(held);
  }
}

template <class Real>
void CellForces<Real>::store_bonds(const Network& network) {
  for (const int number : order_.bonds) {
    const InterfaceBond& b = network.bonds[number];
    Tie tie;
    int at = 0;
    for_each_corner(b, [&](int node, double weight) {
      tie.corners[at] = order_.place[node];
      tie.weights[at++] = static_cast<Real>(weight);
    });
    const Vec3 at_rest = gap(b, network.X);
    for (int d = 0; d < 3; ++d) {
      tie.gap[d] = static_cast<Real>(at_rest[d]);
      for (int e = 0; e < 3; ++e) tie.stiffness[d][e] = static_cast<Real>(b.stiffness(d, e));
    }
    ties_.push_back(tie);
  }
}

template <class Real>
void CellForces<Real>::add_blocks(long begin, long end, const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f) {
  for (long first = begin, next; first < end; first = next) {
    for (next = first + 1; next < end && order_.material[next] == order_.material[first];) ++next;
    kernels_->cell_list.forces(part_of_list(first, next), x, viscous_ ? s : nullptr, f);
  }
  add_anchors(begin, end, x, f);
  add_bonds(begin, end, x, f);
}

/// Blocks of one material.
template <class Real>
CellList<Real> CellForces<Real>::part_of_list(long begin, long end) {
  CellList<Real> list = list_;
  list.springs = constants_[order_.material[begin]].springs;
  list.dashpots = constants_[order_.material[begin]].dashpots;
  list.blocks = end - begin;
  list.corners = corners_.data() + 8 * kernels_->cell_list.cells * begin;
  list.numbers = numbers_.data() + cell_number::count * kernels_->cell_list.cells * begin;
  if (forms_.size() > 0) list.forms = forms_.data() + numbers_of_form * kernels_->cell_list.cells * begin;
  if (relaxing()) {
    list.branch_count = static_cast<int>(branches_.size());
    list.branches = branches_.data();
    list.overstrains = overstrains_.data() + overstrain_count * kernels_->cell_list.cells * list.branch_count * begin;
  }
  return list;
}

template <class Real>
void CellForces<Real>::add_anchors(long begin, long end, const Padded<Real>* x, Padded<Real>* f) const {
  if (anchors_.empty()) return;
  for (int number = order_.first_anchor[begin]; number < order_.first_anchor[end]; ++number) {
    const Held& a = anchors_[number];
    Real stretch[3];
    for (int d = 0; d < 3; ++d) {
      stretch[d] = a.stretch[d] - x[a.node].v[d];
      for (int n = 0; n < 8; ++n) stretch[d] += a.weights[n] * x[a.corners[n]].v[d];
    }
    for (int d = 0; d < 3; ++d) {
      const Real force =
          a.stiffness[d][0] * stretch[0] + a.stiffness[d][1] * stretch[1] + a.stiffness[d][2] * stretch[2];
      f[a.node].v[d] += force;
      for (int n = 0; n < 8; ++n) f[a.corners[n]].v[d] -= a.weights[n] * force;
    }
  }
}

template <class Real>
void CellForces<Real>::add_bonds(long begin, long end, const Padded<Real>* x, Padded<Real>* f) const {
  if (ties_.empty()) return;
  for (int number = order_.first_bond[begin]; number < order_.first_bond[end]; ++number) {
    const Tie& t = ties_[number];
    Real g[3];
    for (int d = 0; d < 3; ++d) {
      g[d] = t.gap[d];
      for (int n = 0; n < 16; ++n) g[d] += t.weights[n] * x[t.corners[n]].v[d];
    }
    for (int d = 0; d < 3; ++d) {
      const Real force = t.stiffness[d][0] * g[0] + t.stiffness[d][1] * g[1] + t.stiffness[d][2] * g[2];
      for (int n = 0; n < 16; ++n) f[t.corners[n]].v[d] -= t.weights[n] * force;
    }
  }
}

/// Into x_ and s_.
template <class Real>
void CellForces<Real>::place_carried(const Padded<Real>* x, const Padded<Real>* s) {
  const std::size_t nodes = order_.place.size();
  x_.assign(x, x + nodes);
  if (viscous_) s_.assign(s, s + nodes);
  for (const CarriedPoint& c : carried_) {
    const Real share = Real(1) / static_cast<Real>(c.by.size());
    Padded<Real> u = {}, v = {};
    u.v[3] = 1;
    for (const int by : c.by)
      for (int d = 0; d < 3; ++d) {
        u.v[d] += share * x_[by].v[d];
        if (viscous_) v.v[d] += share * s_[by].v[d] * x_[by].v[3];
      }
    x_[c.point] = u;
    if (viscous_) s_[c.point] = v;
  }
}

template <class Real>
void CellForces<Real>::add(const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f, bool) {
  place_carried(x, s);
  add_blocks(0, order_.plan.blocks, x_.data(), s_.data(), f);
  for (auto c = carried_.rbegin(); c != carried_.rend(); ++c)
    for (int d = 0; d < 3; ++d) {
      const Real share = f[c->point].v[d] / static_cast<Real>(c->by.size());
      for (const int by : c->by) f[by].v[d] += share;
      f[c->point].v[d] = 0;
    }
}

template <class Real>
void CellForces<Real>::set_branches(const Relaxation& relaxation, const AveragedSprings& cells, double time_step) {
  list_.relaxing = averaged_constants<Real>(cells, 1);
  branches_.clear();
  for (const auto& [share, time] : relaxation.branches) {
    const BranchStep step = BranchStep::of(time_step / time);
    const Real gain = static_cast<Real>(share * step.phi), decay = static_cast<Real>(step.decay);
    branches_.push_back({static_cast<Real>(share), decay, gain, gain * (1 - decay)});  // a held strain relaxes to 0
  }
  if (forms_.size() == 0 && relaxing()) {
    const LatticeAveraged<Real>& own = constants_[0].springs;
    const double b = own.bending, k = own.coupling, of_b = list_.relaxing.bending, of_k = list_.relaxing.coupling;
    list_.bending_of_branches.own = static_cast<Real>((b * of_b - k * of_k) / (b * b - k * k));
    list_.bending_of_branches.other = static_cast<Real>((b * of_k - k * of_b) / (b * b - k * k));
  }
  overstrains_ = {overstrain_count * kernels_->cell_list.cells * branches_.size() * order_.plan.blocks, Real(0)};
}

template <class Real>
void CellForces<Real>::relax(const Padded<Real>* x) {
  const std::vector<CellBranch<Real>> kept = branches_;
  for (CellBranch<Real>& branch : branches_) branch.decay = 0;  // P = E whatever it was
  const std::vector<Padded<Real>> still(order_.place.size(), Padded<Real>{});
  std::vector<Padded<Real>> unused = still;
  add(x, still.data(), unused.data(), false);
  branches_ = kept;
  const std::size_t of_branch = overstrain_count * kernels_->cell_list.lanes;
  for (std::size_t i = 0; i < overstrains_.size(); ++i) {  // gain E = loss P
    const CellBranch<Real>& branch = branches_[i / of_branch % branches_.size()];
    overstrains_.data()[i] *= branch.gain / branch.loss;
  }
}

template <class Real>
void CellForces<Real>::add_relaxing(const Padded<Real>* x, Padded<Real>* f) {
  const std::vector<Real> kept(overstrains_.begin(), overstrains_.end());
  const std::vector<CellBranch<Real>> branches = branches_;
  const std::vector<Padded<Real>> still(order_.place.size(), Padded<Real>{});
  std::vector<Padded<Real>> with = still, without = still;
  add(x, still.data(), with.data(), false);
  for (CellBranch<Real>& branch : branches_) branch.gain = branch.loss = 0;
  add(x, still.data(), without.data(), false);
  branches_ = branches;
  std::copy(kept.begin(), kept.end(), overstrains_.begin());
  for (std::size_t p = 0; p < with.size(); ++p)
    for (int d = 0; d < 3; ++d) f[p].v[d] += with[p].v[d] - without[p].v[d];
}

template <class Real>
std::vector<double> CellForces<Real>::branch_energies(const Padded<Real>* x) {
  std::vector<double> stored(branches_.size(), 0);
  if (coupled()) {
    const std::vector<Padded<Real>> still(order_.place.size(), Padded<Real>{});
    place_carried(x, still.data());
    x = x_.data();
  }
  kernels_->cell_list.branch_energies(part_of_list(0, order_.plan.blocks), x, stored.data());
  return stored;
}

template <class Real>
void CellForces<Real>::at(const NodalVectors& x, const NodalVectors& v, NodalVectors& f) {
  const std::vector<int>& order = order_.plan.order;
  std::vector<Padded<Real>> u(order.size()), s(order.size()), on(order.size(), Padded<Real>{});
  for (std::size_t p = 0; p < order.size(); ++p) {
    for (int d = 0; d < 3; ++d) {
      u[p].v[d] = static_cast<Real>(x(order[p], d) - X_(order[p], d));
      s[p].v[d] = static_cast<Real>(v(order[p], d));
    }
    u[p].v[3] = 1;
  }
  add(u.data(), s.data(), on.data(), false);
  f.resize(x.rows(), 3);
  by_node(order, on, 1, f.data());
}

template class CellForces<double>;
template class CellForces<float>;

}  // namespace springproof
