// The body of a case, before it is meshed.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// The longest side of any body [m].  Products of a few lengths, moduli and densities then stay finite, and springs
/// files can be read again; 1e9 is also the largest coordinate.
inline constexpr double smallest_body = 1e-6, largest_body = 1e9;

/// Endings of the files that a body can be, in small letters: a script's ".geo" first.
const std::vector<std::string>& body_file_endings();

/// A block is divided into `cells`; any other body into those cubes of a lattice whose centres lie inside it.
struct Body {
  std::string geo;           ///< file name: one of meshes/geo/, or a path relative to the case file
  Vec3 size = Vec3::Zero();  ///< [m], parameters of a .geo; for voxels the bounding box of the body, once it is known
  std::vector<Cells> cells = {};         ///< resolutions of the springs, one or more; for voxels of the bounding box
  SourceLocation where = {};             ///< of the key `geo`
  std::vector<double> voxel_edges = {};  ///< [m]; empty: no voxels, or their counts are given
  std::vector<int> voxel_counts = {};    ///< approximate numbers of cubes; empty: no voxels, or their edges are given
  bool cut = true;                       ///< voxels: models that can take cut cells instead of whole cubes
  std::vector<double> accuracies = {};   ///< voxels: promised errors to which cut cells are halved; empty: one size
  bool coarsened = false;                ///< voxels: cut cells whose stiffness is measured in finer ones
  double scale = 1;                      ///< coordinates of a file are multiplied by it

  bool is_script() const;        ///< true for a .geo, whose size is a parameter; false for a file with fixed geometry
  bool states_its_unit() const;  ///< true for a STEP file
  bool is_voxels() const { return !voxel_edges.empty() || !voxel_counts.empty(); }
  std::size_t resolutions() const {
    return std::max({cells.size(), voxel_edges.size(), voxel_counts.size(), accuracies.size()});
  }
};

}  // namespace springproof
