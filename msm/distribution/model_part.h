// The part of a model that gives the forces on some of its nodes: what one of several processes keeps of it.
#pragma once

#include <vector>

#include "msm/laws/capabilities.h"

namespace springproof {

/// Every spring, triangle, cell, anchor and bond that acts on a node of the part's own, among all nodes of the whole:
/// the forces on own nodes and their rows of the tangent are those of the whole model.  Those of other nodes are not
/// complete.
struct ModelPart {
  MassSpringModel model;   ///< springs and cells in the order of the whole
  std::vector<int> cells;  ///< numbers in the whole, ascending
};

/// @param whole a model without periodic images
/// @param own per node
/// @return its part
/// @throws std::invalid_argument for a periodic model, one whose forces have no energy (can(, Capability::energy)), and
/// momentum dispersion of finite strain.
ModelPart part_of(const MassSpringModel& whole, const std::vector<char>& own);

}  // namespace springproof
