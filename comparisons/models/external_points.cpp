#include "comparisons/models/external.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "problem/files/files.h"
#include "problem/system/input_error.h"
#include "problem/system/nearest_name.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

struct CsvField {
  std::string_view text;  ///< without blanks and quotes around it
  int column;             ///< of its first character, from 1
};

std::string_view stripped(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<CsvField> fields_of(std::string_view line, char separator) {
  std::vector<CsvField> fields;
  for (std::size_t start = 0;;) {
    const std::size_t end = std::min(line.find(separator, start), line.size());
    fields.push_back({stripped(line.substr(start, end - start)), static_cast<int>(start) + 1});
    if (end == line.size()) return fields;
    start = end + 1;
  }
}

char separator_of(std::string_view header) {
  for (const char c : {';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ',';
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

constexpr const char* rest_columns[] = {"x", "y", "z"};
constexpr const char* displacement_columns[] = {"ux", "uy", "uz"};
constexpr const char* deformed_columns[] = {"X", "Y", "Z"};

/// Where the header has what.
struct CsvColumns {
  std::array<std::size_t, 3> rest, moved;
  bool positions = false;  ///< moved are deformed positions, not displacements
  std::optional<std::size_t> poisson_ratio;
  std::size_t count = 0;
};

class CsvReader {
 public:
  CsvReader(const std::filesystem::path& file, const ExternalFormat& format) : file_(file.string()), format_(format) {
    text_ = read_named_file(file, "a table of points, NAME.csv");
    if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  }

  ExternalPoints read() {
    std::vector<double> numbers;
    ExternalPoints points;
    std::optional<CsvColumns> columns;
    int number = 0;
    for (std::string_view left = text_; !left.empty();) {
      const std::size_t end = std::min(left.find('\n'), left.size());
      const std::string_view line = left.substr(0, end);
      left.remove_prefix(std::min(end + 1, left.size()));
      ++number;
      if (stripped(line).empty() || stripped(line).front() == '#') continue;
      if (!columns) {
        separator_ = separator_of(line);
        columns = columns_of(fields_of(line, separator_), number);
        continue;
      }
      const std::array<double, 6> values = values_of(fields_of(line, separator_), *columns, number);
      numbers.insert(numbers.end(), values.begin(), values.end());
      points.lines.push_back(number);
    }
    if (points.lines.empty())
      throw InputError({file_, number, number > 0 ? 1 : 0},
                       fmt::format("there is no point (needed: {}, and a line for each point)",
                                   columns ? "lines below the header" : header_words));
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> all(
        numbers.data(), static_cast<Eigen::Index>(points.lines.size()), 6);
    points.X = all.leftCols(3);
    points.u = all.rightCols(3);
    return points;
  }

 private:
  static constexpr const char* header_words =
      "a header with x, y, z (rest positions) and ux, uy, uz (displacements) or X, Y, Z (deformed positions)";

  [[noreturn]] void fail(int line, int column, const std::string& message) const {
    throw InputError({file_, line, column}, message);
  }

  /// The column of each name.
  std::map<std::string, std::size_t> names_of(const std::vector<CsvField>& header, int line) const {
    static const std::map<std::string, std::string> of_paraview = {
        {"Points:0", "x"},        {"Points:1", "y"},        {"Points:2", "z"},        {"Points_0", "x"},
        {"Points_1", "y"},        {"Points_2", "z"},        {"displacement:0", "ux"}, {"displacement:1", "uy"},
        {"displacement:2", "uz"}, {"displacement_0", "ux"}, {"displacement_1", "uy"}, {"displacement_2", "uz"}};
    std::map<std::string, std::size_t> names;
    for (std::size_t i = 0; i < header.size(); ++i) {
      std::string name(header[i].text);
      if (const auto known = of_paraview.find(name); known != of_paraview.end()) name = known->second;
      if (!names.emplace(name, i).second && !name.empty())
        fail(line, header[i].column, shortened(fmt::format("column '{}' is named twice (allowed: once)", name)));
    }
    return names;
  }

  CsvColumns columns_of(const std::vector<CsvField>& header, int line) const {
    if (std::ranges::all_of(header, [](const CsvField& f) { return number_in(f.text).has_value(); }))
      fail(line, 1, fmt::format("the file has no header: its first line holds numbers (needed: {})", header_words));
    const std::map<std::string, std::size_t> names = names_of(header, line);
    CsvColumns columns;
    columns.count = header.size();
    std::vector<std::string> there;
    for (const auto& [name, at] : names) there.push_back(name);
    const auto find = [&](const char* const(&wanted)[3]) {
      std::array<std::size_t, 3> at{};
      for (int d = 0; d < 3; ++d) {
        const auto found = names.find(wanted[d]);
        if (found == names.end())
          fail(line, 1,
               shortened(fmt::format("there is no column '{}' (allowed: {}; there are {}){}", wanted[d], header_words,
                                     fmt::join(there, ", "), did_you_mean(wanted[d], there))));
        at[d] = found->second;
      }
      return at;
    };
    columns.rest = find(rest_columns);
    const auto any = [&](const char* const(&wanted)[3]) {
      return std::any_of(std::begin(wanted), std::end(wanted), [&](const char* name) { return names.contains(name); });
    };
    columns.positions = any(deformed_columns);
    if (columns.positions && any(displacement_columns))
      fail(line, 1, "there are columns ux, uy, uz and X, Y, Z (allowed: one of both)");
    columns.moved = columns.positions ? find(deformed_columns) : find(displacement_columns);
    if (const auto nu = names.find("poisson_ratio"); nu != names.end()) columns.poisson_ratio = nu->second;
    return columns;
  }

  double number_at(const std::vector<CsvField>& fields, std::size_t i, int line) const {
    const std::optional<double> value = number_in(fields[i].text);
    if (!value || !std::isfinite(*value))
      fail(line, fields[i].column,
           shortened(fmt::format("is '{}' (allowed: a finite number, with a point for decimals)", fields[i].text)));
    return *value;
  }

  /// Rest position and displacement [m].
  std::array<double, 6> values_of(const std::vector<CsvField>& fields, const CsvColumns& columns, int line) const {
    if (fields.size() != columns.count)
      fail(line, 1, fmt::format("has {} fields (allowed: {}, as the header)", fields.size(), columns.count));
    std::array<double, 6> v{};
    for (int d = 0; d < 3; ++d) {
      v[d] = format_.scale * number_at(fields, columns.rest[d], line);
      v[3 + d] = format_.scale * number_at(fields, columns.moved[d], line) - (columns.positions ? v[d] : 0);
    }
    if (columns.poisson_ratio)
      if (const double nu = number_at(fields, *columns.poisson_ratio, line);
          std::abs(nu - format_.poisson_ratio) > 1e-9)
        fail(line, fields[*columns.poisson_ratio].column,
             fmt::format("poisson_ratio is {}, and [[external]] is of a solid of {} (allowed: one file for each "
                         "Poisson's ratio)",
                         nu, format_.poisson_ratio));
    if (format_.y_up) v = {v[0], -v[2], v[1], v[3], -v[5], v[4]};
    return v;
  }

  std::string file_, text_;
  ExternalFormat format_;
  char separator_ = ',';
};

}  // namespace

ExternalPoints read_external_points(const std::filesystem::path& file, const ExternalFormat& format) {
  return CsvReader(file, format).read();
}

std::string csv_of(const NodalVectors& X, const NodalVectors& u) {
  std::string out = "x,y,z,ux,uy,uz\n";
  for (Eigen::Index n = 0; n < X.rows(); ++n)
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{}\n", X(n, 0), X(n, 1), X(n, 2), u(n, 0), u(n, 1),
                   u(n, 2));
  return out;
}

}  // namespace springproof
