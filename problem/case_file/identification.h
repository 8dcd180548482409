// [[identify]]: what measured values are to tell of a case.
#pragma once

#include <string>
#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof {

/// A number of the case that measured values are to tell.
struct SoughtParameter {
  std::string name;             ///< of its key: "youngs_modulus_Pa"
  std::vector<std::string> of;  ///< where it is written: "material.youngs_modulus_Pa"
  double start = 0;             ///< in the unit of its key, as the bounds
  double lower = 0, upper = 0;
  bool logarithmic = false;  ///< its logarithm is sought, where all that is allowed is positive, but of Poisson's ratio
};

/// An uncertain input of the case.
struct OtherInput {
  std::size_t number;
  std::vector<std::size_t> sought;  ///< parameters whose number it changes: where one is found it is no input
};

struct Identification {
  std::string name;
  std::vector<SoughtParameter> parameters;
  std::vector<std::size_t> fitted;  ///< numbers of the measured values that are fitted; the others are predicted
  std::string model;                ///< label of a model of the case, or "fem_q1" and the like
  std::vector<Cells> cells;         ///< of its lattices; empty: those of the case
  std::vector<OtherInput> inputs;
};

/// The tables of a case, in order.
/// @throws InputError with the place for a number that the case does not have, bounds the wrong way round, a start
/// beyond them, values or a model that there are not, or more parameters than fitted values
std::vector<Identification> identifications(const Experiment& experiment);

}  // namespace springproof
