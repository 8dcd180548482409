// Measured errors of models in cases that predictions are held against (held_out.csv).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof {

/// The displacement error of one model or finite element in a case.
struct Measurement {
  std::string case_name;     ///< "golec_2019/bending"
  double poisson_ratio = 0;  ///< nu
  std::string model;         ///< label; "fem_q1", "fem_q2" for finite elements
  double cells = 0;          ///< of the lattice
  double error = 0;          ///< displacement_error (docs/results.md)
  double uncertainty = 0;    ///< of the reference, as a part of that error
};

/// A file of measurements.
struct MeasuredFile {
  std::string header;  ///< its lines of comment, without '#'
  std::vector<Measurement> rows;
};

/// Reads lines of comment (#), a heading and rows.
/// @throws InputError naming file and line.
MeasuredFile read_measurements(const std::filesystem::path& file);

/// As read_measurements, from text; `file` is for messages.
MeasuredFile parse_measurements(const std::string& text, const std::filesystem::path& file);

void write_measurements(const std::filesystem::path& file, const MeasuredFile& measured);

/// comparisons/advise beside the sources, or where it is installed.
std::filesystem::path advise_folder();

}  // namespace springproof
