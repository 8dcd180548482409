// What a springs file says of cells: their sizes, filled parts, anchors and shares in loads.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "msm/exchange/json_place.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// Rows of different nodes.
/// @param largest number of a node
/// @param what connects the nodes of a row, if it may do so but once: named twice it would be twice as stiff
template <std::size_t n>
std::vector<std::array<int, n>> rows(const JsonPlace& place, int largest, const char* what = nullptr) {
  const std::vector<int> flat = place.integers(static_cast<int>(n), largest);
  std::vector<std::array<int, n>> all(flat.size() / n);
  std::vector<std::pair<std::array<int, n>, std::size_t>> sorted;
  for (std::size_t r = 0; r < all.size(); ++r) {
    std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(n * r), n, all[r].begin());
    std::array<int, n>& nodes = sorted.emplace_back(all[r], r).first;
    std::sort(nodes.begin(), nodes.end());
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
      place.refuse(fmt::format("number {} names a node twice", r), fmt::format("{} different nodes", n));
  }
  if (!what) return all;
  std::sort(sorted.begin(), sorted.end());
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end(), same); twice != sorted.end())
    place.refuse(fmt::format("{}s {} and {} connect the same nodes", what, twice->second, std::next(twice)->second),
                 fmt::format("one {} for the same nodes", what));
  return all;
}

/// `cells` of the document, if it has any, and `triangles`.
/// @param version of the file
/// @throws InputError unless they are cubes, of several sizes from version 3 on, full boxes, from version 4 on, or
/// parts of cubes.
void read_cells(const JsonPlace& document, double version, Network& network);

/// `carried` of the document: nodes that are the means of others, which have no mass, and no others without.
/// @throws InputError unless each is in its mean at rest, and follows none that comes later.
void read_carried(const JsonPlace& document, Network& network);

/// `regions` of the document, `material` of its cells and `bonds` between them, from version 5 on.
/// @param document with its cells in the network of `file`
/// @throws InputError unless the cells are cut, have the masses of the nodes, and bonds are at rest and hold.
void read_materials(const JsonPlace& document, double version, SpringsFile& file);

/// `anchors` and `loads` of the document and `weight_kg` of its nodes.
/// @throws InputError also if an anchor is not at rest.
void read_supports_and_loads(const JsonPlace& document, double version, SpringsFile& file);

}  // namespace springproof
