// The request of a case file.
#pragma once

#include "fem_reference/reference.h"
#include "problem/case_file/experiment.h"

namespace springproof::fem {

/// Body, material, law and loads of the case; grids and points are the caller's.  Tolerance: that of references, 1e-8.
/// @throws InputError if the body's script is not there (find_geo).
Request request_of(const Experiment& experiment, const IsotropicMaterial& material);

}  // namespace springproof::fem
