// Sentences of the verdict on each case as a whole: uncertainty of the reference, size of the deformation, failures.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/report/headline.h"

namespace springproof {

/// One sentence on the references (of cases with models) that do not converge or are uncertain by more than 5 %, if
/// any.
std::optional<Warning> doubt_of_reference(const nlohmann::json& cases);

/// "bunny: ν = 0.45: 12 %, 31°; ...": largest principal strain and rotation of the reference; or nothing.
std::string deformation_line(const nlohmann::json& result);

/// Of each motion one line: period and amplitude of the first probe, drift of energy and momentum.
std::vector<std::string> motion_lines(const nlohmann::json& result);

/// That linear theory does not apply to a linear case with models, and what to do, if so.
std::optional<Warning> deformation_warning(const nlohmann::json& result, std::size_t case_number);

/// Why a case failed, apart from its expectations: no reference at some nu, no run with a result, nothing compared.
std::vector<std::string> failures_of(const nlohmann::json& result);

/// Of a case without models one line for each expected or published value: value, target, error, verdict.
std::vector<std::string> verification_lines(const nlohmann::json& result);

}  // namespace springproof
