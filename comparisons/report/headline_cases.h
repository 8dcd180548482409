// Sentences of the verdict on each case as a whole: uncertainty of the reference, size of the deformation, failures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/report/headline.h"
#include "comparisons/results/records.h"

namespace springproof {

/// One sentence on the references (of cases with models) that do not converge or are uncertain by more than 5 %, if
/// any.
std::optional<Warning> doubt_of_reference(const std::vector<CaseResult>& cases);

/// "bunny: ν = 0.45: 12 %, 31°; ...": largest principal strain and rotation of the reference; or nothing.
std::string deformation_line(const CaseResult& result);

/// Of one motion, what it kept and what it cost: "Over 0.5 s, 12000 steps, hybmss_avg keeps its energy within 1e-5,
/// ...; a step takes 0.4 ms, 10 s of computing for 1 s of motion."; of the `closest` model in motion, else of the first
/// one, which is the closest where none was named.  Empty: nothing moves.
std::string motion_sentence(const std::vector<CaseResult>& cases, std::vector<std::string>& closest);

/// Of a case that asks for no reference and expects nothing: its numbers on the finest cells, a line each.
std::vector<std::string> measured_lines(const CaseResult& result);

/// Of each motion one line: period and amplitude of the first probe, drift of energy and momentum.
std::vector<std::string> motion_lines(const CaseResult& result);

/// That linear theory does not apply to a linear case with models, and what to do, if so.
std::optional<Warning> deformation_warning(const CaseResult& result, std::size_t case_number);

/// "Linear theory does not hold here: bracket has principal strains of 37 % and rotations of 58°."; empty: it does.
std::string beyond_linear_theory(const std::vector<CaseResult>& cases);

/// Why a case failed, apart from its expectations: no reference at some nu, no run with a result, nothing compared.
std::vector<std::string> failures_of(const CaseResult& result);

/// Of a case without models one line for each expected or published value: value, target, error, verdict.
std::vector<std::string> verification_lines(const CaseResult& result);

/// "bar: hybmss at ν = 0 may lose its equilibrium: it is to be lengthened by 40 %, and its lattice is stable to 17 %
/// ..."
std::string limit_sentence(const Experiment& experiment, const LatticeLimit& limit);

/// Of a case one warning for each model that lost its equilibrium, may have, or has wrinkles: at which nu and strain,
/// what happened, and what to do.
std::vector<Warning> stability_warnings(const CaseResult& result, std::size_t case_number);

/// Of cases in which a model at rest lost its equilibrium: the least share of the load, over them and all Poisson's
/// ratios at the finest cells, up to which each model is stable, the best model first.  Empty: none was lost.
std::string stability_answer(const std::vector<CaseResult>& cases);

}  // namespace springproof
