#include "msm/distribution/model_part.h"

#include <algorithm>
#include <stdexcept>

namespace springproof {
namespace {

using Marks = std::vector<char>;

/// Marks a carried node if one that carries it is marked, as what acts on it acts on those.
Marks with_carried(const Network& network, Marks marked) {
  const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  for (const CarriedPoint& c : network.cells.carried)
    marked[c.point] = std::any_of(carriers[c.point].begin(), carriers[c.point].end(),
                                  [&](const auto& carrier) { return marked[carrier.first]; });
  return marked;
}

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

/// Numbers of the elements with a marked node.
template <class Element, class NodesOf>
std::vector<int> acting(const std::vector<Element>& elements, const Marks& marked, NodesOf nodes_of) {
  std::vector<int> numbers;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto nodes = nodes_of(elements[e]);
    if (std::any_of(nodes.begin(), nodes.end(), [&](int n) { return marked[n]; }))
      numbers.push_back(static_cast<int>(e));
  }
  return numbers;
}

template <class Element>
std::vector<Element> of_numbers(const std::vector<Element>& all, const std::vector<int>& numbers) {
  std::vector<Element> some;
  for (const int number : numbers) some.push_back(all[number]);
  return some;
}

/// Leaves a law the values of a part's springs and cells (law_traits.h); nodes keep their numbers.
struct PartOfLaws {
  const std::vector<int>& springs;
  std::size_t all_springs;
  const std::vector<int>& cells;
  std::size_t all_cells;

  void number(const char*, double, double = 0, double = 0) const {}
  void flag(const char*, bool) const {}
  template <class Enum>
  void choice(const char*, Enum) const {}
  void of_nodes(const char*, const std::vector<int>&) const {}
  void of_springs(const char*, std::vector<double>& values) const { keep(springs, all_springs, values); }
  void of_cells(const char*, std::vector<double>& values, int = 1) const { keep(cells, all_cells, values); }

 private:
  static void keep(const std::vector<int>& numbers, std::size_t all, std::vector<double>& values) {
    if (values.empty()) return;
    const std::size_t each = values.size() / all;
    std::vector<double> kept;
    for (const int number : numbers)
      kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(each * number),
                  values.begin() + static_cast<std::ptrdiff_t>(each * (number + 1)));
    values = std::move(kept);
  }
};

std::array<int, 9> nodes_of_anchor(const Anchor& a) {
  std::array<int, 9> nodes;
  std::copy(a.corners.begin(), a.corners.end(), nodes.begin());
  nodes[8] = a.node;
  return nodes;
}

std::array<int, 16> nodes_of_bond(const InterfaceBond& b) {
  std::array<int, 16> nodes;
  std::copy(b.corners[1].begin(), b.corners[1].end(),
            std::copy(b.corners[0].begin(), b.corners[0].end(), nodes.begin()));
  return nodes;
}

}  // namespace

ModelPart part_of(const MassSpringModel& whole, const std::vector<char>& own_nodes) {
  if (!whole.network.image_of.empty()) throw std::invalid_argument("a periodic network is not parted");
  if (!can(whole, Capability::energy))
    throw std::invalid_argument("its forces have no energy, so its stiffness is not symmetric");
  if (const MomentumDispersion* dispersion = dispersion_of(whole);
      dispersion && dispersion->form == Dispersion::finite_strain)
    throw std::invalid_argument("momentum dispersion of finite strain is not parted");
  const Network& all = whole.network;
  const auto themselves = [](const auto& nodes) { return nodes; };
  const Marks own = with_carried(all, own_nodes);
  const std::vector<int> springs =
      acting(all.springs, with_carried(all, nodes_with_springs(whole, own_nodes)), [](const Spring& s) {
        return std::array{s.i, s.j};
      });
  ModelPart part{{{}, whole.laws, whole.small_displacements_only}, acting(all.cells.corners, own, themselves)};
  Network& network = part.model.network;
  network.X = all.X;
  network.volume = all.volume;
  network.attached = all.attached;
  network.springs = of_numbers(all.springs, springs);
  network.cells = all.cells.of(part.cells);
  network.triangles = of_numbers(all.triangles, acting(all.triangles, own, themselves));
  network.anchors = of_numbers(all.anchors, acting(all.anchors, own, nodes_of_anchor));
  network.bonds = of_numbers(all.bonds, acting(all.bonds, own, nodes_of_bond));
  PartOfLaws values{springs, all.springs.size(), part.cells, all.cells.size()};
  for (ForceLaw& law : part.model.laws) std::visit([&](auto& l) { l.fields(values); }, law);
  return part;
}

}  // namespace springproof
