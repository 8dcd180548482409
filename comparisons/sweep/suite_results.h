// Puts the parts of a comparison together and writes its results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"

namespace springproof {

/// The case's name as a file name.
std::string key_of(const std::filesystem::path& case_file);

/// What is known of a case before any part of it is run.
CaseResult case_of(const PreparedCase& prepared);

void append(const Part& from, Part& to);

/// Where results go, beside results.csv, results.json and report.html.
struct ResultsChoice {
  std::filesystem::path out;
  bool vtu = false;                 ///< series of the VTU files in out/vtu are written
  bool gltf = false;                ///< the deformed surfaces go to out/gltf
  std::filesystem::path live_page;  ///< copied beside the report, which links it; empty: none
  bool verbose = false;             ///< a sentence on every model is printed
};

/// Judges the cases, whose parts are appended, and writes and prints the results.
/// @param libraries of the reference
/// @return whether every expectation holds and every case was compared.
bool write_results(std::vector<CaseResult> results, const std::string& libraries, const ResultsChoice& choice);

}  // namespace springproof
