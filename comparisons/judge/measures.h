// Computes every measure from Fields alone, by the same code for every solver.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/reference_value.h"
#include "meshes/field.h"
#include "problem/case_file/experiment.h"
#include "problem/case_file/measures.h"

namespace springproof {

/// Scalar measures of one field that have a value of their own: volume changes, reactions, probe displacements.
/// Names: volume_change, volume_change_magnitude, volume_change_first_order, force.<patch>.<x|y|z|magnitude>,
/// torque.<patch>.<...>, displacement.<probe>.<...>.
std::map<std::string, double> scalar_measures(const Field& field, const std::vector<Probe>& probes,
                                              const NodalVectors& probe_displacement);

/// xx yy zz xy yz xz [Pa], one row per probe.
using ProbeStresses = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// stress.<probe>.<xx|yy|zz|xy|yz|xz>.
std::map<std::string, double> stress_measures(const std::vector<Probe>& probes, const ProbeStresses& stress);

/// How far a reaction is off.
struct ReactionDifference {
  double error = -1;  ///< relative [1]
  std::string of;     ///< "force.z_max"
};

/// Largest difference of force or torque between two sets of measures on one of the patches, relative to the force or
/// torque of `truth`.  A force or torque that vanishes is left out: below its uncertainty, or below a tenth of the
/// other of the two, converted with the body's `length` [m] as lever arm.  Empty if none is left.
std::optional<ReactionDifference> reaction_difference(const std::map<std::string, double>& a,
                                                      const std::map<std::string, double>& b,
                                                      const std::map<std::string, ReferenceValue>& truth,
                                                      const std::vector<std::string>& patches, double length);

/// value + off * uncertainty of each measure.
std::map<std::string, double> values_of(const std::map<std::string, ReferenceValue>& limits, double off = 0);

/// |u - v| in weighted L2, divided by |v| [1].
double displacement_error(const NodalVectors& u, const NodalVectors& v, const Eigen::VectorXd& weights);

/// Mean |u - v| over the nodes of a plane [m].
/// @throws InputError if the plane holds no node of the mesh.
double section_distance(const Mesh& mesh, const Section& section, const NodalVectors& u, const NodalVectors& v);

/// Mean of (|dx| + |dy|) / 2, d the part of u - v in the plane (here z = const), over its nodes [m]: the difference per
/// coordinate, which is what Golec et al. (2019), sec. 6.2, print.
/// @throws InputError if the plane holds no node of the mesh.
double section_axis_distance(const Mesh& mesh, const Section& section, const NodalVectors& u, const NodalVectors& v);

/// Displacement of a hexahedral mesh at rest points, by trilinear interpolation, m x 3.
/// @throws InputError naming the point that lies outside.
NodalVectors interpolate(const Mesh& mesh, const NodalVectors& displacement, const NodalVectors& points);

}  // namespace springproof
