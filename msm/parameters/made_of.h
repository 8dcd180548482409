// What the forces of a model are made of: springs, which any engine can step, or terms of nodes, angles and cells.
#pragma once

#include <string>

#include "msm/laws/laws.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// What a row of the table is made of, on whole cells.
/// @param row of the table
/// @return "springs"; "springs + a term per node", "... per angle", "... per cell"; "a term per cell": no spring is
/// left
std::string made_of(const ModelRow& row);

/// What a model is made of.  In cut cells every model is its springs averaged over the cell, a term per cell.
/// @param parameters as resolved
/// @return as above; of a springs file as its laws say
std::string made_of(const ModelParameters& parameters);

/// What a model as built is made of, by its laws.
/// @param model its laws
/// @return as above, all kinds of terms that it has
std::string made_of(const MassSpringModel& model);

}  // namespace springproof
