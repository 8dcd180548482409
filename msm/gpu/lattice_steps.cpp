#include "msm/gpu/lattice_step.h"

#include "msm/gpu/gpu.h"

namespace springproof::gpu {
namespace {

/// Sets values at places.
template <class Real>
struct SetValues {
  const int* places;
  const Real* values;
  Real* to;
  SPRINGPROOF_INLINE void operator()(long i) const { to[places[i]] = values[i]; }
};

}  // namespace

bool built_for_gpu() {
#ifdef __CUDACC__
  return true;
#else
  return false;
#endif
}

std::string device_name() {
#ifdef __CUDACC__
  int count = 0;
  cudaDeviceProp properties;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) return "";
  return cudaGetDeviceProperties(&properties, 0) == cudaSuccess ? properties.name : "";
#else
  return "";
#endif
}

template <class Real>
struct LatticeSteps<Real>::Data {
  explicit Data(const LatticeForGpu<Real>& l)
      : box(l.box),
        kind(l.kind),
        kinds(l.kinds),
        load(l.box.size),
        u{Array<Real>(3L * l.box.size), Array<Real>(3L * l.box.size)},
        v(3L * l.box.size),
        partial(long(sums_of_launch) * l.box.number_of_blocks()),
        lattice{l.box,    kind.data(), kinds.data(), load.data(), nullptr,
                l.volume, l.bounded,   l.corrected,  l.hourglass, l.averaged},
        reach(l.reach) {}

  void sweep(Real time_step, Real decay, Real* force, bool measure) {
    lattice.loads = loads.data();
    if (reach == 0)
      sweep<0>(time_step, decay, force, measure);
    else if (reach <= 2)
      sweep<2>(time_step, decay, force, measure);
    else
      sweep<3>(time_step, decay, force, measure);
  }

  template <int longest>
  void sweep(Real time_step, Real decay, Real* force, bool measure) {
    const long n = box.size;
    Real *from = u[now].data(), *to = u[1 - now].data(), *speed = v.data();
    MoveNode<Real, longest> move{lattice,
                                 {from, from + n, from + 2 * n},
                                 {to, to + n, to + 2 * n},
                                 {speed, speed + n, speed + 2 * n},
                                 {force, force ? force + n : force, force ? force + 2 * n : force},
                                 time_step,
                                 decay,
                                 measure};
    const CellOfKind<Real> cell{lattice.kind, lattice.kinds};
    const auto run = [&](const auto& law) {
      const Sweep<Real, std::decay_t<decltype(law)>, MoveNode<Real, longest>> sweep{
          box, {from, from + n, from + 2 * n}, law, move, measure ? partial.data() : nullptr};
      launch(sweep, box.blocks);
    };
    if constexpr (longest > 0) {
      if (lattice.volume || lattice.corrected)
        run(CorrectedCells<Real>{cell, lattice.volume, lattice.bounded, lattice.corrected, lattice.hourglass});
      else
        run(NoCells{});
    } else {
      switch (lattice.averaged.curve) {
        case LatticeCurve::hencky:
          return run(AveragedCells<LatticeCurve::hencky, Real>{cell, lattice.averaged});
        case LatticeCurve::neo_hooke:
          return run(AveragedCells<LatticeCurve::neo_hooke, Real>{cell, lattice.averaged});
        case LatticeCurve::neo_hooke_isochoric:
          return run(AveragedCells<LatticeCurve::neo_hooke_isochoric, Real>{cell, lattice.averaged});
        case LatticeCurve::none:
          return run(CorrectedCells<Real>{cell, lattice.volume, lattice.bounded, lattice.corrected, lattice.hourglass});
      }
    }
  }

  Box box;
  Array<int> kind;
  Array<Real> kinds;
  Array<int> load;
  Array<Real> loads, u[2], v;
  Array<double> partial;
  LatticeOnGpu<Real> lattice;
  int reach, now = 0;  ///< of the springs; which of u
};

template <class Real>
LatticeSteps<Real>::LatticeSteps(const LatticeForGpu<Real>& lattice) : data_(std::make_unique<Data>(lattice)) {}
template <class Real>
LatticeSteps<Real>::~LatticeSteps() = default;

template <class Real>
void LatticeSteps<Real>::set_loads(const std::vector<int>& load, const std::vector<Real>& loads) {
  data_->load.write(load.data());
  data_->loads = Array<Real>(loads);
}

template <class Real>
void LatticeSteps<Real>::write(const std::vector<Real>& u, const std::vector<Real>& v) {
  data_->u[data_->now].write(u.data());
  data_->v.write(v.data());
}

template <class Real>
void LatticeSteps<Real>::read_u(std::vector<Real>& u) const {
  u.resize(data_->u[data_->now].size());
  data_->u[data_->now].read(u.data());
}

template <class Real>
void LatticeSteps<Real>::read_v(std::vector<Real>& v) const {
  v.resize(data_->v.size());
  data_->v.read(v.data());
}

template <class Real>
void LatticeSteps<Real>::set(const std::vector<int>& places, const std::vector<Real>& u) {
  if (places.empty()) return;
  const Array<int> at(places);
  const Array<Real> values(u);
  launch_each(SetValues<Real>{at.data(), values.data(), data_->u[data_->now].data()}, values.size());
  wait();
}

template <class Real>
LatticeSums LatticeSteps<Real>::advance(long steps, Real time_step, Real decay) {
  for (long n = 0; n < steps; ++n) {
    data_->sweep(time_step, decay, nullptr, n + 1 == steps);
    data_->now = 1 - data_->now;
  }
  std::vector<double> partial(data_->partial.size());
  data_->partial.read(partial.data());
  LatticeSums sums = {0, 0};
  for (std::size_t b = 0; b < partial.size(); b += sums_of_launch)
    sums = {sums.free + partial[b], sums.fixed + partial[b + 1]};
  return sums;
}

template <class Real>
std::vector<Real> LatticeSteps<Real>::forces() {
  Array<Real> force(3L * data_->box.size);
  data_->sweep(0, 1, force.data(), false);
  std::vector<Real> values(force.size());
  force.read(values.data());
  return values;
}

template <class Real>
double LatticeSteps<Real>::bytes() const {
  const Data& d = *data_;
  return double(d.kind.bytes() + d.kinds.bytes() + d.load.bytes() + d.loads.bytes() + d.u[0].bytes() + d.u[1].bytes() +
                d.v.bytes() + d.partial.bytes());
}

template class LatticeSteps<double>;
template class LatticeSteps<float>;

}  // namespace springproof::gpu
