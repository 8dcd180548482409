#include "fem_reference/exchange/case_request.h"

#include "meshes/mesher/mesher.h"

namespace springproof::fem {

Request request_of(const Experiment& experiment, const IsotropicMaterial& material) {
  Request request;
  request.name = experiment.file.string();
  if (!experiment.body.is_voxels()) {
    request.geo = find_geo(experiment.body, experiment.file);
    request.patches = experiment.patches;
  }
  request.size = experiment.body.size;
  request.law = experiment.kinematics;
  request.material = experiment.at_rest(material);
  request.regions = experiment.regions;
  request.loads = experiment.loads;
  request.masses = experiment.masses;
  request.tolerance = 1e-8;
  request.cost = experiment.cost;
  return request;
}

}  // namespace springproof::fem
