// What is refused of a case once its models and its body's patches are known.
#pragma once

#include <string>
#include <vector>

#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// @throws InputError at an expectation that has nothing to be held against.
void check_expectations(const Experiment& experiment);

/// @throws InputError at a model that does not hold under the case's kinematics; `models` as they stand in the case.
void check_kinematics(const Experiment& experiment, const std::vector<ModelParameters>& models);

/// @throws InputError at an expectation or a published value of the mean displacement of a patch that the body lacks.
void check_mean_displacements(const Experiment& experiment, const std::vector<std::string>& patches);

}  // namespace springproof
