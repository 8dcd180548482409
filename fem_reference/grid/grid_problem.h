// One discretisation as the solver takes it.  No deal.II in this header.
#pragma once

#include <functional>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/exchange/request.h"
#include "meshes/vtu.h"

namespace springproof::fem {

enum class Method {
  automatic,      ///< matrix-free where the cells have a multigrid hierarchy, else assembled
  assembled,      ///< assembled matrices; for quadratic elements a level of linear ones above algebraic multigrid
  assembled_gamg  ///< assembled matrices, algebraic multigrid alone: the usual method, and the baseline of the
                  ///< benchmarks
};

struct GridProblem : CommonProblem {
  Mesh coarse;                                  ///< cells of one kind, with named patches (every_process_needs())
  int refinements = 0;                          ///< each cell is cut into 8 this many times
  std::function<Vec3(const Vec3&)> place;       ///< moves the vertices of the finest mesh; empty: not moved
  int degree = 2;                               ///< 1 or 2
  std::vector<IsotropicMaterial> regions = {};  ///< of Mesh::materials from 1 on

  /// Of cells of this number in Mesh::materials.
  const IsotropicMaterial& material_of(unsigned int number) const {
    return number == 0 ? material : regions.at(number - 1);
  }
  std::function<Vec3(const Vec3& X, double time)> body_force;  ///< [N/m^3], besides gravity; empty: none
  Method method = Method::automatic;
  bool wide_vectors = true;  ///< use wide SIMD vectors, where the processor has them
  int steps = 0;             ///< in which `motion` is made
  std::string vtu;           ///< file for ParaView of a converged solution; empty: none
  VtuNotes vtu_notes;        ///< what it says of itself
  bool own_memory = false;   ///< Solution::memory_MiB is the growth due to this grid
};

/// The laws of the materials of a body, of cells by their number in Mesh::materials: in the body's own material, then
/// in those of its regions.  Each has the form that is right for it alone.
/// @param law none: small strain
inline std::vector<CellLaw> laws_of(const GridProblem& problem, std::optional<Law> law, bool tetrahedra) {
  std::vector<CellLaw> laws;
  for (unsigned int number = 0; number <= problem.regions.size(); ++number) {
    const IsotropicMaterial& m = problem.material_of(number);
    CellLaw& own = laws.emplace_back(
        CellLaw{law, form_for({tetrahedra, problem.degree}, m.poisson_ratio, !law), shear_modulus(m), lame_lambda(m)});
    own.pointwise = pointwise_part(tetrahedra, own);
    own.density = m.density;
  }
  return laws;
}

/// The form of a body of these materials.
inline Form form_of(const std::vector<CellLaw>& laws) { return any_mixed(laws) ? Form::mixed : laws.front().form; }

/// True of straight hexahedra, which are refined: each of several processes stores the whole mesh.  Of any other, which
/// is divided, the first process has the mesh and the others one without cells.
inline bool every_process_needs(const Mesh& mesh) { return !mesh.hexahedra.empty() && mesh.curved.size() == 0; }

}  // namespace springproof::fem
