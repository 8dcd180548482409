// Writes a case as an input deck for CalculiX (ccx) or Abaqus.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "comparisons/calculix/quadratic_mesh.h"
#include "problem/case_file/experiment.h"

namespace springproof::calculix {

/// A displacement component that is prescribed; where two loads prescribe it, the one named first applies.
struct HeldComponent {
  int node;
  int component;  ///< 0, 1, 2
  int load;       ///< index into Experiment::loads
};

/// What is asked of a body, if not its equilibrium.
struct DeckTask {
  int modes = 0;  ///< natural frequencies as it is held, at small displacements
  int steps = 0;  ///< equal steps in time of its motion
};

struct Deck {
  Experiment experiment;
  IsotropicMaterial material;  ///< of what is in no region
  Mesh linear;                 ///< the mesh with corner nodes only
  QuadraticMesh mesh;
  std::string element;              ///< "C3D20", "C3D20R" or "C3D10"
  std::vector<HeldComponent> held;  ///< by node, then component
  NodalVectors forces;              ///< concentrated loads [N]: all but gravity
  Vec3 gravity = Vec3::Zero();      ///< sum of all [m/s^2]
  int steps = 1;                    ///< a large rotation is applied in steps along its arc
  DeckTask task = {};
  NodalWeights at_probes;      ///< a row per probe; of a motion, else empty
  Vec3 centre = Vec3::Zero();  ///< of mass; of a motion [m]
};

/// The largest Poisson's ratio for fully integrated elements; above, reduced integration with eight points, which does
/// not lock.
inline constexpr double largest_ratio_full_integration = 0.4;

/// Whether some material of a case has a larger one.
/// @param material of the body where no region is
bool needs_reduced_integration(const Experiment& experiment, const IsotropicMaterial& material);

/// "C3D20", "C3D20R" or "C3D10" of a case on a mesh.
const char* element_of(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& mesh);

/// @throws InputError naming what of a motion has no counterpart, with its place in the file.
void require_motion_counterpart(const Experiment& experiment);

/// @param mesh with Mesh::materials where the case has regions, each of which is a section of its own
/// @throws InputError as counterpart(); for an unknown patch, a point force outside the body, two patches of the
///   same name once written as a set.
Deck make_deck(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& mesh, DeckTask task = {});

/// Writes the deck, SI units.  Nodes and elements count from 1.  Printed into the .dat file at the end of the
/// last step: U of ALL_NODES, RF of HELD_NODES, their totals per patch; or the frequencies; or at every step in time U
/// of AT_PROBES.
void write(const Deck& deck, std::ostream& out);

/// External nodal loads at the full load, gravity included [N]: contained in RF in addition to the support forces.
NodalVectors external_loads(const Deck& deck);

/// A law of the case files, and its form in a deck.
struct Counterpart {
  const char* kinematics;
  bool finite;
  const char* remark;
  void (*write)(const IsotropicMaterial&, std::ostream&);
};

/// That of a case.
/// @throws InputError if its law has none, naming those that have
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
