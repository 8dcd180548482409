// Puts the parts of a comparison together and writes its results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "comparisons/sweep/suite.h"

namespace springproof {

/// The case's name as a file name.
std::string key_of(const std::filesystem::path& case_file);

/// What is known of a case before any part of it is run.
CaseResult case_of(const PreparedCase& prepared);

void append(const Part& from, Part& to);

/// Judges the cases, whose parts are appended, and writes and prints the results as the options say.
/// @param libraries of the reference
/// @return whether every expectation holds and every case was compared.
bool write_results(std::vector<CaseResult> results, const std::string& libraries, const SuiteOptions& options);

}  // namespace springproof
