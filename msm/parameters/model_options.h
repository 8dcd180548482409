// The options of models, for those who list or offer them.
#pragma once

#include <string>
#include <vector>

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

}  // namespace springproof
