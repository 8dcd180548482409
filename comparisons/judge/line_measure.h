// Strain and stress of a spring network along a line, against Kelvin's solution: Kot et al. (2014), sec. 5.2.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/results/records.h"
#include "msm/laws/laws.h"
#include "problem/kelvin.h"

namespace springproof {

/// Samples the line.  Strain: moving least squares over the nodes within 2 mean spacings (V/N)^(1/3); stress: Hardy's,
/// in balls of 2 mean spacings, left out for models whose forces are not all tensions of springs.  Small strains.
/// The caller sets model, Poisson's ratio and cells of the record.
LineRecord sample_line(const Line& line, const KelvinSolution& solution, const MassSpringModel& model,
                       const NodalVectors& u);

/// line.strain.<xx|yy|zz|xy|yz|xz> and line.stress.<...>: sum |value - Kelvin's| / sum |Kelvin's| of that component
/// over the middle points; a component of Kelvin's that vanishes there is divided by the sum of the norms |Kelvin's|
/// instead. line.strain.all, line.stress.all: the same of the norm of the difference of the tensors.
std::map<std::string, double> line_deviations(const LineRecord& record);

/// line.strain.order, line.stress.order for every row of line.*.all that has one on the next coarser lattice:
/// log(coarse / fine) / log(edge ratio).
void add_line_orders(const Experiment& experiment, std::vector<Row>& rows);

}  // namespace springproof
