#include "problem/case_file/history_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "problem/files/named_files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

constexpr std::uintmax_t largest_history = 1 << 20;  // [bytes]

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else if (c != ' ' && c != '\r')
      fields.back() += c;
  return fields;
}

[[noreturn]] void refuse_line(const std::filesystem::path& file, int line, const std::string& what,
                              const std::string& allowed) {
  throw InputError({file.string(), line, 1}, fmt::format("{} (allowed: {})", what, allowed));
}

double number_of_field(const std::string& field, const std::filesystem::path& file, int line) {
  char* end = nullptr;
  const double x = std::strtod(field.c_str(), &end);
  if (field.empty()) refuse_line(file, line, "a field is empty", "a number in each: leave out lines with gaps");
  if (*end != '\0' || !std::isfinite(x))
    refuse_line(file, line, fmt::format("'{}' is no number", field), "finite numbers");
  return x;
}

}  // namespace

std::vector<HistorySample> read_history(const std::filesystem::path& file, const std::string& unit) {
  const std::string suffix = unit == "1" ? "" : "_" + unit, columns = fmt::format("time_s,value{0},u{0}", suffix);
  std::istringstream text(read_named_file(file, "a history, NAME.csv", largest_history));
  std::vector<HistorySample> samples;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::vector<std::string> fields = fields_of(line);
    if (number == 1) {
      if (fields != fields_of(columns))
        refuse_line(file, 1, fmt::format("the columns are {}", line.substr(0, 60)), columns);
      continue;
    }
    if (fields.size() == 1 && fields.front().empty()) continue;
    if (fields.size() != 3) refuse_line(file, number, fmt::format("has {} fields", fields.size()), columns);
    const auto at = [&](std::size_t i) { return number_of_field(fields[i], file, number); };
    const HistorySample sample{at(0), at(1), at(2), number};
    const double before = samples.empty() ? 0 : samples.back().time;
    if (!(sample.time > before))
      refuse_line(file, number, fmt::format("{} s is not after {} s", fields[0], before),
                  "times that ascend from above 0");
    if (!(sample.u > 0)) refuse_line(file, number, fmt::format("u is {}", fields[2]), "a standard uncertainty > 0");
    samples.push_back(sample);
  }
  if (samples.empty() || samples.size() > most_samples)
    refuse_line(file, 1, fmt::format("has {} samples", samples.size()),
                fmt::format("1 to {}: each is an equilibrium of its own", most_samples));
  return samples;
}

}  // namespace springproof
