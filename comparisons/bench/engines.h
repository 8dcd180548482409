// Benchmark of real-time engines: what they make of E and nu, by the ruler that our springs are measured with.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "comparisons/bench/engine_adapter.h"
#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"
#include "comparisons/judge/reference_value.h"

namespace springproof::bench {

/// One number of one engine.
struct EngineResult {
  std::string engine, quantity;  ///< "energy, shear", "tip", "frequency", ...
  std::string cells;             ///< "8x2x2"
  double poisson_ratio = 0.25;
  double time_step = 0;  ///< [s]; 0: does not matter
  int iterations = 0;
  std::string integrator = {};
  double value = 0;
  std::optional<double> error = {};        ///< relative, against the reference
  std::optional<double> uncertainty = {};  ///< of the error
  bool ours = false;
  std::string why_not = {};  ///< no value: "burst", or why
};

struct EngineFindings {
  std::vector<EngineResult> results;
  std::map<std::string, ReferenceValue> references;  ///< "tip, nu = 0.25"
  std::map<std::string, std::string> versions;       ///< adapter -> name and version of its engine
  std::vector<std::string> not_measured;             ///< "Jolt: not measured: ..."
  bool quick = false;
};

/// Measures what is installed, adds a row for each engine that fails and those with a target, and the rest to `engines`
/// one by one, so that an interrupted run keeps what was measured before.
void bench_engines(const BenchOptions& options, Findings& findings, EngineFindings& engines);

nlohmann::json to_json(const EngineFindings& engines);

/// The tables in the terminal.
std::string text_of(const EngineFindings& engines);

}  // namespace springproof::bench
