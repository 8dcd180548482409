// A body for the soft bodies of real-time engines: docs/engines.md.
#pragma once

#include <string>
#include <vector>

#include "msm/exchange/springs_file.h"

namespace springproof {

/// For Jolt Physics, with the nodes of the patches `pinned` fixed: edges with their compliances, as JSON.
/// @throws InputError for a model of more than springs between the corners of whole cubes, or a Poisson's ratio other
/// than 1/4.
std::string jolt_json(const SpringsFile& springs, const std::vector<std::string>& pinned);

/// For Bullet's deformable bodies: tetrahedra with the constants of its materials, as JSON.  Of the springs file count
/// the nodes, their masses, the cells and the patches.
/// @throws InputError if the nodes are not the corners of whole cubes.
std::string bullet_json(const SpringsFile& springs, const std::vector<std::string>& pinned);

/// For MuJoCo: a model (MJCF) of one flex of tetrahedra with the mass of each node, whose pinned nodes are fixed.  Of
/// the springs file counts the same.
/// @throws InputError as bullet_json().
std::string mujoco_mjcf(const SpringsFile& springs, const std::vector<std::string>& pinned);

}  // namespace springproof
