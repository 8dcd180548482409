// Sentences on models that lose their equilibrium: before they are run, and when it happened.
#pragma once

#include <string>
#include <vector>

#include "comparisons/report/headline.h"
#include "comparisons/results/records.h"

namespace springproof {

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
