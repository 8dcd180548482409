// Field: the only thing a solver hands over.  Every measure is computed from Fields alone, by the same code.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/vtu.h"

namespace springproof {

/// Force [N] and torque [N m] that the support of a patch exerts on the body; the torque is about the patch's rest
/// centroid, with lever arms at rest (linear) or deformed (finite).
struct PatchReaction {
  std::string patch;           ///< its name
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]
};

/// A solution on a mesh.
struct Field {
  std::shared_ptr<const Mesh> mesh;      ///< at whose nodes the displacement is given
  NodalVectors displacement;             ///< n x 3 [m]
  std::vector<PatchReaction> reactions;  ///< one per patch with prescribed displacement
  double volume_change = 0;              ///< (V' - V)/V of the solver's own interpolation, exact [1]
  double volume_change_first_order = 0;  ///< integral of div u / V [1]
};

/// Values at nodes by name, one row per node.
using NodalFields =
    std::vector<std::pair<std::string, Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>>;

/// Numbers by name.
using NamedNumbers = std::vector<std::pair<std::string, std::vector<double>>>;

/// Writes a VTU (VTK XML, compressed binary): displacement, `extra` values at nodes (e.g. difference to FEM), the
/// relative volume change of each cell, and `of_cells`, one number per cell.
/// @throws std::runtime_error if the file cannot be written; std::invalid_argument if the sizes do not fit.
void write_vtu(const std::filesystem::path& file, const Field& field, const NodalFields& extra = {},
               const VtuNotes& notes = {}, const NamedNumbers& of_cells = {});

/// Writes a ParaView collection: the time [s], or Poisson's ratio, and the name of each VTU file of a series, beside
/// which it lies.
/// @throws std::runtime_error if the file cannot be written.
void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& series);
/// Writes lines between points: displacement of the points, one number of each name per line.
/// @throws std::runtime_error if the file cannot be written; std::invalid_argument if the sizes do not fit.
void write_lines_vtu(const std::filesystem::path& file, const NodalVectors& points, const NodalVectors& displacement,
                     const std::vector<std::array<int, 2>>& lines, const NamedNumbers& values);

}  // namespace springproof
