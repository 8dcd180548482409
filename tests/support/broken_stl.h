// Twelve STL files with something wrong, and what is to be said of each.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "support/surfaces.h"

namespace springproof::test {

struct BrokenFile {
  std::string name;
  std::function<void(const std::filesystem::path&)> write;
  std::string outcome;  ///< part of the message or note; the place is that of the fault
  bool mended;          ///< else refused
};
inline void PrintTo(const BrokenFile& broken, std::ostream* out) { *out << broken.name; }

const std::vector<BrokenFile>& broken_files();

/// Every facet with points of its own, as in a file.
Surface loose(const Surface& surface);

// The surfaces of some of them; the sphere that they were has radius 1 and 1280 facets.
Surface pyramid_sphere();
Surface with_a_flipped_facet();
Surface with_facets_without_area();
Surface unwelded();

}  // namespace springproof::test
