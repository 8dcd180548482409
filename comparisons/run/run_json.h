// Runs of models as JSON, for the files in which they are kept until their part is finished.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "comparisons/models/fracture_run.h"
#include "comparisons/models/model_run.h"

namespace springproof {

/// Without the supports' forces, which are in the reactions.
nlohmann::json json_of(const std::vector<ModelSample>& samples);
std::vector<ModelSample> samples_from(const nlohmann::json& json, const Lattice& lattice);

nlohmann::json json_of(const FractureSamples& samples);
FractureSamples fracture_samples_from(const nlohmann::json& json);

}  // namespace springproof
