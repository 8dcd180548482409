// Limits of models of cut cells from two lattices.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// The equilibrium of a model of cut cells on one lattice.
struct CutState {
  std::size_t lattice, model;
  NodalVectors displacement;  ///< of the network [m]
  NodalVectors field;         ///< of the lattice's mesh [m]
  std::map<std::string, double> scalars;
};

struct ExtrapolatedModel {
  std::string label;    ///< of the model, and "extrapolated"
  std::size_t lattice;  ///< the finer of the two, at whose nodes the field is
  NodalVectors field;   ///< [m]
  std::map<std::string, double> scalars;
  std::map<std::string, double> step;  ///< of each scalar from the finer lattice: the uncertainty of the limit
  std::string from;                    ///< the two edges, for the user
};

/// The two finest lattices of each model, extrapolated to an edge of zero as errors that fall with the edge, which
/// those of notches, creases and parts few cells thick do, or with the estimated error of refined lattices; whole cubes
/// have no such limit, as their staircase jumps. Nothing for a model with one lattice, or two whose edges differ by
/// less than least_ratio.
std::vector<ExtrapolatedModel> extrapolate_cut_cells(const PreparedCase& prepared, const std::vector<CutState>& states);

}  // namespace springproof
