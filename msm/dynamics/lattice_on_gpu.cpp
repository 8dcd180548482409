// LatticeMotion on a GPU.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/dynamics/lattice_motion.h"
#include "msm/gpu/gpu.h"
#include "msm/kernels/lattice_constants.h"
#include "msm/kernels/lattice_layout.h"

namespace springproof {
namespace {

template <class Real>
class LatticeOnGpu : public LatticeMotion {
 public:
  LatticeOnGpu(const MassSpringModel& model, double density, const MotionOptions& options)
      : LatticeMotion(model, density, options), steps_(lattice_of(model)) {
    u_.assign(3 * std::size_t(box_.size), 0);
    v_ = u_;
    LatticeOnGpu::set_conditions(no_conditions());
  }

  void set_conditions(const BoundaryConditions& conditions) override {
    const Eigen::VectorXd mass = masses(network_, density_);
    CoefficientTable table(gpu::values_of_load);
    std::vector<int> load(box_.size, gpu::no_node);
    support_places_.clear();
    support_values_.clear();
    for (int n = 0; n < network_.nodes(); ++n) {
      double entry[gpu::values_of_load];
      for (int d = 0; d < 3; ++d) {
        const bool fixed = conditions.fixed[3 * n + axis_[d]];
        entry[d] = fixed ? 0 : 1 / (mass[n] * edge_);
        entry[3 + d] = conditions.external(n, axis_[d]);
        if (!fixed) continue;
        support_places_.push_back(d * box_.size + place_[n]);
        support_values_.push_back(static_cast<Real>(conditions.prescribed(n, axis_[d]) / edge_));
      }
      load[place_[n]] = table.entry(entry);
    }
    steps_.set_loads(load, {table.values().begin(), table.values().end()});
    supports_wait_ = true;
  }

  void move_supports() override {
    steps_.set(support_places_, support_values_);
    supports_wait_ = false;
  }

  void read(int begin, int end, double* values) const override {
    steps_.read_u(u_);
    steps_.read_v(v_);
    for (int n = begin; n < end; ++n, values += 6)
      for (int d = 0; d < 3; ++d) {
        values[axis_[d]] = edge_ * u_[d * box_.size + place_[n]];
        values[3 + axis_[d]] = edge_ * v_[d * box_.size + place_[n]];
      }
  }

  void write(int begin, int end, const double* values) override {
    steps_.read_u(u_);
    steps_.read_v(v_);
    for (int n = begin; n < end; ++n, values += 6)
      for (int d = 0; d < 3; ++d) {
        u_[d * box_.size + place_[n]] = static_cast<Real>(values[axis_[d]] / edge_);
        v_[d * box_.size + place_[n]] = static_cast<Real>(values[3 + axis_[d]] / edge_);
      }
    steps_.write(u_, v_);
  }

  ForceNorms advance(long steps) override {
    const Real dt = static_cast<Real>(time_step_), decay = static_cast<Real>(1 / (1 + damping_ * time_step_));
    LatticeSums sums = {0, 0};
    if (supports_wait_ && steps > 0) {
      sums = steps_.advance(1, dt, decay);
      move_supports();
      --steps;
    }
    if (steps > 0) sums = steps_.advance(steps, dt, decay);
    return {std::sqrt(sums.free), std::sqrt(sums.fixed)};
  }

  NodalVectors positions() const override {
    steps_.read_u(u_);
    return network_.X + edge_ * in_network_order(u_);
  }
  NodalVectors velocities() const override {
    steps_.read_v(v_);
    return edge_ * in_network_order(v_);
  }
  NodalVectors forces() override { return in_network_order(steps_.forces()); }

  double bytes_per_node() const override { return steps_.bytes() / network_.nodes(); }
  std::string description() const override {
    const std::string name = gpu::device_name();
    return fmt::format("lattice kernel of {}, {} bits", name.empty() ? "GPUs, on the processor thread by thread" : name,
                       8 * sizeof(Real));
  }

 private:
  /// Finds the nodes' places and tells the GPU the model.
  gpu::LatticeForGpu<Real> lattice_of(const MassSpringModel& model);
  void find_places();
  void add_springs(std::vector<double>& kinds, int& reach) const;
  void add_cells(const VolumeCorrection* volume, std::vector<double>& kinds) const;

  NodalVectors in_network_order(const std::vector<Real>& values) const {
    NodalVectors result(network_.nodes(), 3);
    for (int n = 0; n < network_.nodes(); ++n)
      for (int d = 0; d < 3; ++d) result(n, axis_[d]) = static_cast<double>(values[d * box_.size + place_[n]]);
    return result;
  }

