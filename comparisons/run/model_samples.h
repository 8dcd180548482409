// The samples of a model in a part that is being run: each a run that is kept (comparisons/run/run_keeper.h).
#pragma once

#include <string>
#include <vector>

#include "comparisons/run/fracture_run.h"
#include "comparisons/run/model_run.h"
#include "comparisons/run/part_run.h"

namespace springproof {

/// What the samples of model `number` on a lattice are kept as; `whole`: on whole cubes instead of the cut cells.
std::string name_of_samples(std::size_t lattice, std::size_t number, bool whole = false);

/// Model `number` of the case on a lattice.
std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, std::size_t number, bool whole = false);

/// The same of a body that dries.
FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number);

}  // namespace springproof
