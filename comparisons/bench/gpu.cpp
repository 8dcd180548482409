#include <fmt/format.h>

#include "comparisons/bench/benches.h"
#include "comparisons/bench/bodies.h"
#include "comparisons/bench/motion.h"
#include "msm/gpu/gpu.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

struct Explicit {
  const char *name, *model;
  double poisson_ratio;
};

/// One model's steps in double precision over several threads', and in single precision over double.
void steps(const Options& options, const Explicit& e, int n, Findings& findings) {
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
    BenchRow r{"gpu", what, size, "ns per cell and step, wall", to_ns * own, baseline, to_ns * other};
    r.note = fmt::format("{}, {:.0f} GB/s of places, velocities and kinds", gpu::device_name(),
                         1e-9 * nodes * (12 * bytes + 8) / own);
    findings.rows.push_back(r);
  };
  row(e.name, fp64, fmt::format("{} threads", options.threads), processor, 8);
  row(std::string("FP32 over FP64, ") + e.name, fp32, "FP64", fp64, 4);
}

}  // namespace

void bench_gpu(const Options& options, Findings& findings) {
  if (gpu::device_name().empty())
    return findings.remarks.push_back(gpu::built_for_gpu() ? "no GPU is found: no rows of it"
                                                           : "built without SPRINGPROOF_CUDA: no rows of a GPU");
  for (const int n : options.quick ? std::vector{16} : std::vector{31, 63, 100})
    for (const Explicit& e :
         {Explicit{"HybMSS-CF", "hybmss_cf", 0.25}, Explicit{"HybMSS", "hybmss", 0.3},
          Explicit{"HybMSS, hourglass correction", "hybmss_bt", 0.3}, Explicit{"averaged springs", "hybmss_avg", 0.3}})
      steps(options, e, n, findings);
}

}  // namespace springproof::bench
