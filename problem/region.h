// A part of the body that is of another material.
#pragma once

#include <string>

#include "problem/material.h"
#include "problem/system/input_error.h"

namespace springproof {

/// A part of the body that is of another material.  Regions are numbered from 1 in the order of the case file; 0 is
/// what is in none of them, of the body's own material.
struct Region {
  std::string name;            ///< as measures and messages refer to it
  IsotropicMaterial material;  ///< of all of it
  SourceLocation where;        ///< of the entry in the case file
};

}  // namespace springproof
