// The readers of the longer parts of a case file, one .cpp each.
#pragma once

#include "problem/case_file/experiment.h"
#include "problem/case_file/toml_reader.h"

namespace springproof {

/// One [[load]]: as many loads as `on` names patches.
std::vector<Load> read_load(const TomlValue& value);

/// The [[patch]] tables, in order.
std::vector<PatchRule> read_patch_rules(const TomlTable& document);

/// A list of elements, each once.
std::vector<std::string> read_elements(const TomlValue& value, const std::vector<std::string>& allowed);

/// [line]; loads, materials and kinematics must have been read.
void read_line(const TomlTable& document, Experiment& experiment);

/// Gives the loads of the field "kelvin" their solution.
/// @throws InputError at such a load if the case has no such solution, or a finite element reference.
void settle_kelvin(Experiment& experiment);

/// Held against each other, before any body is known; loads, kinematics and models must have been read.
/// @throws InputError at a load that cannot be applied, or contradicts another one.
void check_loads(const Experiment& experiment);

/// The three grids of the reference are halved twice, and no larger than what this machine holds; `value` is
/// [reference].
void check_reference_cells(const TomlValue& value, const Experiment& experiment);

/// [compare] and, held against it, [[expect]] and [[published]].  Body, materials, loads, probes, section and
/// reference of the experiment must have been read.
void read_compare(const TomlTable& document, Experiment& experiment);
void read_expectations(const TomlTable& document, Experiment& experiment);
void read_published(const TomlTable& document, Experiment& experiment);

}  // namespace springproof
