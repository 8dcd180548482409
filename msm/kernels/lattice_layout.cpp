#include "msm/kernels/lattice_layout.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

using Place = std::array<int, 3>;

/// Integer coordinates of the nodes, counted from the lowest corner; empty if they are not on a lattice.
std::vector<Place> places_of(const Network& network) {
  const double edge = network.cells.edge;
  if (!(edge > 0) || network.nodes() == 0) return {};
  const Eigen::RowVector3d origin = network.X.colwise().minCoeff();
  std::vector<Place> places(network.nodes());
  for (int n = 0; n < network.nodes(); ++n)
    for (int d = 0; d < 3; ++d) {
      const double at = (network.X(n, d) - origin[d]) / edge;
      if (!(std::abs(at - std::round(at)) < 1e-8 * std::max(1.0, at)) || at > 1e6) return {};
      places[n][d] = static_cast<int>(std::round(at));
    }
  return places;
}

Place extent_of(const std::vector<Place>& places) {
  Place extent = {0, 0, 0};
  for (const Place& p : places)
    for (int d = 0; d < 3; ++d) extent[d] = std::max(extent[d], p[d] + 1);
  return extent;
}

bool springs_fit(const Network& network, const std::vector<Place>& places) {
  for (const Spring& s : network.springs) {
    int square = 0;
    for (int d = 0; d < 3; ++d) {
      const int step = std::abs(places[s.j][d] - places[s.i][d]);
      if (step > 1) return false;
      square += step;
    }
    if (square == 0 || std::abs(s.rest_length - network.cells.edge * std::sqrt(double(square))) > 1e-9 * s.rest_length)
      return false;
  }
  return true;
}

bool cells_fit(const Network& network, const std::vector<Place>& places) {
  for (const Hexahedron& cell : network.cells.corners)
    for (int n = 0; n < 8; ++n)
      for (int d = 0; d < 3; ++d)
        if (places[cell[n]][d] - places[cell[0]][d] != hexahedron_corners[n][d] - hexahedron_corners[0][d])
          return false;
  return true;
}

bool one_node_per_place(std::vector<Place> places) {
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end();
}

long rounded_up(long n, long to) { return (n + to - 1) / to * to; }

/// Axes of space assigned to x, y and z of the arrays.
Place axes_for(const Place& extent, int lanes) {
  const auto waste = [&](int d) { return double(rounded_up(extent[d], lanes)) / extent[d]; };
  Place axis = {0, 1, 2};
  std::stable_sort(axis.begin(), axis.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  std::rotate(axis.begin(),
              std::min_element(axis.begin(), axis.end(), [&](int a, int b) { return waste(a) < waste(b); }),
              axis.end());
  if (extent[axis[1]] > extent[axis[2]]) std::swap(axis[1], axis[2]);
  return axis;
}

struct Direction {
  bool from_first;  ///< the spring starts from its node i
  int number;       ///< of lattice_directions
};

/// Direction of a spring in the kernels; d = places[j] - places[i] along the arrays' axes.
Direction direction_of(Place d) {
  const bool forward = d[2] > 0 || (d[2] == 0 && (d[1] > 0 || (d[1] == 0 && d[0] > 0)));
  if (!forward) d = {-d[0], -d[1], -d[2]};
  int pair = 0;
  while (row_pairs[pair][0] != d[1] || row_pairs[pair][1] != d[2]) ++pair;
  return {forward, pair == 0 ? 0 : 3 * pair - 2 + (d[0] == 0 ? 0 : d[0] > 0 ? 1 : 2)};
}

/// Coefficients of all blocks, one after the other.
class BlockCoefficients {
 public:
  BlockCoefficients(const LatticeLayout& l, int per_block)
      : l_(l), size_(per_block * l.lanes), values_(std::size_t(l.rows()) * l.row_blocks * size_, 0.0) {}

  double& at(int slot, int number) {
    return values_[std::size_t(l_.block_of(slot)) * size_ + number * l_.lanes + slot % l_.plane % l_.row % l_.lanes];
  }
  const double* block(std::size_t number) const { return &values_[number * size_]; }

  /// Start of each block's coefficients in a table that stores equal blocks once.
  std::vector<int> table(std::vector<double>& values) const {
    CoefficientTable known(size_);
    std::vector<int> entries;
    for (std::size_t b = 0; b < values_.size() / size_; ++b) entries.push_back(known.entry(block(b)));
    values = known.values();
    return entries;
  }

 private:
  const LatticeLayout& l_;
  int size_;
  std::vector<double> values_;
};

/// Position of a spring among the coefficients.
struct PlaceOfSpring {
  int slot, direction;
  bool from_first;
};

PlaceOfSpring place_of(const Spring& s, const LatticeLayout& l) {
  const auto place = [&](int slot) -> Place {
    const long in_plane = slot % l.plane;
    return {int(in_plane % l.row), int(in_plane / l.row), int(slot / l.plane)};
  };
  const Place i = place(l.slot[s.i]), j = place(l.slot[s.j]);
  const Direction d = direction_of({j[0] - i[0], j[1] - i[1], j[2] - i[2]});
  return {l.slot[d.from_first ? s.i : s.j] + std::min(0, d.from_first ? j[0] - i[0] : i[0] - j[0]), d.number,
          d.from_first};
}

BlockCoefficients spring_coefficients(const MassSpringModel& model, const LatticeLayout& l, bool viscous) {
  const Network& network = model.network;
  BlockCoefficients c(l, lattice_coefficients);
  const bool has_springs = law_of<Springs>(model) != nullptr;
  for (const Spring& s : network.springs) {
    const PlaceOfSpring p = place_of(s, l);
    if (has_springs) c.at(p.slot, p.direction) += s.stiffness * network.cells.edge;
  }
  const auto* volume = law_of<VolumeCorrection>(model);
  const bool hourglass = viscous || law_of<HourglassCorrection>(model) || law_of<AveragedSprings>(model);
  if (!volume && !hourglass) return c;
  for (const Hexahedron& cell : network.cells.corners) {
    int low = l.slot[cell[0]];
    for (int n : cell) low = std::min(low, l.slot[n]);
    if (volume) c.at(low, kappa_coefficient) += volume->kappa * network.cells.edge * network.cells.edge;
    if (hourglass) c.at(low, hourglass_coefficient) = 1;
  }
  return c;
}

/// `ends`: per spring at i and j.
BlockCoefficients flow_coefficients_of(const std::vector<std::array<double, 2>>& ends, const Network& network,
                                       const LatticeLayout& l) {
  BlockCoefficients c(l, flow_coefficients);
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const PlaceOfSpring p = place_of(network.springs[n], l);
    c.at(p.slot, 2 * p.direction) = ends[n][p.from_first ? 0 : 1];
    c.at(p.slot, 2 * p.direction + 1) = ends[n][p.from_first ? 1 : 0];
  }
  return c;
}

