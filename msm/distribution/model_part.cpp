#include "msm/distribution/model_part.h"

#include <algorithm>
#include <stdexcept>

namespace springproof {
namespace {

using Marks = std::vector<char>;

/// The nodes that an element acts on: of carried ones those that carry them.
class ActsOn {
 public:
  ActsOn(const Network& network, const Marks& marked)
      : carriers_(carriers_of(network.nodes(), network.carried)), marked_(marked) {}

  bool node(int n) const {
    if (carriers_.empty() || carriers_[n].empty()) return marked_[n];
    return std::any_of(carriers_[n].begin(), carriers_[n].end(), [&](const auto& c) { return marked_[c.first]; });
  }
  template <class Nodes>
  bool any(const Nodes& nodes) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](int n) { return node(n); });
  }

 private:
  Carriers carriers_;
  const Marks& marked_;
};

/// Nodes whose springs the forces on own nodes depend on: with momentum dispersion all that share the inflow of an own
/// node or of a neighbour of one.
Marks nodes_with_springs(const MassSpringModel& whole, const Marks& own) {
  const MomentumDispersion* dispersion = dispersion_of(whole);
  if (!dispersion) return own;
  const Network& network = whole.network;
  Marks near = own, sink(own.size()), marked(own.size());
  for (const Spring& s : network.springs) {
    if (own[s.i]) near[s.j] = 1;
    if (own[s.j]) near[s.i] = 1;
  }
  for (int n = 0; n < network.nodes(); ++n)
    if (near[n]) sink[dispersion->sink(network, n)] = 1;
  for (int n = 0; n < network.nodes(); ++n) marked[n] = sink[n] || sink[dispersion->sink(network, n)];
  return marked;
}

/// The elements that stay, and the nodes that they need.
class Selection {
 public:
  Selection(const MassSpringModel& whole, const Marks& own) : whole_(whole), needed_(own) {
    const Network& network = whole.network;
    const Marks with_springs = nodes_with_springs(whole, own);
    select(network.springs, springs_, with_springs, [](const Spring& s) { return std::array{s.i, s.j}; });
    select(network.cells, cells_, own, [](const Hexahedron& c) { return c; });
    select(network.triangles, triangles_, own, [](const std::array<int, 3>& t) { return t; });
    select(network.anchors, anchors_, own, [](const Anchor& a) {
      std::array<int, 9> nodes;
      std::copy(a.corners.begin(), a.corners.end(), nodes.begin());
      nodes[8] = a.node;
      return nodes;
    });
    for (auto c = network.carried.rbegin(); c != network.carried.rend(); ++c)
      if (needed_[c->point])
        for (const int p : c->by) needed_[p] = 1;
    number_.assign(needed_.size(), -1);
    for (std::size_t n = 0; n < needed_.size(); ++n)
      if (needed_[n]) {
        number_[n] = static_cast<int>(nodes_.size());
        nodes_.push_back(static_cast<int>(n));
      }
  }

  ModelPart part(const Marks& own) const {
    ModelPart part{{network(), whole_.laws, whole_.small_displacements_only}, nodes_, cells_, {}};
    for (const int n : nodes_) part.own.push_back(own[n]);
    for (ForceLaw& law : part.model.laws)
      if (auto* dispersion = std::get_if<MomentumDispersion>(&law)) restrict(*dispersion);
    return part;
  }

 private:
  template <class Element, class NodesOf>
  void select(const std::vector<Element>& elements, std::vector<int>& selected, const Marks& marked, NodesOf nodes_of) {
    const ActsOn acts(whole_.network, marked);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const auto nodes = nodes_of(elements[e]);
      if (!acts.any(nodes)) continue;
      selected.push_back(static_cast<int>(e));
      for (const int n : nodes) needed_[n] = 1;
    }
  }

  template <class Nodes>
  Nodes renumbered(Nodes nodes) const {
    for (int& n : nodes) n = number_[n];
    return nodes;
  }

  Network network() const {
    const Network& all = whole_.network;
    Network part;
    part.X = all.X(nodes_, Eigen::all);
    if (all.volume.size() > 0) part.volume = all.volume(nodes_);
    part.cell_edge = all.cell_edge;
    part.proportions = all.proportions;
    part.cell_springs = all.cell_springs;
    for (const int s : springs_) {
      part.springs.push_back(all.springs[s]);
      part.springs.back().i = number_[all.springs[s].i];
      part.springs.back().j = number_[all.springs[s].j];
    }
    for (const int c : cells_) {
      part.cells.push_back(renumbered(all.cells[c]));
      if (!all.cell_edges.empty()) part.cell_edges.push_back(all.cell_edges[c]);
      if (!all.filled.empty()) part.filled.push_back(all.filled[c]);
    }
    for (const int t : triangles_) part.triangles.push_back(renumbered(all.triangles[t]));
    for (const int a : anchors_) {
      part.anchors.push_back(all.anchors[a]);
      part.anchors.back().corners = renumbered(all.anchors[a].corners);
      part.anchors.back().node = number_[all.anchors[a].node];
    }
    for (const CarriedPoint& c : all.carried)
      if (needed_[c.point]) part.carried.push_back({number_[c.point], renumbered(c.by)});
    return part;
  }

  void restrict(MomentumDispersion& law) const {
    if (!law.weight.empty()) {
      std::vector<double> weight;
      for (const int s : springs_) weight.insert(weight.end(), {law.weight[2 * s], law.weight[2 * s + 1]});
      law.weight = std::move(weight);
    }
    if (law.group.empty()) return;
    std::vector<int> group;
    for (const int n : nodes_) {
      const int sink = number_[law.group[n]];
      group.push_back(sink >= 0 ? sink : number_[n]);  // that of a node beside the part is not complete anyway
    }
    law.group = std::move(group);
  }

  const MassSpringModel& whole_;
  Marks needed_;
  std::vector<int> springs_, cells_, triangles_, anchors_, nodes_, number_;
};

}  // namespace

ModelPart part_of(const MassSpringModel& whole, const std::vector<char>& own) {
  if (!whole.network.image_of.empty()) throw std::invalid_argument("a periodic network is not parted");
  if (!conservative(whole)) throw std::invalid_argument("its forces have no energy, so its stiffness is not symmetric");
  if (const MomentumDispersion* dispersion = dispersion_of(whole);
      dispersion && dispersion->form == Dispersion::finite_strain)
    throw std::invalid_argument("momentum dispersion of finite strain is not parted");
  return Selection(whole, own).part(own);
}

std::vector<std::vector<int>> neighbours(const Network& network, int first, int last) {
  std::vector<std::vector<int>> rows(last - first);
  const auto couple = [&](const auto& nodes) {
    for (const int n : nodes)
      if (n >= first && n < last) rows[n - first].insert(rows[n - first].end(), nodes.begin(), nodes.end());
  };
  for (const Spring& s : network.springs) couple(std::array{s.i, s.j});
  for (const Hexahedron& c : network.cells) couple(c);
  for (const auto& t : network.triangles) couple(t);
  for (const CarriedPoint& c : network.carried)
    for (const int p : c.by) couple(std::array{c.point, p});
  for (const Anchor& a : network.anchors)
    for (const int corner : a.corners) couple(std::array{a.node, corner});
  for (int n = first; n < last; ++n) {
    std::vector<int>& row = rows[n - first];
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    row.erase(std::remove(row.begin(), row.end(), n), row.end());
  }
  return rows;
}

}  // namespace springproof
