// A body for the soft bodies of real-time engines: docs/engines.md.
#pragma once

#include <string>
#include <vector>

#include "msm/exchange/springs_file.h"

namespace springproof {

/// A body with the patches whose nodes are to be fixed; `springs` outlives it.
struct EngineBody {
  const SpringsFile& springs;
  std::vector<std::string> pinned;
};

/// For Jolt Physics: edges with their compliances, as JSON.
/// @throws InputError for a model of more than springs between the corners of whole cubes, or a Poisson's ratio other
/// than 1/4.
std::string jolt_json(const EngineBody& body);

/// For Bullet's deformable bodies: tetrahedra with the constants of its materials, as JSON.  Of the springs file count
/// the nodes, their masses, the cells and the patches.
/// @throws InputError if the nodes are not the corners of whole cubes.
std::string bullet_json(const EngineBody& body);

/// For MuJoCo: a model (MJCF) of one flex of tetrahedra with the mass of each node, whose pinned nodes are fixed.  Of
/// the springs file counts the same.
/// @throws InputError as bullet_json().
std::string mujoco_mjcf(const EngineBody& body);

}  // namespace springproof
