// Simulated values beside measured ones, by ASME V&V 20 (2009).
#pragma once

#include <string>

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

}  // namespace springproof
