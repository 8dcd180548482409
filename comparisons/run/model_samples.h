// The samples of a model in a part that is being run: each a run that is kept (comparisons/reference/run_keeper.h).
#pragma once

#include <string>
#include <vector>

#include "comparisons/models/fracture_run.h"
#include "comparisons/models/model_run.h"
#include "comparisons/run/part_run.h"

namespace springproof {

/// What the samples of a model on a lattice are kept as.
std::string name_of_samples(std::size_t lattice, ChosenModel model);

/// A model on a lattice.
std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, ChosenModel model);

/// The same of a body that dries.
FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number);

}  // namespace springproof
