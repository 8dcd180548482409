// The files for ParaView of a comparison: their names, what they say of themselves, and their series.
#pragma once

#include <filesystem>
#include <string>

#include "comparisons/results/records.h"
#include "meshes/field.h"
#include "meshes/voxels/cut_cells.h"
#include "meshes/vtu.h"
#include "msm/measure/promised_error.h"

namespace springproof {

/// Where VTU files go, and how.
struct VtuOutput {
  std::filesystem::path folder;  ///< empty: none
  bool single = false;           ///< in single precision
};

/// The file of the reference on its own mesh (an element of [reference], its finest grid); empty: none is wanted.
std::string reference_file(const VtuOutput& vtu, const std::string& element, double poisson_ratio);

/// What the file of a run says of itself; `case_name` without its folder, Young's modulus in Pa.
VtuNotes vtu_notes(const std::string& case_name, const RunKey& key, double youngs_modulus, bool single);

/// As files have them: `stress`, xx yy zz xy yz xz, and `von_mises` [Pa].
NodalFields stress_fields(const NodalStresses& stress);

/// Writes the cells of a cut body, displaced as their corners are, with the fraction of each that is filled and its
/// edge.
/// @param displacement one row per point of the cut body [m]; those of anchored nodes follow
/// @param stress recovered_stress() of the model, or none: where materials meet the nodes are apart
/// @throws std::runtime_error if the file cannot be written.
void write_cells(const std::filesystem::path& file, const CutBody& cut, const NodalVectors& displacement,
                 const VtuNotes& notes, const NodalStresses& stress = {});

/// Writes a series over Poisson's ratio of each model and resolution of a case, of the VTU files that lie in `folder`.
/// @throws std::runtime_error if a file cannot be written.
void write_series(const CaseResult& result, const std::filesystem::path& folder);

}  // namespace springproof