  std::array<int, 3> axis_ = {0, 1, 2};  ///< of space along x, y and z of the box: the longest first
  gpu::Box box_;
  std::vector<int> along_;  ///< x, y and z in the box of each node
  std::vector<int> place_;  ///< of each node
  gpu::LatticeSteps<Real> steps_;
  std::vector<int> support_places_;
  std::vector<Real> support_values_;
  bool supports_wait_ = false;
  mutable std::vector<Real> u_, v_;  ///< on the way to and from the GPU; zero where there is no node
};

template <class Real>
void LatticeOnGpu<Real>::find_places() {
  const NodalVectors& X = network_.X;
  const Eigen::RowVector3d low = X.colwise().minCoeff(), extent = (X.colwise().maxCoeff() - low) / edge_;
  std::stable_sort(axis_.begin(), axis_.end(), [&](int a, int b) { return extent[a] > extent[b] + 0.5; });
  const auto nodes_along = [&](int d) { return 1 + static_cast<int>(std::lround(extent[axis_[d]])); };
  box_ = gpu::Box(nodes_along(0), nodes_along(1), nodes_along(2));
  for (int n = 0; n < network_.nodes(); ++n) {
    for (int d = 0; d < 3; ++d)
      along_.push_back(1 + static_cast<int>(std::lround((X(n, axis_[d]) - low[axis_[d]]) / edge_)));
    place_.push_back(box_.at(along_[3 * n], along_[3 * n + 1], along_[3 * n + 2]));
  }
}

template <class Real>
void LatticeOnGpu<Real>::add_springs(std::vector<double>& kinds, int& reach) const {
  for (const Spring& s : network_.springs) {
    int c = 13, power = 1, square = 0;
    for (int d = 0; d < 3; ++d, power *= 3) {
      const int step = along_[3 * s.j + d] - along_[3 * s.i + d];
      c += power * step;
      square += step * step;
    }
    kinds[std::size_t(s.i) * gpu::values_of_kind + c] += s.stiffness * edge_;
    kinds[std::size_t(s.j) * gpu::values_of_kind + (gpu::neighbours - 1 - c)] += s.stiffness * edge_;
    reach = std::max(reach, square);
  }
}

template <class Real>
void LatticeOnGpu<Real>::add_cells(const VolumeCorrection* volume, std::vector<double>& kinds) const {
  for (const Hexahedron& corners : network_.cells.corners) {
    const int lowest =
        *std::min_element(corners.begin(), corners.end(), [&](int a, int b) { return place_[a] < place_[b]; });
    double* entry = &kinds[std::size_t(lowest) * gpu::values_of_kind];
    if (volume) entry[gpu::kappa_of_kind] = volume->kappa * edge_ * edge_;
    entry[gpu::cell_of_kind] = 1;
  }
}

template <class Real>
gpu::LatticeForGpu<Real> LatticeOnGpu<Real>::lattice_of(const MassSpringModel& model) {
  find_places();
  gpu::LatticeForGpu<Real> l;
  l.box = box_;
  std::vector<double> all(std::size_t(network_.nodes()) * gpu::values_of_kind, 0.0);
  const auto* volume = law_of<VolumeCorrection>(model);
  const auto* hourglass = law_of<HourglassCorrection>(model);
  const auto* averaged = law_of<AveragedSprings>(model);
  if (law_of<Springs>(model)) add_springs(all, l.reach);
  if (volume) l.bounded = volume->form == VolumeEnergy::bounded;
  if (hourglass) l.hourglass = lattice_constants<Real>(hourglass->stiffness(edge_), edge_);
  if (averaged) l.averaged = lattice_constants<Real>(*averaged, edge_);
  l.volume = volume;
  l.corrected = hourglass;
  if (volume || hourglass || averaged) add_cells(volume, all);
  CoefficientTable table(gpu::values_of_kind);
  const std::vector<double> empty(gpu::values_of_kind, 0.0);
  l.kind.assign(box_.size, table.entry(empty.data()));
  for (int n = 0; n < network_.nodes(); ++n)
    l.kind[place_[n]] = table.entry(&all[std::size_t(n) * gpu::values_of_kind]);
  l.kinds.assign(table.values().begin(), table.values().end());
  return l;
}

}  // namespace

std::unique_ptr<LatticeMotion> lattice_on_gpu(const MassSpringModel& model, double density,
                                              const MotionOptions& options) {
  if (options.precision == Precision::float32) return std::make_unique<LatticeOnGpu<float>>(model, density, options);
  return std::make_unique<LatticeOnGpu<double>>(model, density, options);
}

}  // namespace springproof
