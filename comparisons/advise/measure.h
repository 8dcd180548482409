// Measures what predictions are held against, by `springproof compare`'s own code, and keeps it in files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/advise/pilot.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// The cases that were not used to make the predictions: built-in ones, and those in comparisons/advise/held_out, at
/// some of their Poisson's ratios; blocks with the finite elements q1 and q2 beside the models.
std::vector<Experiment> held_out_cases();

/// Measures every model of advice in the held-out cases, a Poisson's ratio at a time, and writes `file` after each;
/// what is in `file` already is kept.
/// @return 0; 130 if interrupted.  @throws InputError if the file holds something else.
int measure_held_out(const std::filesystem::path& file);

/// The displacement error of one model or finite element in a case.
struct Measurement {
  std::string case_name;     ///< "golec_2019/bending"
  double poisson_ratio = 0;  ///< nu
  std::string model;         ///< label; "fem_q1", "fem_q2" for finite elements
  double cells = 0;          ///< of the lattice
  double error = 0;          ///< displacement_error (docs/results.md)
  double uncertainty = 0;    ///< of the reference, as a part of that error
};

/// Reads lines of comment (#), a heading and rows.
/// @throws InputError naming file and line.
std::vector<Measurement> read_measurements(const std::filesystem::path& file);

/// As read_measurements, from text; `file` is for messages.
std::vector<Measurement> parse_measurements(const std::string& text, const std::filesystem::path& file);

void write_measurements(const std::filesystem::path& file, const std::vector<Measurement>& measured);

/// comparisons/advise beside the sources, or where it is installed.
std::filesystem::path advise_folder();

/// One held-out error beside its predictions.
struct Judged {
  Measurement truth;
  Prediction predicted;
};

/// Within a factor of 1.5, or both below the reference's uncertainty.
bool hit(const Measurement& truth, const Prediction& prediction);

/// Whether the truth lies in the range that the prediction states, or both are below the reference's uncertainty.
bool inside(const Measurement& truth, const Prediction& prediction);

/// Hits of all, and of those on lattices finer than the pilot's.
struct HitRate {
  int all = 0, hits = 0, inside = 0;
  int beyond = 0, beyond_hits = 0;
};
HitRate hit_rate(const std::vector<Judged>& judged);

/// Predicts the held-out rows of the cases whose names contain `name` (empty: all), each from its pilot.
std::vector<Judged> judge_predictions(const std::vector<Measurement>& held_out, const std::string& name,
                                      const PilotSize& size = {});

}  // namespace springproof
