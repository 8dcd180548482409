// The finite element reference on its grids: requests, and limits from three grids of one element.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/measures.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/reference/run_keeper.h"
#include "comparisons/reference/vtu_output.h"
#include "comparisons/results/records.h"
#include "fem_reference/exchange/reference.h"

namespace springproof {

/// One element of [reference] on three grids, coarse to fine.
struct ElementGrids {
  std::string element;
  std::vector<fem::Solution> grids;
  std::string note = {};  ///< why these are not the requested grids
};

/// The note of a limit, and that of the grids that it comes from.
std::string with_note(const ElementGrids& e, const std::string& note);

/// True if all three grids have a result.
bool complete(const ElementGrids& e);

struct ReferenceGrids {
  std::vector<ElementGrids> elements;             ///< in the order of [reference] elements; empty: the program failed
  std::vector<std::vector<fem::Solution>> peers;  ///< per lattice the elements of [compare], if there are models; none
                                                  ///< where that would be too many cubes
  std::vector<std::vector<fem::Solution>> refined;  ///< for a body of voxels, per lattice: q2 on its cubes, and on
                                                    ///< these cut into eight; none where that would be too many
  std::string failure;                              ///< why there is no result
};

/// The reference at the nodes of one lattice.
struct Reference {
  ReferenceField field;
  std::map<std::string, ReferenceValue> scalars;  ///< the same for every lattice
  DisplacementScale scale;                        ///< what errors of the displacement are relative to
};

/// Called with the displacement at the nodes of all lattices on the coarsest grid, before the others are solved.
using CoarsestField = std::function<void(const NodalVectors& displacement)>;

/// Solves on the grids of a block (for a body of voxels: solve_body_grids).  Displacements are requested at the nodes
/// of every lattice and at the measured points, stresses at the probes if the case measures them. An element without a
/// result on some graded grid is solved on uniform ones; an element on which the program fails does not affect the
/// others.  The finest grid of each element of [reference] leaves a file in `vtu`.
ReferenceGrids solve_grids(const PreparedCase& prepared, const IsotropicMaterial& material, const VtuOutput& vtu = {},
                           const RunKeeper& keeper = {}, const CoarsestField& coarsest = {});

/// A coarser grid; a direction of one cell (plane strain) is not divided.
Cells divided(const Cells& cells, int divisor);

/// Cells of the finest of three grids, so that the coarsest has two of them.
inline constexpr int two_on_the_coarsest = 8;

/// The fewest cells in any direction on the finest of three grids: 4, and near nu = 1/2 8.  There a coarsest grid of
/// one cell across, with pressures of its own, is too soft, and the sequence has no order.
int fewest_across(const Experiment& experiment);

/// Nearly cubic cells of a block, about `elements` of them, that can be divided by two and four; no fewer than `fewest`
/// in any direction.
Cells divisible_cells(const Vec3& size, double elements, int fewest = 4);

Field sampled_field(const Lattice& lattice, const fem::Solution& s);

/// Every scalar measure of one solution, stresses among them.
std::map<std::string, double> measures_of(const PreparedCase& prepared, const fem::Solution& s);

/// The measures of a field that have a value of their own; `u` is the displacement at the measured points.
std::map<std::string, double> field_measures(const PreparedCase& prepared, const Field& field, const NodalVectors& u);

/// False for the force or torque on a patch that shares constrained nodes with another: no reference can be given.
bool comparable(const PreparedCase& prepared, const std::string& measure);

/// The moved supports that share no constrained nodes with another.
std::vector<std::string> comparable_moved_patches(const PreparedCase& prepared);

/// Largest relative error of the force or torque on a moved support; nothing where none is moved, or none can be
/// compared.
std::optional<ReactionDifference> reaction_error(const PreparedCase& prepared,
                                                 const std::map<std::string, double>& values,
                                                 const std::map<std::string, ReferenceValue>& truth);

/// Sum of the loads [N], body forces of exact fields left out.
Vec3 sum_of_loads(const PreparedCase& prepared);

/// What errors are relative to where this is the true displacement at the nodes of a lattice.
DisplacementScale scale_of_errors(const PreparedCase& prepared, const Lattice& lattice, const NodalVectors& truth);

/// Refinement ratios of the three grids, from their numbers of cells; directions of one cell do not count.
GridRatios ratios_of(const ElementGrids& e);

/// Adds a relative uncertainty.
void widen(double spread, ReferenceField& field);

/// Limit and uncertainty of every scalar measure.
std::map<std::string, ReferenceValue> limits_of(const PreparedCase& prepared, const ElementGrids& e);

/// The records of one element for the report: the requested measures on each grid, with their limits; with an exact
/// field also displacement_error and its observed order.
std::vector<ReferenceRecord> records_of(const PreparedCase& prepared, const IsotropicMaterial& material,
                                        const ElementGrids& e);

/// The records of a case without models as rows of results.csv, one per grid, beside the values expected.
std::vector<Row> rows_of(const PreparedCase& prepared, const std::vector<ReferenceRecord>& records);

/// region.<region>.<quantity>, of the means over each region, of finite elements or springs; an energy of NaN is none.
std::map<std::string, double> region_measures(const std::vector<MaterialRegion>& regions,
                                              const std::vector<fem::RegionMeans>& means);

/// interface.<region>.<other>.force of all that meet, of finite elements or springs.
std::map<std::string, double> interface_measures(const std::vector<MaterialRegion>& regions,
                                                 const std::vector<fem::InterfaceForce>& interfaces);

/// The likeliest cause that three grids do not converge in a measure, with a remedy, as a clause for the record's note:
/// meshes of one fineness, an element that locks, a probe at the rim of a patch, a surface or a rim that differs from
/// mesh to mesh, a grid too coarse across the body, or else the rims of supports, where stresses are singular.
std::string cause_and_remedy(const PreparedCase& prepared, const IsotropicMaterial& material, const ElementGrids& grids,
                             const std::string& measure);

}  // namespace springproof
