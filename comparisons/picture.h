// The deformed surface of a field, for the report's 3D view.
#pragma once

#include "comparisons/results.h"
#include "meshes/field.h"

namespace springproof {

/// `truth`: displacement of the reference at the same nodes, or null (then no difference is given).
Picture picture(const std::string& model, double poisson_ratio, const Cells& cells, const Field& field,
                const NodalVectors* truth);

}  // namespace springproof
