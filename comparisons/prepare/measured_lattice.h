// Cells of a case's lattice that are measured in a finer lattice: each once, and kept between runs.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "msm/coarsening/measure_cells.h"
#include "msm/models.h"
#include "msm/parameters/model_table.h"

namespace springproof {

/// The cells of one lattice of a body as measured, for any model and material of a case.
class MeasuredLattice {
 public:
  /// @param coarse cells of one size
  /// @param body tetrahedra that they are cut from
  /// @param held names of the patches that supports hold along all axes
  /// @param regions other materials of the body
  MeasuredLattice(std::shared_ptr<const CutBody> coarse, std::shared_ptr<const Mesh> body,
                  std::vector<std::string> held, std::vector<IsotropicMaterial> regions);

  /// The cells: of a body of several materials those of the body as one.
  const CutBody& cells() const { return *coarse_; }

  /// The cells as measured, per unit of Young's modulus, at the material's Poisson's ratio or, above it, at 0.3.
  /// Measures them unless this lattice or an earlier run has.  Thread-safe.
  /// @param parameters of a model of cut cells
  /// @param material of the body
  /// @return the forms, and how far they are off
  /// @throws std::runtime_error "interrupted", or if a state is not found
  const MeasuredBody& measured(const ModelParameters& parameters, const IsotropicMaterial& material);

  /// Gives the cells of a model of averaged springs their measured law.
  /// @param parameters of a model of cut cells
  /// @param material of the body
  /// @param held names of the patches that its anchors hold
  /// @param built of the cells as if they were all of this material; its law, anchors and volumes are changed
  /// @throws as measured()
  void apply(const ModelParameters& parameters, const IsotropicMaterial& material, const std::vector<std::string>& held,
             EmbeddedModel& built);

 private:
  MeasuredBody measure(const AveragedSprings& law);
  const FineCells& fine();
  Eigen::VectorXd weighed_volumes(const IsotropicMaterial& material);

  std::shared_ptr<const CutBody> coarse_;
  std::shared_ptr<const Mesh> body_;
  std::vector<std::string> held_;
  std::vector<IsotropicMaterial> regions_;
  std::mutex one_at_a_time_;
  std::optional<FineCells> fine_;              ///< once they are needed
  std::map<std::string, MeasuredBody> known_;  ///< by the constants of the law
};

}  // namespace springproof
