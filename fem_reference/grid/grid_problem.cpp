#include "fem_reference/grid/grid_problem.h"

namespace springproof::fem {

bool every_process_needs(const Mesh& mesh) { return !mesh.hexahedra.empty() && mesh.curved.size() == 0; }

}  // namespace springproof::fem
