// A part of the body that is of another material.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "problem/material.h"
#include "problem/patch_rule.h"
#include "problem/system/input_error.h"

namespace springproof {

/// What a closed surface in a file encloses.
struct EnclosedPlace {
  std::filesystem::path file;
  double scale = 1;  ///< coordinates of the file are multiplied by it
};

/// Where a region lies: in a physical volume of the body's file, by its name or number, in a box, a ball or a
/// half-space, or in a closed surface.
using RegionPlace = std::variant<std::string, PatchRule::Box, PatchRule::Near, PatchRule::Beyond, EnclosedPlace>;

/// A part of the body that is of another material.  Regions are numbered from 1 in the order of the case file; 0 is
/// what is in none of them, of the body's own material.
struct MaterialRegion {
  std::string name;            ///< as measures and messages refer to it
  IsotropicMaterial material;  ///< of all of it
  SourceLocation where;        ///< of the entry in the case file
  RegionPlace place = {};      ///< where it lies
};

/// The physical volume that each region is; "": it is none.
inline std::vector<std::string> volumes_of(const std::vector<MaterialRegion>& regions) {
  std::vector<std::string> volumes;
  for (const MaterialRegion& r : regions) {
    const std::string* volume = std::get_if<std::string>(&r.place);
    volumes.push_back(volume ? *volume : "");
  }
  return volumes;
}

/// Materials of the regions, in their order.
inline std::vector<IsotropicMaterial> materials_of(const std::vector<MaterialRegion>& regions) {
  std::vector<IsotropicMaterial> materials;
  for (const MaterialRegion& r : regions) materials.push_back(r.material);
  return materials;
}

}  // namespace springproof
