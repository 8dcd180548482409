// LatticeMotion by the kernels of an instruction set, in one of two precisions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "msm/dynamics/lattice_motion.h"
#include "msm/kernels/aligned_array.h"
#include "msm/kernels/kernels.h"
#include "msm/kernels/lattice_constants.h"
#include "msm/kernels/lattice_layout.h"
#include "msm/kernels/workers.h"

namespace springproof {
namespace {

template <class Real>
class LatticeOnProcessor : public LatticeMotion {
 public:
  LatticeOnProcessor(const MassSpringModel& model, double density, const MotionOptions& options)
      : LatticeMotion(model, density, options),
        theta_(options.mass_consistency),
        instructions_(options.instructions),
        kernels_(kernels_of<Real>(options.instructions).lattice),
        layout_(lattice_layout(model, kernels_.lanes, sizeof(Real), options.viscosity.acts())),
        workers_(dispersion_of(model) ? 1 : std::clamp(options.threads, 1, layout_.nodes[2])),
        progress_(workers_.count()) {
    if (const auto* volume = law_of<VolumeCorrection>(model)) bounded_ = volume->form == VolumeEnergy::bounded;
    if (const auto* hourglass = law_of<HourglassCorrection>(model)) {
      hourglass_ = lattice_constants<Real>(hourglass->stiffness(edge_), edge_);
      corrected_ = true;
    }
    if (const auto* averaged = law_of<AveragedSprings>(model)) averaged_ = lattice_constants<Real>(*averaged, edge_);
    viscous_ = options.viscosity.acts();
    if (viscous_) dashpots_ = lattice_constants<Real>(options.viscosity.cells(), edge_, options.viscosity.time());
    make_arrays();
    if (const MomentumDispersion* dispersion = dispersion_of(model)) make_dispersion(*dispersion);
    make_slabs();
    if (theta_ > 0) work_ = AlignedArray<Real>(workers_.count() * work_of_slab(), Real(0));
    LatticeOnProcessor::set_conditions(no_conditions());
  }

  void set_conditions(const BoundaryConditions& conditions) override {
    const Eigen::VectorXd mass = masses(network_, density_);
    const int lanes = layout_.lanes, block_size = node_coefficients * lanes;
    std::vector<double> all(std::size_t(layout_.rows()) * layout_.row_blocks * block_size, 0.0);
    supports_.clear();
    for (int n = 0; n < network_.nodes(); ++n) {
      const int slot = layout_.slot[n];
      double* block =
          &all[std::size_t(layout_.block_of(slot)) * block_size + slot % layout_.plane % layout_.row % lanes];
      for (int d = 0; d < 3; ++d) {
        const int axis = layout_.axis[d];
        const bool fixed = conditions.fixed[3 * n + axis];
        block[d * lanes] = fixed ? 0 : 1 / (mass[n] * edge_);
        block[(3 + d) * lanes] = conditions.external(n, axis);
        if (fixed) supports_.push_back({d, slot, static_cast<Real>(conditions.prescribed(n, axis) / edge_)});
      }
    }
    CoefficientTable table(block_size);
    for (std::size_t b = 0; b < node_entry_.size(); ++b) node_entry_[b] = table.entry(&all[b * block_size]);
    nodes_ = aligned_copy<Real>(table.values());
    supports_wait_ = true;
  }

  void move_supports() override {
    for (const Support& s : supports_) u_[s.component][s.slot] = s.value;
    supports_wait_ = false;
  }

  void read(int begin, int end, double* values) const override {
    for (int n = begin; n < end; ++n, values += 6)
      for (int d = 0; d < 3; ++d) {
        values[layout_.axis[d]] = edge_ * u_[d][layout_.slot[n]];
        values[3 + layout_.axis[d]] = edge_ * v_[d][layout_.slot[n]];
      }
  }

  void write(int begin, int end, const double* values) override {
    for (int n = begin; n < end; ++n, values += 6)
      for (int d = 0; d < 3; ++d) {
        u_[d][layout_.slot[n]] = static_cast<Real>(values[layout_.axis[d]] / edge_);
        v_[d][layout_.slot[n]] = static_cast<Real>(values[3 + layout_.axis[d]] / edge_);
      }
  }

  ForceNorms advance(long steps) override {
    ForceNorms norms;
    for (; steps > 0 && (supports_wait_ || !speeds_.empty() || theta_ > 0); --steps) {
      norms = step_with_speeds();
      if (supports_wait_)
        for (const Support& s : supports_)
          if (const Real speed = (s.value - u_[s.component][s.slot]) / static_cast<Real>(time_step_);
              (viscous_ || theta_ > 0) && speed != 0)
            speeds_.push_back({s.component, s.slot, speed});
      if (theta_ > 0) average();
      if (supports_wait_) move_supports();
    }
    return steps > 0 ? run(steps) : norms;
  }

