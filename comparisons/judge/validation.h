// Simulated values beside measured ones, by ASME V&V 20 (2009).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/reference_value.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Adds to a case with measured values `validation`, what it says in sentences, and |E| / u_val as rows "measured.NAME"
/// of its first model: E = S - D; u_val^2 = u_num^2 + u_input^2 + u_D^2.  S and u_num are those of the limit of the
/// model's lattices; of two by first order, of one u_num is unknown, and with it u_val.  Where an input was fitted to a
/// value, u_input of the others is what the fit does not compensate, with the uncertainty that the fit has from its
/// value.  Nothing is judged beside a fit that misses its value by more than 2 u_num and u_D, nor a value of which a
/// run with an input changed has none; the sentences say so.
void validate(CaseResult& result);

/// Largest |E| / u_val that shows no error of the model.
inline constexpr double no_model_error = 2;

/// The table, for a terminal of 100 columns; empty: nothing was measured.
std::string validation_table(const CaseResult& result);

/// Where a computation was made.
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
