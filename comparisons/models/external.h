// Displacements of another program, compared as a model of the case is: [[external]], docs/engines.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparisons/models/model_run.h"
#include "comparisons/prepare/prepared_case.h"
#include "msm/topology/point_cells.h"

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

/// A displacement that is known at points anywhere, brought to others.
class ScatteredField {
 public:
  /// Points and their displacements, n x 3 [m], at least one.
  ScatteredField(NodalVectors points, NodalVectors displacement);

  /// Median distance of a point from the nearest other place that has one [m]; 0 for a single place.
  double spacing() const { return spacing_; }

  double distance(const Vec3& p) const;  ///< from the nearest point [m]

  /// Whether there is a point at p, to 1e-4 of the spacing.
  bool is_at(const Vec3& p) const { return distance(p) <= same_place(); }
  std::vector<int> points_at(const Vec3& p) const { return near(p, same_place()); }  ///< their rows

  /// At a point its displacement (of several the mean); elsewhere that of the affine field fitted to the points around
  /// p by moving least squares, with weights (1 - (d / R)^2)^3 up to a distance R of 1.6 spacings, or as many more as
  /// they need to span a volume.  Affine displacements are reproduced exactly.
  /// @throws std::invalid_argument if points within ten spacings span no volume.
  Vec3 at(const Vec3& p) const;

 private:
  std::vector<int> near(const Vec3& p, double radius) const;
  double same_place() const { return 1e-4 * spacing_; }

  NodalVectors X_, u_;
  double edge_;  ///< of the cells [m]
  PointCells cells_;
  double spacing_ = 0;
};

/// What stands for such an entry in PreparedCase::models: no model can be built of it.
ModelParameters parameters_of_external(const ModelChoice& choice);

/// Reads entry `number` of the case's models and brings its displacements to the nodes of a lattice.
/// @throws InputError for what cannot be read; for points that are not in the body, or so far from a node that its
/// displacement is not known; for a reaction on a patch that the body lacks.
void check_external(const PreparedCase& prepared, std::size_t number);

/// Where displacements are a power of ten times those of the reference, to a fifth, a sentence on the units that would
/// explain it; else empty.
std::string unit_doubt(const NodalVectors& u, const NodalVectors& reference);

/// The entry as the result of a model, if this lattice is the one whose number of nodes is nearest to its number of
/// points and this material its own; else nothing.  At a node where it has a point the displacement is the file's,
/// elsewhere as ScatteredField::at() says, in a body of voxels as the finite elements' is carried to nodes outside.
/// Volume changes are measured where every node has its point.
std::vector<ModelSample> external_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                          const IsotropicMaterial& material);

}  // namespace springproof
