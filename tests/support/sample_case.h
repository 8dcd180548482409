// A small case with one of everything, made up for the tests of the report.
#pragma once

#include <limits>

#include "comparisons/results/records.h"

namespace springproof {

inline Experiment sample_experiment() {
  Experiment e;
  e.name = "compress";
  e.folder = "golec_2019";
  e.cite = "Golec et al. (2019), Table 3";
  e.what = "A cube compressed between two plates.";
  e.body.geo = "block.geo";
  e.materials = {{1e4, 0.25, 1000}, {1e4, 0.4, 1000}};
  e.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PrescribedDisplacement{"z_max", {0.0, 0.0, -0.05}}};
  e.models = {{"hybmss", {{"face_to_cube", 1.0}}, "hybmss", {}}};
  e.measures = {"displacement_error", "volume_change"};
  e.probes = {{"centre", {0.5, 0.5, 0.5}}};
  e.text = "cite = \"Golec et al. (2019), Table 3\"\n";
  return e;
}

/// A square in the plane z = 0, moved by 0.1 m along x.
inline Picture sample_picture(const std::string& model, double poisson_ratio) {
  Picture p;
  p.model = model;
  p.poisson_ratio = poisson_ratio;
  p.cells = {1, 1, 1};
  p.rest = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  p.displacement = {0.1f, 0, 0, 0.1f, 0, 0, 0.1f, 0, 0, 0.1f, 0, 0};
  if (model != "fem") p.difference = {0, 0.001f, 0.002f, 0.003f};
  p.volume_change = {-0.01f, 0, 0.01f, 0.02f};
  p.quads = {0, 1, 2, 3};
  return p;
}

inline CaseResult sample_case() {
  CaseResult c;
  c.experiment = sample_experiment();
  c.size = {1, 1, 1};
  c.cells = {{1, 1, 1}, {2, 2, 2}};
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (double nu : {0.25, 0.4}) {
    for (int n : {1, 2}) {
      const Cells cells = {n, n, n};
      const double error = (nu == 0.25 ? 0.01 : 0.04) / n;
      c.runs.push_back({{"hybmss", nu, cells}, "msm", "linear", true, "", "CG + multigrid", 12, 1e-11, 0.5, 81});
      c.rows.push_back(
          {{"hybmss", nu, cells}, "compress", "linear", "displacement_error", error, "1", {}, 0.001, error});
      c.rows.push_back(
          {{"hybmss", nu, cells}, "compress", "linear", "volume_change", -0.025, "1", -0.026, 1e-4, 0.001});
      for (const char* plate : {"z_min", "z_max"}) {
        const std::string force = std::string("force.") + plate;
        const double sign = force == "force.z_min" ? 1 : -1;
        c.rows.push_back({{"hybmss", nu, cells}, "compress", "linear", force + ".magnitude", 510, "N", 500, 1, 10});
        c.rows.push_back({{"hybmss", nu, cells}, "compress", "linear", force + ".x", 1e-9, "N", 2e-9, 1e-6, -1e-9});
        c.rows.push_back(
            {{"hybmss", nu, cells}, "compress", "linear", force + ".z", sign * 510, "N", sign * 500, 1, sign * 10});
      }
    }
    const std::vector<Cells> grids = {{4, 4, 4}, {8, 8, 8}, {16, 16, 16}};
    c.references.push_back(
        {nu, "volume_change", "1", grids, {-0.02, -0.025, -0.0258}, 2.6, -0.026, 1e-4, "Richardson"});
    c.pictures.push_back(sample_picture("hybmss", nu));
    c.pictures.push_back(sample_picture("fem", nu));
  }
  c.runs.push_back(
      {{"emsm", 0.4, {2, 2, 2}}, "msm", "linear", false, "diverged at load 0.3", "BiCGStab", 7, none, 0.1, 81});
  const auto check = [&](double nu, double computed, Verdict verdict, const char* where) {
    const RunKey finest{"hybmss", nu, {2, 2, 2}};
    c.checks.push_back(
        {finest, "displacement_error", "1", "extrapolated FEM", 0, computed, 0.01, 0.001, verdict, where});
  };
  check(0.25, 0.005, Verdict::pass, "");
  check(0.4, 0.02, Verdict::fail, "sec. 6");
  c.published.push_back(
      {{"hybmss", 0.25, {1, 1, 1}}, "volume_change", "1", -0.0261, -0.025, "Table 3", "explicit run, not settled"});
  return c;
}

}  // namespace springproof
