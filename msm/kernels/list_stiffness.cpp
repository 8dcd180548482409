#include "msm/kernels/list_stiffness.h"

#include <cmath>
#include <stdexcept>

#include "meshes/lists.h"
#include "msm/laws/capabilities.h"

namespace springproof {

template <class Real>
ListStiffness<Real>::ListStiffness(const MassSpringModel& model, std::shared_ptr<const SpringBlocks> blocks,
                                   InstructionSet set)
    : set_(set),
      kernels_(&kernels_of<Real>(set).list),
      blocks_(std::move(blocks)),
      m_(blocks_->entries(), Padded<Real>{}) {
  if (!can(model, Capability::list_stiffness))
    throw std::invalid_argument("list stiffness is of springs and momentum dispersion only");
  const Network& network = model.network;
  const MomentumDispersion* law = dispersion_of(model);
  if (law) dispersion_.emplace_back(*law, network, *blocks_);
  for (std::size_t e = 0; e < m_.size(); ++e) {
    if (blocks_->spring[e] < 0) continue;
    const int i = blocks_->order[blocks_->i[e / 4]], j = blocks_->order[blocks_->j[e]];
    const Eigen::RowVector3d d = network.X.row(j) - network.X.row(i);
    const double root = std::sqrt(network.springs[blocks_->spring[e]].stiffness), scale = root / d.norm();
    for (int axis = 0; axis < 3; ++axis) m_[e].v[axis] = static_cast<Real>(scale * d[axis]);
    if (!law) continue;  // the elongation is m . du / root, and a tension along the spring m T / root
    ListDispersionData<Real>& data = dispersion_.front();
    for (std::vector<Real>* values : {&data.a_i, &data.a_j, &data.c_i, &data.c_j})
      (*values)[e] /= static_cast<Real>(root);
  }
  if (law) kept_.resize(blocks_->entries());
}

template <class Real>
template <class Other>
ListStiffness<Real>::ListStiffness(const ListStiffness<Other>& other, double unit)
    : set_(other.set_),
      kernels_(&kernels_of<Real>(set_).list),
      blocks_(other.blocks_),
      m_(other.m_.size()),
      kept_(other.kept_.size()) {
  const double root = std::sqrt(unit);
  for (std::size_t e = 0; e < m_.size(); ++e)
    for (int d = 0; d < 4; ++d) m_[e].v[d] = static_cast<Real>(other.m_[e].v[d] / root);
  for (const auto& data : other.dispersion_) dispersion_.emplace_back(data);  // already quadratic in m
}

template <class Real>
void ListStiffness<Real>::add(const Padded<Real>* u, Padded<Real>* y) const {
  const ListPattern pattern = blocks_->pattern();
  if (dispersion_.empty()) return kernels_->stiffness(pattern, m_.data(), u, y);
  const ListDispersion<Real> dispersion = dispersion_.front().arrays();
  J_.assign(blocks_->order.size(), 0);
  kernels_->linear_inflow(pattern, m_.data(), dispersion, u, J_.data(), kept_.data());
  dispersion_.front().share(J_);
  kernels_->linear_forces(pattern, m_.data(), dispersion, J_.data(), kept_.data(), y);
}

template <class Real>
void ListStiffness<Real>::multiply(const Eigen::VectorXd& u, Eigen::VectorXd& y) const {
  by_place(blocks_->order, u.data(), 1, u_);
  y_.assign(u_.size(), Padded<Real>{});
  add(u_.data(), y_.data());
  y.resize(u.size());
  by_node(blocks_->order, y_, 1, y.data());
}

namespace {

/// Contribution of one node to one J, and its coefficient in the outflow.
struct Share {
  int sink;
  Vec3 in, out;
};

}  // namespace

template <class Real>
void ListStiffness<Real>::add_flow_blocks(std::vector<Eigen::Matrix3d>& blocks) const {
  const Lists<int> entries(blocks.size(), [&](const auto& add) {
    for (int e = 0; e < static_cast<int>(blocks_->entries()); ++e) {
      add(blocks_->i[e / 4], e);
      add(blocks_->j[e], e);
    }
  });
  const ListDispersionData<Real>& data = dispersion_.front();
  const auto sink = [&](int p) { return data.sink.empty() ? p : data.sink[p]; };
  std::vector<char> of_group(blocks.size(), 0);
  for (int p = 0; p < blocks_->nodes(); ++p)
    if (sink(p) != p) of_group[sink(p)] = 1;
  std::vector<Share> shares;
  for (int p = 0; p < blocks_->nodes(); ++p) {
    shares.assign(1, {sink(p), Vec3::Zero(), Vec3::Zero()});
    const auto add_share = [&](int to, const Vec3& in, const Vec3& out) {
      auto known = shares.begin();
      if (to != known->sink && !of_group[to]) {  // only one spring contributes
        blocks[p] += out * in.transpose();
        return;
      }
      while (known != shares.end() && known->sink != to) ++known;
      if (known == shares.end()) known = shares.insert(known, {to, Vec3::Zero(), Vec3::Zero()});
      known->in += in;
      known->out += out;
    };
    for (const int e : entries[p]) {
      const int i = blocks_->i[e / 4], j = blocks_->j[e];
      const double sign = i == p ? -1 : 1;
      const Vec3 m(sign * m_[e].v[0], sign * m_[e].v[1], sign * m_[e].v[2]);
      add_share(sink(i), data.a_i[e] * m, data.c_i[e] * m);
      add_share(sink(j), data.a_j[e] * m, data.c_j[e] * m);
    }
    for (const Share& share : shares) blocks[p] += share.out * share.in.transpose();
  }
}

template <class Real>
std::vector<Eigen::Matrix3d> ListStiffness<Real>::node_blocks() const {
  std::vector<Eigen::Matrix3d> blocks(blocks_->order.size(), Eigen::Matrix3d::Zero());
  for (std::size_t e = 0; e < m_.size(); ++e) {
    const Vec3 m(m_[e].v[0], m_[e].v[1], m_[e].v[2]);
    const Eigen::Matrix3d k = m * m.transpose();
    blocks[blocks_->i[e / 4]] += k;
    blocks[blocks_->j[e]] += k;
  }
  if (!dispersion_.empty()) add_flow_blocks(blocks);
  return blocks;
}

template <class Real>
Eigen::VectorXd ListStiffness<Real>::diagonal() const {
  const std::vector<Eigen::Matrix3d> blocks = node_blocks();
  Eigen::VectorXd d(static_cast<Eigen::Index>(3 * blocks.size()));
  for (std::size_t p = 0; p < blocks.size(); ++p) d.segment<3>(3 * blocks_->order[p]) = blocks[p].diagonal();
  return d;
}

template class ListStiffness<double>;
template class ListStiffness<float>;
template ListStiffness<float>::ListStiffness(const ListStiffness<double>&, double);

}  // namespace springproof
