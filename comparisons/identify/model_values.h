// Measured values as a model has them, at other numbers of its case.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "comparisons/reference/run_keeper.h"
#include "comparisons/results/records.h"
#include "problem/case_file/identification.h"
#include "problem/case_file/varied.h"

namespace springproof {

/// Runs the model of an identification; each run is kept by its inputs, in memory and, where there is one, in a folder.
class ModelValues {
 public:
  using Numbers = std::vector<double>;  ///< one of each parameter

  /// Keeps references.
  /// @param folder "": nothing is kept on disk
  ModelValues(const Experiment& experiment, const Identification& sought, std::filesystem::path folder);

  std::size_t lattices() const { return lattices_.size(); }
  std::vector<Cells> cells() const;  ///< of the lattices that have run; of a block, all

  /// One of each measured value, and with an input changed; empty: the model has none, message() says why.
  /// @param wanted numbers of the values; the others are empty
  std::vector<std::optional<double>> at(const Numbers& numbers, std::size_t lattice,
                                        const std::vector<std::size_t>& wanted, std::optional<std::size_t> input = {});

  const std::string& message() const { return message_; }
  int runs() const { return runs_; }
  int kept() const { return kept_; }

 private:
  const VariedRun& run(const Numbers& numbers, std::size_t lattice, const Variation& variation);
  VariedRun made(const Experiment& changed, const std::string& load_case, const std::string& input);
  Experiment case_at(const Variation& variation, std::size_t lattice) const;

  const Experiment& experiment_;
  const Identification& sought_;
  const std::filesystem::path folder_;
  const std::string stamp_;
  std::vector<Cells> lattices_;          ///< of a body of voxels {0, 0, 0} until they have run
  std::vector<std::size_t> resolution_;  ///< of each, its number in the case file; of a body of voxels
  std::map<std::string, VariedRun> runs_of_;
  std::string message_;
  int runs_ = 0, kept_ = 0;
};

}  // namespace springproof
