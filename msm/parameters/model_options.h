// What models are: their options, for those who list or offer them, and what their forces are made of: springs, which
// any engine can step, or terms of nodes, angles and cells.
#pragma once

#include <string>
#include <vector>

#include "msm/laws/laws.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// An option of models, as in `{ model = "hybmss", face_to_cube = 1 }`.
struct ModelOption {
  enum class Type { flag, number, name };

  std::string name;     ///< "face_to_cube"
  std::string what;     ///< of which models, its meaning, its default
  std::string allowed;  ///< "a number >= 0"
  Type type;            ///< of its value
  bool of_body;         ///< how the springs fill a body; their moduli do not depend on it
};

/// The options of all models.
/// @return each once
std::vector<ModelOption> model_options();

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