  NodalVectors positions() const override { return network_.X + edge_ * in_network_order(u_); }
  NodalVectors velocities() const override { return edge_ * in_network_order(v_); }

  NodalVectors forces() override {
    AlignedArray<Real> stored(3 * layout_.size, Real(0));
    std::array<Real*, 3> f;
    LatticeStep<Real> step = {LatticeFinish::store_forces, 0, 1, {}};
    for (int d = 0; d < 3; ++d) step.force[d] = f[d] = stored.data() + d * layout_.size;
    run(1, step, step);
    return in_network_order(f);
  }

  double bytes_per_node() const override {
    std::size_t bytes = 4 * (layout_.slot.size() + layout_.spring_entry.size() + layout_.inflow_entry.size() +
                             layout_.outflow_entry.size() + node_entry_.size()) +
                        layout_.first_run.size() * sizeof(int) + layout_.runs.size() * sizeof(LatticeRun) +
                        supports_.size() * sizeof(Support);
    for (const auto* array :
         {&motion_, &rings_, &springs_, &nodes_, &inflow_, &outflow_, &J_, &inverse_lengths_, &work_})
      bytes += array->bytes();
    for (const auto& shared : shared_) bytes += shared.size() * sizeof shared[0];
    return double(bytes) / network_.nodes();
  }

  std::string description() const override {
    return fmt::format("lattice kernel {}, {} lanes of {} bits, {}", name_of(instructions_), layout_.lanes,
                       8 * sizeof(Real),
                       workers_.count() == 1 ? "1 thread" : fmt::format("{} threads", workers_.count()));
  }

 private:
  static constexpr double far_away = 1e4;  ///< [edges] where there is no node, so that none ever coincides with it

  struct Support {
    int component, slot;
    Real value;  ///< displacement [edges], speed [edges/s]
  };

  /// A step in which dashpots see the speeds of supports that have just moved; these stay where they are.
  ForceNorms step_with_speeds() {
    struct Kept {
      Real *u, *v, place, speed;
    };
    std::vector<Kept> kept;
    for (const Support& s : std::exchange(speeds_, {})) {
      Real *u = u_[s.component] + s.slot, *v = v_[s.component] + s.slot;
      kept.push_back({u, v, *u, std::exchange(*v, s.value)});
    }
    const ForceNorms norms = run(1);
    for (const Kept& k : kept) *k.u = k.place, *k.v = k.speed;
    return norms;
  }

  /// Values, in whole vectors.
  std::size_t work_of_slab() const {
    const long width = long(layout_.row_blocks) * layout_.lanes;
    return 3 * width * layout_.nodes[1] + width + 2 * layout_.lanes;
  }

  /// Moves the nodes by what averaged momenta add to a step; supports, whose velocities have part in it, stay.
  void average() {
    std::vector<Real> places, speeds;
    for (const Support& s : supports_) {
      places.push_back(u_[s.component][s.slot]);
      speeds.push_back(std::exchange(v_[s.component][s.slot], 0));
    }
    for (const Support& s : std::exchange(speeds_, {})) v_[s.component][s.slot] = s.value;
    const LatticeView<Real> all = view(false);
    workers_.run([&](int worker) {
      const LatticeSlab<Real>& slab = slabs_[0][worker];
      kernels_.average(
          all, {layout_.nodes[0], static_cast<Real>(theta_ * time_step_), work_.data() + worker * work_of_slab()},
          slab.begin, slab.end);
    });
    for (std::size_t i = 0; i < supports_.size(); ++i) {
      u_[supports_[i].component][supports_[i].slot] = places[i];
      v_[supports_[i].component][supports_[i].slot] = speeds[i];
    }
  }

  void make_arrays() {
    const std::size_t apart = layout_.size + 5 * cache_line / sizeof(Real);  // padded as planes are
    const std::size_t each = (apart * sizeof(Real) + cache_line - 1) / cache_line * cache_line / sizeof(Real);
    motion_ = AlignedArray<Real>(6 * each, Real(0));
    for (int d = 0; d < 3; ++d) {
      u_[d] = motion_.data() + 2 * d * each;
      v_[d] = u_[d] + each;
      std::fill_n(u_[d], layout_.size, static_cast<Real>(far_away));
      for (int slot : layout_.slot) u_[d][slot] = 0;
    }
    springs_ = aligned_copy<Real>(layout_.springs);
    layout_.springs = {};
    node_entry_.resize(layout_.spring_entry.size());
  }

