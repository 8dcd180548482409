#include "comparisons/bench/gpu.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/bench/bodies.h"
#include "comparisons/bench/motion.h"
#include "msm/gpu/gpu_multigrid.h"
#include "msm/multigrid/cell_stiffness.h"
#include "msm/multigrid/multigrid.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

constexpr double tolerance = 1e-8;

struct Explicit {
  const char *name, *model;
  double poisson_ratio;
};

/// One model's steps in double precision over several threads', and in single precision over double.
void steps(const BenchOptions& options, const Explicit& e, int n, Findings& findings) {
  const std::string size = fmt::format("{}^3", n);
  to_stderr("gpu: {}, {} ...\n", e.name, size);
  const MassSpringModel model = lattice(e.model, {n, n, n}, e.poisson_ratio);
  const TimerOptions timer = {options.quick ? 5e-3 : 2e-2, options.quick ? 0.05 : 0.3, Clock::wall};
  const auto seconds_of_step = [&](const MotionOptions& of) {
    return least_seconds({fastest_motion(model, of)->advance}, timer)[0];
  };
  const double fp64 = seconds_of_step({.device = Device::gpu}),
               fp32 = seconds_of_step({.precision = Precision::float32, .device = Device::gpu}),
               processor = seconds_of_step({.threads = options.threads});
  const double to_ns = 1e9 / double(model.network.cells.size()), nodes = double(model.network.nodes());
  const auto row = [&](const std::string& what, double own, const std::string& baseline, double other, int bytes) {
    findings.rows.push_back({"gpu",
                             what,
                             size,
                             "ns per cell and step, wall",
                             to_ns * own,
                             baseline,
                             to_ns * other,
                             {},
                             {},
                             fmt::format("{}, {:.0f} GB/s of places, velocities and kinds", gpu::device_name(),
                                         1e-9 * nodes * (12 * bytes + 8) / own)});
  };
  row(e.name, fp64, fmt::format("{} threads", options.threads), processor, 8);
  row(std::string("FP32 over FP64, ") + e.name, fp32, "FP64", fp64, 4);
}

/// Conjugate gradients with the same cycle on both; neither with its set-up.
void statics(const BenchOptions& options, int n, double poisson_ratio, Findings& findings) {
  const std::string size = fmt::format("{}^3", n);
  to_stderr("gpu: equilibrium, {} ...\n", size);
  const MassSpringModel model = lattice("hybmss_bt", {n, n, n}, poisson_ratio);
  const BoundaryConditions conditions = clamped_bottom(model.network);
  const CellMatrix cell = cell_stiffness(model).total;
  const Eigen::VectorXd b = flat(conditions.external);
  Eigen::VectorXd u, v;
  const double start = seconds_of(Clock::wall);
  GpuMultigrid gpu(lattice_levels(model.network, conditions.fixed, 300), cell);
  const double set_up = seconds_of(Clock::wall) - start;
  KrylovResult on_gpu;
  double own = 1e9, other = 1e9;
  for (int run = 0; run < 3; ++run) {
    on_gpu = gpu.solve(b, tolerance, 200, u);
    own = std::min(own, gpu.seconds());
  }
  Multigrid processor(lattice_levels(model.network, conditions.fixed), cell);
  for (int run = 0; run < (options.quick ? 1 : 2); ++run) {
    const double before = seconds_of(Clock::wall);
    processor.solve(b, tolerance, 200, v);
    other = std::min(other, seconds_of(Clock::wall) - before);
  }
  const double difference = (u - v).norm() / v.norm();
  findings.rows.push_back(
      {"gpu",
       fmt::format("equilibrium, nu = {:g}", poisson_ratio),
       size,
       "s to 1e-8, wall",
       own,
       "one thread",
       other,
       {},
       {},
       fmt::format("{} iterations, set-up by the processor {:.2g} s, {:.0f} MB, displacements equal "
                   "to {:.0e}",
                   on_gpu.iterations, set_up, 1e-6 * gpu.bytes(), difference),
       on_gpu.converged && difference < 100 * tolerance});
}

}  // namespace

void bench_gpu(const BenchOptions& options, Findings& findings) {
  if (gpu::device_name().empty())
    return findings.remarks.push_back(gpu::built_for_gpu() ? "no GPU is found: no rows of it"
                                                           : "built without SPRINGPROOF_CUDA: no rows of a GPU");
  for (const int n : options.quick ? std::vector{16} : std::vector{31, 63, 100})
    for (const Explicit& e :
         {Explicit{"HybMSS-CF", "hybmss_cf", 0.25}, Explicit{"HybMSS", "hybmss", 0.3},
          Explicit{"HybMSS, hourglass correction", "hybmss_bt", 0.3}, Explicit{"averaged springs", "hybmss_avg", 0.3}})
      steps(options, e, n, findings);
  for (const int n : options.quick ? std::vector{16} : std::vector{40, 63, 100})
    for (const double nu : {0.25, 0.4}) statics(options, n, nu, findings);
}

}  // namespace springproof::bench
