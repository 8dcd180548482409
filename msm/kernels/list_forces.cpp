#include "msm/kernels/list_forces.h"

#include <algorithm>
#include <stdexcept>

#include "msm/kernels/kernels.h"
#include "msm/laws/capabilities.h"

namespace springproof {

template <class Real>
ListDispersionData<Real>::ListDispersionData(const MomentumDispersion& law, const Network& network,
                                             const SpringBlocks& blocks)
    : a_i(blocks.entries()), a_j(a_i), c_i(a_i), c_j(a_i) {
  const MomentumDispersion::Coefficients c = law.coefficients(network);
  for (std::size_t e = 0; e < a_i.size(); ++e) {
    const int s = blocks.spring[e];
    if (s < 0) continue;
    const int end = blocks.end_of_i(network, e);
    a_i[e] = static_cast<Real>(c.in[s][end]);
    a_j[e] = static_cast<Real>(c.in[s][1 - end]);
    c_i[e] = static_cast<Real>(c.out[s][end]);
    c_j[e] = static_cast<Real>(c.out[s][1 - end]);
  }
  if (law.group.empty() && network.image_of.empty()) return;
  std::vector<int> place(blocks.order.size());
  for (int p = 0; p < blocks.nodes(); ++p) place[blocks.order[p]] = p;
  for (int node : blocks.order) sink.push_back(place[law.sink(network, node)]);
}

template <class Real>
template <class Other>
ListDispersionData<Real>::ListDispersionData(const ListDispersionData<Other>& o)
    : a_i(o.a_i.begin(), o.a_i.end()),
      a_j(o.a_j.begin(), o.a_j.end()),
      c_i(o.c_i.begin(), o.c_i.end()),
      c_j(o.c_j.begin(), o.c_j.end()),
      sink(o.sink) {}

template <class Real>
void ListDispersionData<Real>::share(std::vector<Real>& J) const {
  if (sink.empty()) return;
  std::vector<Real> total(J.size(), 0);
  for (std::size_t p = 0; p < J.size(); ++p) total[sink[p]] += J[p];
  for (std::size_t p = 0; p < J.size(); ++p) J[p] = total[sink[p]];
}

template struct ListDispersionData<double>;
template struct ListDispersionData<float>;
template ListDispersionData<float>::ListDispersionData(const ListDispersionData<double>&);

template <class Real>
ListForces<Real>::ListForces(const MassSpringModel& model, InstructionSet set)
    : kernels_(&kernels_of<Real>(set).list), blocks_(model.network), x_(blocks_.order.size()), f_(x_) {
  if (!can(model, Capability::list_kernels))
    throw std::invalid_argument("list forces are of springs and momentum dispersion only");
  const Network& network = model.network;
  k_ = blocks_.per_entry<Real>([&](int s) { return network.springs[s].stiffness; });
  kL_ = blocks_.per_entry<Real>([&](int s) { return network.springs[s].stiffness * network.springs[s].rest_length; });
  const MomentumDispersion* law = dispersion_of(model);
  if (!law) return;
  L_ = blocks_.per_entry<Real>([&](int s) { return network.springs[s].rest_length; });
  dispersion_.emplace_back(*law, network, blocks_);
  inverse_length_.resize(blocks_.entries());
}

template <class Real>
void ListForces<Real>::add(const Padded<Real>* x, const Padded<Real>*, Padded<Real>* f, bool lagged) {
  const ListPattern pattern = blocks_.pattern();
  const ListSprings<Real> springs = {k_.data(), kL_.data(), L_.data()};
  if (dispersion_.empty()) return kernels_->spring_forces(pattern, springs, x, f);
  const ListDispersion<Real> dispersion = dispersion_.front().arrays();
  old_J_.swap(J_);
  J_.assign(blocks_.order.size(), 0);
  kernels_->inflow(pattern, springs, dispersion, x, J_.data(), inverse_length_.data());
  dispersion_.front().share(J_);
  const std::vector<Real>& J = lagged && !old_J_.empty() ? old_J_ : J_;
  kernels_->dispersed_forces(pattern, springs, dispersion, x, J.data(), inverse_length_.data(), f);
}

template <class Real>
void ListForces<Real>::add_blocks(long begin, long end, const Padded<Real>* x, const Padded<Real>*, Padded<Real>* f) {
  kernels_->spring_forces(blocks_.pattern(begin, end),
                          {k_.data() + block_springs * begin, kL_.data() + block_springs * begin, nullptr}, x, f);
}

template <class Real>
void ListForces<Real>::at(const NodalVectors& x, NodalVectors& f) {
  by_place(blocks_.order, x.data(), 1, x_);
  std::fill(f_.begin(), f_.end(), Padded<Real>{});
  add(x_.data(), nullptr, f_.data(), false);
  f.resize(x.rows(), 3);
  by_node(blocks_.order, f_, 1, f.data());
}

template class ListForces<double>;
template class ListForces<float>;

}  // namespace springproof