  void make_dispersion(const MomentumDispersion& law) {
    inflow_ = aligned_copy<Real>(layout_.inflow);
    outflow_ = aligned_copy<Real>(layout_.outflow);
    layout_.inflow = layout_.outflow = {};
    J_ = AlignedArray<Real>(layout_.row * layout_.rows() + layout_.lanes, Real(0));
    std::vector<int> first(network_.nodes(), layout_.nodes[2]),
        last(network_.nodes(), 0);  // first and last plane of the nodes that share a J
    for (int n = 0; n < network_.nodes(); ++n) {
      const int to = law.sink(network_, n);
      for (int node : {n, to}) {
        first[to] = std::min(first[to], plane_of(node));
        last[to] = std::max(last[to], plane_of(node));
      }
    }
    shared_.resize(layout_.nodes[2]);
    for (int n = 0; n < network_.nodes(); ++n) {
      const int to = law.sink(network_, n);
      if (to != n) shared_[last[to]].push_back({place_of_J(n), place_of_J(to)});
      inflow_ahead_ = std::max(inflow_ahead_, last[to] - first[to] + 1);
    }
    inverse_lengths_ =
        AlignedArray<Real>(long(inflow_ahead_ + 1) * layout_.nodes[1] * lattice_directions * layout_.row, Real(0));
  }

  int plane_of(int node) const { return static_cast<int>(layout_.slot[node] / layout_.plane); }

  std::size_t place_of_J(int node) const {
    const long slot = layout_.slot[node], in_plane = slot % layout_.plane;
    return slot / layout_.plane * layout_.nodes[1] * layout_.row + in_plane;
  }

  /// Computes J of plane z and completes that of earlier planes; nodes that share a J get the sum.
  void find_inflow(const LatticeView<Real>& view, int z) {
    const long plane = layout_.nodes[1] * layout_.row;
    if (z == 0) std::fill_n(J_.data(), plane, Real(0));
    if (z + 1 < layout_.nodes[2]) std::fill_n(J_.data() + (z + 1) * plane, plane, Real(0));
    kernels_.inflow(view, z);
    for (const auto& [from, to] : shared_[z]) J_.data()[to] += J_.data()[from];
    for (const auto& [from, to] : shared_[z]) J_.data()[from] = J_.data()[to];
  }

  void make_slabs() {
    const int slabs = workers_.count();
    const std::vector<int> begin = split_planes(layout_, slabs);
    const long ring = 3 * layout_.row * (layout_.nodes[1] + 2), first = 3 * layout_.row * layout_.nodes[1];
    rings_ = AlignedArray<Real>(slabs == 1 ? ring : slabs * (2 * ring + first), Real(0));
    Real* p = rings_.data();
    for (int s = 0; s < slabs; ++s, p += 2 * ring + first)
      for (int parity = 0; parity < 2; ++parity)
        slabs_[parity].push_back(
            {begin[s], begin[s + 1], slabs == 1 ? p : p + parity * ring, s == 0 ? nullptr : p + 2 * ring});
  }

  ForceNorms run(long steps) {
    const LatticeStep<Real> step = {
        LatticeFinish::move, static_cast<Real>(time_step_), static_cast<Real>(1 / (1 + damping_ * time_step_)), {}};
    LatticeStep<Real> last = step;
    last.finish = LatticeFinish::move_and_measure;
    return run(steps, step, last);
  }

  /// `viscous`: with dashpots, if there are any.
  LatticeView<Real> view(bool viscous) const {
    const bool own_outflow = !layout_.outflow_entry.empty();
    return {.u = {u_[0], u_[1], u_[2]},
            .v = {v_[0], v_[1], v_[2]},
            .row = layout_.row,
            .plane = layout_.plane,
            .rows = layout_.nodes[1],
            .planes = layout_.nodes[2],
            .row_blocks = layout_.row_blocks,
            .first_run = layout_.first_run.data(),
            .runs = layout_.runs.data(),
            .spring_entry = layout_.spring_entry.data(),
            .springs = springs_.data(),
            .node_entry = node_entry_.data(),
            .nodes = nodes_.data(),
            .bounded = bounded_,
            .hourglass = hourglass_,
            .corrected = corrected_,
            .averaged = averaged_,
            .viscous = viscous,
            .dashpots = dashpots_,
            .J = J_.data(),
            .inflow_entry = layout_.inflow_entry.data(),
            .inflow = inflow_.data(),
            .outflow_entry = (own_outflow ? layout_.outflow_entry : layout_.inflow_entry).data(),
            .outflow = (own_outflow ? outflow_ : inflow_).data(),
            .outflow_sign = static_cast<Real>(layout_.outflow_sign),
            .inverse_lengths = inverse_lengths_.data(),
            .kept_planes = inflow_ahead_ + 1};
  }

