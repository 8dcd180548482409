// Identifies numbers of a case from what was measured.
#pragma once

#include <filesystem>

#include "comparisons/identify/identified.h"
#include "problem/case_file/identification.h"

namespace springproof {

struct IdentifyOptions {
  std::filesystem::path folder = {};  ///< where runs are kept; empty: nowhere
  int synthetic = 0;                  ///< sets that are made of the fit and fitted anew
};

/// Weighted least squares over the fitted values, by their uncertainties, on the lattice of fewest cells, corrected to
/// the limit of all its lattices until that no longer matters.  What the values do not tell is held at its start.  The
/// uncertainties are those of the values, of the case's inputs (but for what is sought) and of the limit.
Identified identify(const Experiment& experiment, const Identification& sought, const IdentifyOptions& options);

}  // namespace springproof
