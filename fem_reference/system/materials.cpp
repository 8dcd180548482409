#include "fem_reference/system/materials.h"

namespace springproof::fem {

std::vector<CellLaw> laws_of(const GridProblem& problem, std::optional<Law> law, bool tetrahedra) {
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

}  // namespace springproof::fem
