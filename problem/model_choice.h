// A mass-spring model as named by the user.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "problem/system/input_error.h"

namespace springproof {

/// A model as named in the case file, with its options, which the model table interprets (msm/models.h).
struct ModelChoice {
  std::string name;                                                        ///< row of the table, "hybmss"
  std::map<std::string, std::variant<bool, double, std::string>> options;  ///< e.g. face_to_cube = 1.0
  std::string label;                                                       ///< "hybmss" or "hybmss A=1 paper_e_form"
  SourceLocation where;                                                    ///< in the case file, for messages
  std::filesystem::path file = {};  ///< a springs file instead of a row of the table; empty: the row `name`
  bool in_motion = false;           ///< integrated in time as [dynamics] says, not solved for its equilibrium
};

}  // namespace springproof
