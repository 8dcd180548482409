// Points and displacements of another program, read from a CSV file: docs/engines.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "problem/vector.h"

namespace springproof {

struct ExternalPoints {
  NodalVectors X = NodalVectors(0, 3);  ///< at rest [m]
  NodalVectors u = NodalVectors(0, 3);  ///< displacement [m]
  std::vector<int> lines;               ///< of the file, one per point
};

struct ExternalFormat {
  double scale = 1;          ///< metres per unit of length of the file
  bool y_up = false;         ///< the file's y is our z, its z our -y
  double poisson_ratio = 0;  ///< a column of this name must have this value
};

/// Columns x, y, z and either ux, uy, uz or X, Y, Z (deformed positions), in any order, others beside them; Points:0
/// ... and displacement:0 ..., as ParaView writes them, are taken for the same.  Separated by commas, semicolons or
/// tabs; lines that are empty or begin with # are left out.
/// @throws InputError with file, line, column.
ExternalPoints read_external_points(const std::filesystem::path& file, const ExternalFormat& format);

/// Such a file of nodes and displacements, with as many digits as read back exactly.
std::string csv_of(const NodalVectors& X, const NodalVectors& u);

}  // namespace springproof
