// Measured values as the models of a case have them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/reference_value.h"
#include "comparisons/results/records.h"

namespace springproof {

/// WhereComputed a computation was made.
struct WhereComputed {
  std::string model;
  Cells cells;
};

/// The quantity as it was measured, from the rows of a result, with one of the inputs changed, or none ("").
/// @return empty: a row that it takes is missing
std::optional<double> simulated(const CaseResult& result, const MeasuredValue& measured, const std::string& input,
                                const WhereComputed& at);

/// Values on the lattices that have one, coarse to fine.
struct LatticeValues {
  std::vector<Cells> cells;
  std::vector<double> values;
};

bool has_fewer_cells(const Cells& a, const Cells& b);

/// A measured value on the lattices of a result.
LatticeValues sequence_of(const CaseResult& result, const MeasuredValue& measured, const std::string& model);

/// The limit of the last two lattices that have a value, or three; empty: of one, or of two that hardly differ.
std::optional<ReferenceValue> limit_of(const LatticeValues& sequence);

}  // namespace springproof
