// The measures a case can ask for, and the rows they give.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace springproof {

struct Experiment;

/// Names allowed in [compare] measures: displacement_error, displacement_error_max, section_distance,
/// section_axis_distance, volume_change, volume_change_magnitude (its absolute value, the papers' e),
/// volume_change_first_order, reaction, reaction_error (largest relative error of the force or torque on a moved
/// support; always measured where a support is moved), mean_displacement (of the patches), probe, stress (finite
/// elements only), displacement_error_order (observed, between the two finest grids; where the exact solution is
/// known), network (what the spring network is made of), moduli (of a block stretched along x, as the papers measure
/// them), line (strain and stress along a line, against Kelvin's solution).
std::vector<std::string> measure_names();

/// Names of the rows that a measure gives for an experiment, as [[expect]] and [[published]] write them. Most
/// give one row of their own name; `reaction` gives force.<patch>.x|y|z|magnitude and
/// torque.<patch>.x|y|z|magnitude for each patch with prescribed displacement; `probe` gives
/// `mean_displacement` mean_displacement.<patch>.x|y|z|magnitude for each patch of the body, which only its mesh knows
/// (here those that loads and [[patch]] name); `probe` gives displacement.<name>.x|y|z|magnitude for each probe,
/// `stress` stress.<name>.xx|yy|zz|xy|yz|xz; `line` line.strain|stress.xx|yy|zz|xy|yz|xz|all, and .order with several
/// resolutions.
std::vector<std::string> rows_of_measure(const std::string& measure, const Experiment& experiment);

/// Relative displacement [m] along x that the loads prescribe between x_min and x_max; empty: they do not.
std::optional<double> elongation_along_x(const Experiment& experiment);

/// Patches on which a load prescribes displacement, in the file's order, each once.
std::vector<std::string> supported_patches(const Experiment& experiment);

/// Those of them that are moved: the displacement prescribed there is not zero everywhere.
std::vector<std::string> moved_patches(const Experiment& experiment);

/// The patch that a row of mean_displacement is of; empty: it is no such row.
std::string patch_of_mean_displacement(const std::string& row);

}  // namespace springproof
