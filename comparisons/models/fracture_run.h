// One spring model in a body that dries: broken over all samples of the case, and measured.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Results of all samples of a model.
struct FractureSamples {
  std::vector<Run> runs;                               ///< one per sample; their key is to be set
  std::vector<std::map<std::string, double>> scalars;  ///< rows of the measures fracture and network, per good sample
  CrackRecord cracks;                                  ///< its key is to be set; empty svg: no sample has a result
};

/// Dries model `number` of the case on a lattice; sample s has the seed fracture.seed + s, of its thresholds and of its
/// disordered network.  Writes the springs of the first sample into `vtu` (empty: no file).
FractureSamples run_fracture_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                     const IsotropicMaterial& material, const std::filesystem::path& vtu);

}  // namespace springproof
