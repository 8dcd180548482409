// A springs file as a tree of keys with its arrays apart: what is written as JSON or as arrays of NumPy.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "msm/exchange/springs_file.h"

namespace springproof {

/// Row by row.
struct NamedArray {
  std::string name;  ///< its keys, "nodes.position_m"
  std::vector<std::size_t> shape;
  std::variant<std::vector<double>, std::vector<std::int32_t>> values;
};

struct SpringsDocument {
  nlohmann::ordered_json head;  ///< where an array belongs: the text "npy:" and its name
  std::vector<NamedArray> arrays;
};

SpringsDocument document_of(const SpringsFile& springs);

/// One key per line, an array in one line.
std::string as_json(const SpringsDocument& document);

/// An array as a .npy file of NumPy, version 1.0.
std::string npy(const NamedArray& array);

/// By their keys: the constants of cells by which branches resist, of a sum of shares of 1.
/// @param cells RelaxingCells::cells; `Cells` const or not
/// @return the keys with references to the constants
template <class Cells>
auto branch_constants(Cells& cells) {
  using Constant = std::conditional_t<std::is_const_v<Cells>, const double&, double&>;
  return std::array<std::pair<const char*, Constant>, 6>{{{"shear_modulus_Pa", cells.shear_modulus},
                                                          {"bending", cells.hourglass.bending},
                                                          {"coupling", cells.hourglass.coupling},
                                                          {"torsion", cells.hourglass.torsion},
                                                          {"twist", cells.hourglass.twist},
                                                          {"warping", cells.hourglass.warping}}};
}

/// The name of a law as a key, "volume_correction".
std::string key_of_law(const LawTraits& traits);

inline constexpr const char* springs_format = "springproof springs";
inline constexpr int springs_version = 1, springs_version_of_cut_cells = 2, springs_version_of_several_sizes = 3,
                     springs_version_of_boxes = 4, springs_version_of_materials = 5, springs_version_of_branches = 6,
                     springs_version_of_stiff_walls = 7;

}  // namespace springproof
