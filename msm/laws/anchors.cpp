#include "msm/laws/anchors.h"

namespace springproof {
namespace {

const Hexahedron& nodes_of(const Network&, const Anchor& anchor) { return anchor.corners; }
const MacroCell& nodes_of(const Network& network, const MacroAnchor& anchor) {
  return network.macro_cells[anchor.cell];
}

/// Calls act(anchor, its nodes) for anchors of cells and of macro-cells.
template <class Act>
void for_each_anchor(const Network& network, const Act& act) {
  for (const Anchor& a : network.anchors) act(a, nodes_of(network, a));
  for (const MacroAnchor& a : network.macro_anchors) act(a, nodes_of(network, a));
}

Vec3 stretch(const auto& anchor, const auto& nodes, const NodalVectors& x) {
  Vec3 d = -x.row(anchor.node).transpose();
  for (std::size_t n = 0; n < nodes.size(); ++n) d += anchor.weights[n] * x.row(nodes[n]).transpose();
  return d;
}

}  // namespace

double Anchors::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for_each_anchor(
      network, [&](const auto& a, const auto& nodes) { sum += a.stiffness / 2 * stretch(a, nodes, x).squaredNorm(); });
  return sum;
}

void Anchors::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for_each_anchor(network, [&](const auto& a, const auto& nodes) {
    const Vec3 force = a.stiffness * stretch(a, nodes, x);
    f.row(a.node) += force.transpose();
    for (std::size_t n = 0; n < nodes.size(); ++n) f.row(nodes[n]) -= a.weights[n] * force.transpose();
  });
}

void Anchors::add_tangent(const Network& network, const NodalVectors&, BlockMatrix& K) const {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for_each_anchor(network, [&](const auto& a, const auto& nodes) {
    K.add(a.node, a.node, a.stiffness * I);
    for (std::size_t m = 0; m < nodes.size(); ++m) {
      K.add(a.node, nodes[m], -a.stiffness * a.weights[m] * I);
      K.add(nodes[m], a.node, -a.stiffness * a.weights[m] * I);
      for (std::size_t n = 0; n < nodes.size(); ++n)
        K.add(nodes[m], nodes[n], a.stiffness * a.weights[m] * a.weights[n] * I);
    }
  });
}

}  // namespace springproof
