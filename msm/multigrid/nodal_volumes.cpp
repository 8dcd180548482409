#include "msm/multigrid/nodal_volumes.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "meshes/lists.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

constexpr int slots = 13;  // directions away from a point, up to sign

/// The springs of a lattice by the point that they leave and their direction.
struct SpringsOfPoints {
  std::vector<int> spring;  ///< 13 per point; -1: none
  std::vector<long> other;  ///< point at the far end

  SpringsOfPoints(const Network& network, const LatticeLevels& lattice)
      : spring(slots * lattice.levels[0].points(), -1), other(spring.size()) {
    const auto& index = lattice.levels[0].point_index;
    for (std::size_t s = 0; s < network.springs.size(); ++s) {
      long i = lattice.point_of_node[network.springs[s].i], j = lattice.point_of_node[network.springs[s].j];
      if (i > j) std::swap(i, j);  // points are numbered along x, then y, then z
      const auto &a = index[i], &b = index[j];
      const std::size_t place = slots * i + (b[0] - a[0]) + 3 * (b[1] - a[1]) + 9 * (b[2] - a[2]) - 1;
      spring[place] = static_cast<int>(s);
      other[place] = j;
    }
  }
};

/// Unit vectors, three components each.
std::vector<double> unit_directions() {
  std::vector<double> directions;
  for (int step = 1; step <= slots; ++step) {  // x + 3 y + 9 z
    const int z = (step + 4) / 9, y = (step - 9 * z + 4) / 3 - 1, x = step - 9 * z - 3 * y;
    const Vec3 e = Vec3(x, y, z).normalized();
    directions.insert(directions.end(), {e[0], e[1], e[2]});
  }
  return directions;
}

bool same_row(const std::array<int, 3>& a, const std::array<int, 3>& b) { return a[1] == b[1] && a[2] == b[2]; }

/// Contribution of a spring to a row of B: `weight` times the elongation of spring i to j.
struct RowEntry {
  long i, j;
  int direction;
  double weight;
};

/// Rows of B, each as a list of the contributions of springs.
Lists<RowEntry> rows_of(const NodalVolumes& volumes, long points) {
  std::vector<long> sink(points);
  std::iota(sink.begin(), sink.end(), 0);
  for (const auto& [member, of] : volumes.members) sink[member] = of;
  return Lists<RowEntry>(points, [&](const auto& add) {
    for (const SpringRun& run : volumes.runs)
      for (int s = 0; s < run.length; ++s) {
        add(sink[run.i + s], RowEntry{run.i + s, run.j + s, run.direction, volumes.weight_i[run.spring + s]});
        add(sink[run.j + s], RowEntry{run.i + s, run.j + s, run.direction, volumes.weight_j[run.spring + s]});
      }
  });
}

}  // namespace