/// In the conservative form the outflow coefficients are the inflow coefficients times a factor per node, whose square
/// root is applied to each.
void add_flows(const MomentumDispersion& law, const Network& network, LatticeLayout& l) {
  MomentumDispersion::Coefficients c = law.coefficients(network);
  for (auto& ends : c.in)
    for (double& in : ends) in *= network.cells.edge;  // of elongations in edges
  if (has_energy(law.form)) {
    for (std::size_t n = 0; n < c.in.size(); ++n)
      for (int end = 0; end < 2; ++end)
        c.in[n][end] = std::copysign(std::sqrt(std::abs(c.in[n][end] * c.out[n][end])), c.in[n][end]);
    l.outflow_sign = law.q < 0 ? -1 : 1;
  } else {
    l.outflow_entry = flow_coefficients_of(c.out, network, l).table(l.outflow);
  }
  l.inflow_entry = flow_coefficients_of(c.in, network, l).table(l.inflow);
}

/// Marks, per block of the lattice, the directions whose springs have non-zero coefficients in the table.
void mark_flows(const LatticeLayout& l, const std::vector<int>& entries, const std::vector<double>& table,
                std::vector<unsigned>& flows) {
  for (std::size_t b = 0; b < entries.size(); ++b)
    for (int c = 0; c < flow_coefficients * l.lanes; ++c)
      if (table[entries[b] + c] != 0) flows[b] |= 1u << c / l.lanes / 2;
}

/// Marks a pair's straight springs where its slanted ones take part in dispersion: the kernels have no case for slanted
/// ones alone.
unsigned with_straight_flows(const LatticeRun& run) {
  unsigned flows = run.flows;
  for (int pair = 1; pair < lattice_pairs; ++pair)
    if (flows >> (3 * pair - 2) & 6) flows |= run.springs & 1u << (3 * pair - 2);
  return flows;
}

/// Adds the runs of a row, given the coefficients of its blocks, their flows, and which of them hold nodes.
void add_runs(const LatticeLayout& l, const double* row, const unsigned* flows, const char* has_node,
              std::vector<LatticeRun>& runs) {
  const auto first = runs.size();
  bool open = false, crossing = false;  // crossing: the block before has springs or cells that end in this one
  for (int b = 0; b < l.row_blocks; ++b) {
    const double* block = row + std::size_t(b) * lattice_coefficients * l.lanes;
    LatticeRun found = {b, b + 1, 0, flows[b], false, false};
    bool crosses = false;
    for (int d = 0; d < lattice_coefficients; ++d)
      for (int lane = 0; lane < l.lanes; ++lane) {
        if (block[d * l.lanes + lane] == 0) continue;
        if (d < lattice_directions)
          found.springs |= 1u << d;
        else
          (d == kappa_coefficient ? found.volume : found.hourglass) = true;
        crosses = crosses || lane == l.lanes - 1;
      }
    const bool active = has_node[b] || found.springs || found.volume || found.hourglass || crossing;
    if (active && open) {
      runs.back().end = b + 1;
      runs.back().springs |= found.springs;
      runs.back().flows |= found.flows;
      runs.back().volume = runs.back().volume || found.volume;
      runs.back().hourglass = runs.back().hourglass || found.hourglass;
    } else if (active) {
      runs.push_back(found);
    }
    open = active;
    crossing = crosses;
  }
  for (auto run = runs.begin() + first; run != runs.end(); ++run) run->flows = with_straight_flows(*run);
}

}  // namespace