  ForceNorms run(long steps, const LatticeStep<Real>& step, const LatticeStep<Real>& last) {
    const LatticeView<Real> all = view(viscous_ && step.finish != LatticeFinish::store_forces);
    std::vector<LatticeSums> sums(workers_.count(), {0, 0});
    workers_.run([&](int worker) {
      for (long n = 0; n < steps; ++n)
        step_of_slab(worker, steps_done_ + n, all, n + 1 < steps ? step : last, sums[worker]);
    });
    steps_done_ += steps;
    LatticeSums total = {0, 0};
    for (const LatticeSums& s : sums) total = {total.free + s.free, total.fixed + s.fixed};
    return {std::sqrt(total.free), std::sqrt(total.fixed)};
  }

  /// Reads the first plane of the slab above before that plane moves, and adds the forces of the slab below to its own
  /// first plane.
  void step_of_slab(int s, long number, const LatticeView<Real>& view, const LatticeStep<Real>& step,
                    LatticeSums& sums) {
    if (view.J) return dispersed_step(view, step, sums);
    const auto& slabs = slabs_[number % 2];
    const LatticeSlab<Real>& slab = slabs[s];
    if (s + 1 < workers_.count()) clear_end(slab);
    kernels_.sweep(view, slab, slab.begin, slab.end - 1, step, sums);
    if (s + 1 < workers_.count()) wait_until(progress_[s + 1].first_done, number);
    kernels_.sweep(view, slab, slab.end - 1, slab.end, step, sums);
    progress_[s].swept.store(number + 1, std::memory_order_release);
    if (s == 0) return;
    wait_until(progress_[s - 1].swept, number + 1);
    kernels_.finish_first(view, slab, slabs[s - 1], step, sums);
    progress_[s].first_done.store(number + 1, std::memory_order_release);
  }

  /// Called by the slab's own thread: memory written by another one would have to be fetched from its cache.
  void clear_end(const LatticeSlab<Real>& slab) {
    const long rows = layout_.nodes[1];
    for (long row = (slab.end - slab.begin) * rows, end = row + rows; row < end; ++row)
      std::fill_n(slab.ring + row % (rows + 2) * 3 * layout_.row, 3 * layout_.row, Real(0));
  }

  /// J is computed some planes ahead of the forces, from positions that have not moved yet.
  void dispersed_step(const LatticeView<Real>& view, const LatticeStep<Real>& step, LatticeSums& sums) {
    int found = 0;
    for (int z = 0; z < layout_.nodes[2]; ++z) {
      for (; found <= std::min(z + inflow_ahead_, layout_.nodes[2] - 1); ++found) find_inflow(view, found);
      kernels_.sweep(view, slabs_[0][0], z, z + 1, step, sums);
    }
  }

  NodalVectors in_network_order(const std::array<Real*, 3>& arrays) const {
    NodalVectors result(network_.nodes(), 3);
    for (int n = 0; n < network_.nodes(); ++n)
      for (int d = 0; d < 3; ++d) result(n, layout_.axis[d]) = static_cast<double>(arrays[d][layout_.slot[n]]);
    return result;
  }

  double theta_;
  InstructionSet instructions_;
  LatticeKernels<Real> kernels_;
  LatticeLayout layout_;
  LatticeHourglass<Real> hourglass_ = {};
  bool bounded_ = false, corrected_ = false, viscous_ = false, supports_wait_ = false;
  LatticeAveraged<Real> averaged_ = {}, dashpots_ = {};
  AlignedArray<Real> motion_, rings_, springs_, nodes_, inflow_, outflow_, J_, inverse_lengths_, work_;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>>
      shared_;            ///< pairs of J that share a sum, by the last plane that adds to it
  int inflow_ahead_ = 0;  ///< planes
  std::array<Real*, 3> u_, v_;
  std::vector<int> node_entry_;
  std::vector<Support> supports_;
  std::vector<Support> speeds_;  ///< of supports that moved at the end of the last step; only dashpots need them
  std::vector<LatticeSlab<Real>> slabs_[2];
  Workers workers_;
  std::vector<Progress> progress_;
  long steps_done_ = 0;
};

}  // namespace

std::unique_ptr<LatticeMotion> lattice_on_processor(const MassSpringModel& model, double density,
                                                    const MotionOptions& options) {
  if (options.precision == Precision::float32)
    return std::make_unique<LatticeOnProcessor<float>>(model, density, options);
  return std::make_unique<LatticeOnProcessor<double>>(model, density, options);
}

}  // namespace springproof
