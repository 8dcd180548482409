// Natural frequencies of the models of a case beside those of the finite element reference.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/mode_pairs.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/prepare/prepared_case.h"

namespace springproof {

struct FrequencyOptions {
  int modes = 10;                              ///< compared
  std::vector<double> consistency = {0, 0.5};  ///< shares of consistent mass of lattices of cells (msm/dynamics)
  bool free = false;                           ///< leave the supports out too
};

/// A mode of a model beside its reference mode.
struct ModeRow {
  std::optional<double> frequency;  ///< [Hz]; empty: no partner
  double mac = 0;
};

/// One model with one mass matrix.
struct ModelFrequencies {
  std::string label;
  double consistency = 0;
  std::string message;  ///< why there is no result
  std::string solver;
  double seconds = 0;
  ModeSet modes;                ///< at the nodes of the lattice's mesh
  std::vector<ModeRow> rows;    ///< one per reference mode compared; empty without a reference
  double rms = 0, largest = 0;  ///< relative errors over the rows with a partner
};

/// A case at one Poisson's ratio on one lattice.
struct FrequencyTable {
  IsotropicMaterial material;
  const Lattice* lattice = nullptr;
  std::string element;  ///< of the reference: "q2", "p2"
  std::string form;     ///< of the reference
  std::string failure;  ///< why there is no reference
  int rigid_motions = 0;
  std::vector<ReferenceValue> reference;  ///< [Hz], from three grids, ascending
  ModeSet shapes;                         ///< of the finest grid, at the nodes of the lattice's mesh; some more modes
  std::vector<ModelFrequencies> models;
};

/// frequency.x|y|z [Hz] of a model on a lattice, masses lumped: its lowest natural frequencies whose motion is mostly
/// along an axis; empty: the model has no modes.  Where the material relaxes, at the storage modulus of each.
std::map<std::string, double> lowest_frequencies(const PreparedCase& prepared, const Lattice& lattice,
                                                 std::size_t number, const IsotropicMaterial& material);

/// The same of finite elements on the cells of a block's lattice; empty: they have no result.
std::map<std::string, double> lowest_frequencies(const PreparedCase& prepared, const Lattice& lattice,
                                                 const std::string& element, const IsotropicMaterial& material);

/// The reference as records of measures "frequency.1", "frequency.2", ... [Hz].
std::vector<ReferenceRecord> records_of(const FrequencyTable& table);

/// The loads of a case that hold the body.
std::vector<Load> supports_of(const Experiment& experiment);

/// The case without what its modes do not depend on: measures, expectations; free: all loads.
/// @throws InputError for cells of several sizes in a free body: they are halved for its loads.
Experiment case_of_modes(Experiment experiment, const FrequencyOptions& options);

/// Solves a case made by prepare_lattices(case_of_modes()) at one of its materials: a table per lattice.
/// @throws InputError for a support on a patch that the body does not have.
std::vector<FrequencyTable> natural_frequencies(const PreparedCase& prepared, const IsotropicMaterial& material,
                                                const FrequencyOptions& options);

}  // namespace springproof
