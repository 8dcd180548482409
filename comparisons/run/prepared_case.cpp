#include "comparisons/run/prepared_case.h"

#include <algorithm>
#include <iterator>

namespace springproof {

EmbeddedModel build_on(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                       const IsotropicMaterial& material) {
  if (!parameters.cut.value_or(false)) return build_embedded(parameters, *lattice.mesh, material, lattice.region.get());
  std::set<std::string> held;
  for (const Load& load : prepared.loads)
    if (prescribes_displacement(load)) held.insert(*patch_of(load));
  return build_cut(parameters, *lattice.cut, {held.begin(), held.end()}, *lattice.mesh, material);
}

void add_lattice(Lattice lattice, PreparedCase& prepared) {
  lattice.first_node = prepared.nodes();
  prepared.lattices.push_back(std::move(lattice));
}

std::size_t finest_lattice(const PreparedCase& prepared) {
  const auto& all = prepared.lattices;
  const auto finer = [](const Lattice& a, const Lattice& b) {
    return a.mesh->hexahedra.size() < b.mesh->hexahedra.size();
  };
  return static_cast<std::size_t>(std::max_element(all.begin(), all.end(), finer) - all.begin());
}

std::vector<std::string> elements_of(const Experiment& e, char shape) {
  std::vector<std::string> elements;
  if (!e.models.empty())
    std::copy_if(e.elements.begin(), e.elements.end(), std::back_inserter(elements),
                 [&](const std::string& name) { return name[0] == shape; });
  return elements;
}

bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree) {
  const double unknowns = 3.0 * static_cast<double>(mesh.nodes.rows()) * degree * degree * degree;
  return experiment.max_unknowns == 0 || unknowns <= experiment.max_unknowns;
}

}  // namespace springproof
