// The body of a case, before it is meshed.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// A block is cut into `cells`; any other body into the cubes of a lattice whose centres it holds.
struct Body {
  std::string geo;           ///< file name: one of meshes/geo/, or a path relative to the case file
  Vec3 size = Vec3::Zero();  ///< [m], parameters of a .geo; of voxels the box around the body, once it is known
  std::vector<Cells> cells;  ///< resolutions of the mass-spring models, one or more; of voxels those of the box
  SourceLocation where;      ///< of the key `geo`
  std::vector<double> voxel_edges = {};  ///< [m]; empty: no voxels, or their counts are given
  std::vector<int> voxel_counts = {};    ///< about so many cubes; empty: their edges are given
  double scale = 1;                      ///< coordinates of a file are multiplied by it

  bool is_script() const;  ///< a .geo, whose size is a parameter; else a file of a body as it is
  bool is_voxels() const { return !voxel_edges.empty() || !voxel_counts.empty(); }
  std::size_t resolutions() const { return std::max({cells.size(), voxel_edges.size(), voxel_counts.size()}); }
};

}  // namespace springproof
