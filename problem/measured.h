// What was measured of a body, and what is uncertain in the inputs of its simulation.
#pragma once

#include <optional>
#include <string>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// A measured value.
struct MeasuredValue {
  std::string name;
  std::string quantity;     ///< a row of results: "mean_displacement.x_max.z", "frequency.z"
  Vec3 arm = Vec3::Zero();  ///< of a mean_displacement: from the middle of the patch to what was followed, which turns
                            ///< with the patch [m]
  std::size_t of = 0;       ///< number of its load case
  std::optional<std::size_t> minus = {};  ///< of the load case whose value is subtracted
  double value = 0, u = 0;   ///< with its standard uncertainty, in the unit of the quantity; NaN: not measured yet
  bool fitted = false;       ///< an input was fitted to it: it is no prediction
  std::string history = {};  ///< that it is a sample of; empty: none
  double time = 0;           ///< of the sample [s]
  std::string source = {}, licence = {};
  SourceLocation where = {};  ///< of its quantity
};

/// An input of a simulation that is not known exactly.
struct UncertainInput {
  enum class Kind {
    uncertain,   ///< by a standard uncertainty
    fitted,      ///< fitted to the measured value that says so
    alternative  ///< as good a choice, such as another law
  };
  std::string name;
  Kind kind = Kind::uncertain;
  SourceLocation where;
};

/// The case under other loads, or after another time under them; the first is the case as written.
struct LoadCase {
  std::string name;
  SourceLocation where;
  std::size_t table = 0;                  ///< number of its [[load_case]]
  std::optional<double> loaded_for = {};  ///< instead of the time of the case [s]
};

}  // namespace springproof
