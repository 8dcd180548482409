// Builds the finite element request of a case.
#pragma once

#include "fem_reference/exchange/request.h"
#include "problem/case_file/experiment.h"

namespace springproof::fem {

/// Body, solid of equilibria (Experiment::at_rest()), law and loads of the case; the caller adds grids and points.  The
/// tolerance is that of references, 1e-8.
/// @throws InputError if the body's script does not exist (find_geo).
Request request_of(const Experiment& experiment, const IsotropicMaterial& material);

}  // namespace springproof::fem
