// VTK's XML file of an unstructured grid, compressed binary.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// One value of `components` numbers per point or cell.
struct VtuArray {
  std::string name;
  int components;
  std::vector<double> values;
};

/// What a file is of, as VTK's field data, and how its numbers are stored.
struct VtuNotes {
  std::vector<std::pair<std::string, std::string>> texts = {};
  std::vector<std::pair<std::string, double>> numbers = {};
  bool single = false;  ///< points and data in single precision
};

struct VtuFile {
  NodalVectors points;                     ///< [m]
  std::vector<std::int32_t> connectivity;  ///< the points of all cells
  std::vector<std::int32_t> offsets;       ///< of each cell: where its points end
  std::vector<std::uint8_t> types;         ///< VTK's numbers of cell types
  std::vector<VtuArray> point_data, cell_data;
  VtuNotes notes = {};

  template <class Nodes>
  void add_cell(const Nodes& nodes, std::uint8_t type) {
    connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    types.push_back(type);
  }
};

std::string text_of(const VtuFile& vtu);

}  // namespace springproof
