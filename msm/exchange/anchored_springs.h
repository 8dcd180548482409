// A springs file of cut cells as the model of a body.
#pragma once

#include <set>
#include <utility>

#include "msm/exchange/springs_file.h"

namespace springproof {

/// The model of a springs file, held at the patches `held` by the file's anchors, each with a node of its own of no
/// mass; and its embedding: loads are shared as the file says, the nodes of a cube of `mesh` follow the file's cell at
/// the cube's middle.
/// @throws InputError if the file has no weights of the nodes; std::out_of_range if it has no anchors of a patch.
std::pair<MassSpringModel, Embedding> anchored(const SpringsFile& file, const std::set<std::string>& held,
                                               const Mesh& mesh);

}  // namespace springproof