NodalVolumes::NodalVolumes(const MassSpringModel& model, const LatticeLevels& lattice, double G)
    : directions(unit_directions()) {
  if (!can(model, Capability::nodal_pressures))
    throw std::invalid_argument("nodal pressures are of the energy form of dispersion on a lattice, q > 0");
  const Network& network = model.network;
  const MomentumDispersion& law = *dispersion_of(model);
  const MomentumDispersion::Coefficients c = law.coefficients(network);
  // J = 10 G times a change of volume, of energy q J^2 / (2 sum w L).
  const double l = network.cells.edge, to_volume = 1 / (10 * G * l * l),
               to_compliance = 1 / (100 * law.q * G * l * l * l);
  const LatticeLevel& level = lattice.levels[0];
  compliance = Eigen::VectorXd::Zero(level.stride());
  for (int n = 0; n < network.nodes(); ++n)
    if (const int sink = law.sink(network, n); sink != n)
      members.push_back({lattice.point_of_node[n], lattice.point_of_node[sink]});
  const SpringsOfPoints at(network, lattice);
  const auto& index = level.point_index;
  for (long row = 0, end; row < level.points(); row = end) {
    for (end = row + 1; end < level.points() && same_row(index[end], index[row]);) ++end;
    for (int slot = 0; slot < slots; ++slot)
      for (long p = row; p < end; ++p) {
        const int s = at.spring[slots * p + slot];
        if (s < 0 || (c.in[s][0] == 0 && c.in[s][1] == 0)) continue;
        const long j = at.other[slots * p + slot], next = static_cast<long>(weight_i.size());
        const bool goes_on = p > row && !runs.empty() && runs.back().direction == slot &&
                             runs.back().i + runs.back().length == p && runs.back().j + runs.back().length == j &&
                             runs.back().length < longest_cell_row;
        if (!goes_on) runs.push_back({p, j, next, 0, slot});
        ++runs.back().length;
        const Spring& spring = network.springs[s];
        const bool swapped = lattice.point_of_node[spring.i] != p;
        weight_i.push_back(to_volume * c.in[s][swapped]);
        weight_j.push_back(to_volume * c.in[s][!swapped]);
        for (int side = 0; side < 2; ++side)
          compliance[lattice.point_of_node[law.sink(network, side == 0 ? spring.i : spring.j)]] +=
              to_compliance * c.in[s][side] * spring.rest_length;
      }
  }
}

Eigen::VectorXd NodalVolumes::schur_diagonal(const LatticeLevel& level, const Eigen::VectorXf& D) const {
  const Lists<RowEntry> rows = rows_of(*this, level.points());
  const long stride = level.stride();
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(stride);
  std::vector<Vec3> row(level.points(), Vec3::Zero());
  for (long p = 0; p < level.points(); ++p) {
    for (const RowEntry& entry : rows[p]) {
      const Vec3 w = entry.weight * Eigen::Map<const Vec3>(&directions[3 * entry.direction]);
      row[entry.j] += w;
      row[entry.i] -= w;
    }
    for (const RowEntry& entry : rows[p])
      for (const long point : {entry.i, entry.j}) {
        for (int a = 0; a < 3; ++a) diagonal[p] += D[a * stride + point] * row[point][a] * row[point][a];
        row[point].setZero();  // counted
      }
  }
  return diagonal;
}

template <class Real>
NodalVolumeOperator<Real>::NodalVolumeOperator(const NodalVolumes& volumes, long stride, InstructionSet set)
    : kernels_(&kernels_of<Real>(set).cells),
      runs_(volumes.runs),
      members_(volumes.members),
      pressure_(Vector::Zero(stride)),
      stride_(stride) {
  const auto converted = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())).cast<Real>().eval();
  };
  directions_ = converted(volumes.directions);
  weight_i_ = converted(volumes.weight_i);
  weight_j_ = converted(volumes.weight_j);
}

template <class Real>
void NodalVolumeOperator<Real>::change(const Real* u, Real* J) const {
  const Real* const components[3] = {u, u + stride_, u + 2 * stride_};
  std::fill_n(J, stride_, Real(0));
  kernels_->inflow(runs_.data(), static_cast<long>(runs_.size()), directions_.data(), weight_i_.data(),
                   weight_j_.data(), components, J);
  for (const auto& [member, of] : members_) {
    J[of] += J[member];
    J[member] = 0;
  }
}

template <class Real>
void NodalVolumeOperator<Real>::add_forces(const Real* p, Real* y) const {
  std::copy_n(p, stride_, pressure_.data());
  for (const auto& [member, of] : members_) pressure_[member] = p[of];
  Real* const components[3] = {y, y + stride_, y + 2 * stride_};
  kernels_->outflow(runs_.data(), static_cast<long>(runs_.size()), directions_.data(), weight_i_.data(),
                    weight_j_.data(), pressure_.data(), components);
}

template class NodalVolumeOperator<float>;
template class NodalVolumeOperator<double>;

}  // namespace springproof