int CoefficientTable::entry(const double* block) {
  const std::string_view bytes(reinterpret_cast<const char*>(block), size_ * sizeof(double));
  const std::uint64_t hash = std::hash<std::string_view>{}(bytes);
  const auto [begin, end] = known_.equal_range(hash);
  for (auto it = begin; it != end; ++it)
    if (std::memcmp(&values_[it->second], block, bytes.size()) == 0) return it->second;
  const auto start = static_cast<int>(values_.size());
  values_.insert(values_.end(), block, block + size_);
  known_.emplace(hash, start);
  return start;
}

int LatticeLayout::block_of(int s) const {
  const long in_plane = s % plane;
  return static_cast<int>((s / plane * nodes[1] + in_plane / row) * row_blocks + in_plane % row / lanes);
}

LatticeCurve lattice_curve(StrainCurve curve) {
  switch (curve) {
    case StrainCurve::hencky:
      return LatticeCurve::hencky;
    case StrainCurve::neo_hooke:
      return LatticeCurve::neo_hooke;
    case StrainCurve::neo_hooke_isochoric:
      return LatticeCurve::neo_hooke_isochoric;
    case StrainCurve::springs_hencky:
    case StrainCurve::springs_neo_hooke:
      break;
  }
  return LatticeCurve::none;
}

bool is_lattice_of_springs(const MassSpringModel& model) {
  const Network& network = model.network;
  if (!can(model, Capability::lattice_kernels)) return false;
  const std::vector<Place> places = places_of(network);
  if (places.empty() || !springs_fit(network, places) || !cells_fit(network, places) || !one_node_per_place(places))
    return false;
  const Place extent = extent_of(places);
  double box = 1;
  for (int n : extent) box *= n + 16;  // with the padding of the rows
  return box * lattice_coefficients < std::numeric_limits<int>::max() && box < 64.0 * network.nodes() + 1e6;
}

LatticeLayout lattice_layout(const MassSpringModel& model, int lanes, int bytes_per_value, bool viscous) {
  const Network& network = model.network;
  const std::vector<Place> places = places_of(network);
  const Place extent = extent_of(places);
  LatticeLayout l;
  l.lanes = lanes;
  l.axis = axes_for(extent, lanes);
  for (int d = 0; d < 3; ++d) l.nodes[d] = extent[l.axis[d]];
  l.row_blocks = static_cast<int>(rounded_up(l.nodes[0], lanes) / lanes);
  l.row = rounded_up(l.nodes[0] + 1, lanes);  // at least one place without a node at the end of a row
  const long line = 64 / bytes_per_value;
  l.plane = rounded_up(l.nodes[1] * l.row, line) + 5 * line;  // no power of two, or planes would share cache sets
  l.size = l.plane * l.nodes[2] + lanes;
  std::vector<char> has_node(std::size_t(l.rows()) * l.row_blocks, 0);
  for (const Place& p : places) {
    l.slot.push_back(static_cast<int>(p[l.axis[2]] * l.plane + p[l.axis[1]] * l.row + p[l.axis[0]]));
    has_node[l.block_of(l.slot.back())] = 1;
  }
  const BlockCoefficients coefficients = spring_coefficients(model, l, viscous);
  l.spring_entry = coefficients.table(l.springs);
  if (const MomentumDispersion* dispersion = dispersion_of(model)) add_flows(*dispersion, network, l);
  std::vector<unsigned> flows(l.spring_entry.size(), 0);
  mark_flows(l, l.inflow_entry, l.inflow, flows);
  mark_flows(l, l.outflow_entry, l.outflow, flows);
  l.first_run.push_back(0);
  for (long row = 0; row < l.rows(); ++row) {
    add_runs(l, coefficients.block(row * l.row_blocks), &flows[row * l.row_blocks], &has_node[row * l.row_blocks],
             l.runs);
    l.first_run.push_back(static_cast<int>(l.runs.size()));
  }
  return l;
}

std::vector<int> split_planes(const LatticeLayout& l, int slabs) {
  std::vector<double> work(l.nodes[2] + 1, 0.0);  // cumulative: of the planes below
  for (int z = 0; z < l.nodes[2]; ++z) {
    work[z + 1] = work[z] + 1e-3;
    for (int r = l.first_run[long(z) * l.nodes[1]]; r < l.first_run[long(z + 1) * l.nodes[1]]; ++r)
      work[z + 1] += (l.runs[r].end - l.runs[r].begin) * (1.0 + __builtin_popcount(l.runs[r].springs));
  }
  std::vector<int> begin = {0};
  for (int s = 1; s < slabs; ++s) {
    const double share = work.back() * s / slabs;
    const auto above = std::lower_bound(work.begin(), work.end(), share);
    int z = static_cast<int>(above - work.begin());
    if (z > 0 && share - work[z - 1] < work[z] - share) --z;
    begin.push_back(std::clamp(z, begin.back() + 1, l.nodes[2] - (slabs - s)));
  }
  begin.push_back(l.nodes[2]);
  return begin;
}

}  // namespace springproof
