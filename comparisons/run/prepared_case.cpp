#include "comparisons/run/prepared_case.h"

namespace springproof {

void add_lattice(Lattice lattice, PreparedCase& prepared) {
  lattice.first_node = prepared.nodes();
  prepared.lattices.push_back(std::move(lattice));
}

bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree) {
  const double unknowns = 3.0 * static_cast<double>(mesh.nodes.rows()) * degree * degree * degree;
  return experiment.most_unknowns == 0 || unknowns <= experiment.most_unknowns;
}

}  // namespace springproof
