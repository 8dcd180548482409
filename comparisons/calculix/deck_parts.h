// What a deck is made of: laws, labels and sections, for making and for writing it.
#pragma once

#include <string>
#include <vector>

#include "comparisons/calculix/deck.h"

namespace springproof::calculix {

/// A law of the case files, and its form in a deck.
struct Counterpart {
  const char* kinematics;
  bool finite;
  const char* remark;
  void (*write)(const IsotropicMaterial&, std::ostream&);
};

/// That of a case.
/// @throws InputError as require_counterpart()
const Counterpart& counterpart(const Experiment& experiment);

/// "z_max" -> "Z_MAX": a label that CalculiX and Abaqus accept and print unchanged.
std::string label(const std::string& name);

/// A part of the body and its section.
struct Section {
  std::string set, name;  ///< the latter of the material
  IsotropicMaterial material;
  std::vector<int> elements;
};

/// Those of a deck, which have elements; of one material the body, whose elements are not listed.
std::vector<Section> sections_of(const Deck& deck);

}  // namespace springproof::calculix
