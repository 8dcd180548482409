#include "comparisons/advise/measurement.h"

#include <fmt/format.h>

#include <sstream>

#include "problem/files/named_files.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

constexpr const char* heading = "case,nu,model,cells,error,uncertainty";

Measurement measurement_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  if (fields.size() != 6) throw std::invalid_argument(fmt::format("has {} fields", fields.size()));
  const auto number = [&](std::size_t i) {
    std::size_t read = 0;
    const double x = std::stod(fields[i], &read);
    if (read != fields[i].size()) throw std::invalid_argument(fields[i] + " is no number");
    return x;
  };
  return {fields[0], number(1), fields[2], number(3), number(4), number(5)};
}

}  // namespace

MeasuredFile parse_measurements(const std::string& text, const std::filesystem::path& file) {
  MeasuredFile out;
  std::istringstream in(text);
  int number = 0;
  bool has_heading = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with('#')) {
      out.header += line.substr(1) + "\n";
    } else if (!has_heading) {
      if (line != heading)
        throw InputError({file.string(), number, 1}, fmt::format("the heading is '{}' (allowed: '{}')", line, heading));
      has_heading = true;
    } else if (!line.empty()) {
      try {
        out.rows.push_back(measurement_of(line));
      } catch (const std::exception& e) {
        throw InputError({file.string(), number, 1},
                         fmt::format("'{}': {} (allowed: text or numbers under '{}')", line, e.what(), heading));
      }
    }
  }
  if (!has_heading)
    throw InputError(fmt::format(
        "{}: holds no measurements (allowed: a file written by springproof advise --measure-held-out)", file.string()));
  return out;
}

MeasuredFile read_measurements(const std::filesystem::path& file) {
  return parse_measurements(read_named_file(file, "a table that springproof advise --measure wrote"), file);
}

void write_measurements(const std::filesystem::path& file, const MeasuredFile& measured) {
  std::string text;
  std::istringstream header(measured.header);
  for (std::string line; std::getline(header, line);) text += "#" + line + "\n";
  text += fmt::format("{}\n", heading);
  for (const Measurement& m : measured.rows)
    text += fmt::format("{},{:g},{},{:.0f},{:.4e},{:.2e}\n", m.case_name, m.poisson_ratio, m.model, m.cells, m.error,
                        m.uncertainty);
  write_named_file(file, text);
}

std::filesystem::path advise_folder() { return data_folder("advise", SPRINGPROOF_ADVISE_DIR); }

}  // namespace springproof
