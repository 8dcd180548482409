// What was measured of a body in time: a CSV file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof {

/// One line of the file.
struct HistorySample {
  double time = 0;          ///< [s]
  double value = 0, u = 0;  ///< with its standard uncertainty, in the unit of the columns
  int line = 0;             ///< from 1
};

inline constexpr std::size_t most_samples = 20;  ///< of a history: each is an equilibrium of its own

/// Columns time_s, value_UNIT and u_UNIT, of a quantity without a unit value and u.
/// @param unit "mm"; "1": none
/// @throws InputError with file and line at other columns, a field that is empty or no number, times that do not
/// ascend from above 0, an uncertainty of 0 or below, no sample, or more than most_samples
std::vector<HistorySample> read_history(const std::filesystem::path& file, const std::string& unit);

}  // namespace springproof
