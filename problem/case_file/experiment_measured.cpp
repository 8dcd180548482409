// [[load_case]], [[input]] and [[measured]].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "problem/case_file/experiment_parts.h"
#include "problem/case_file/measures.h"
#include "problem/case_file/varied.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

void read_load_cases(const TomlTable& document, Experiment& e) {
  for (const TomlValue& value : document.tables("load_case")) {
    const TomlTable table(value, keys_of("load_case"));
    const auto with = table.find("with");
    if (e.load_cases.empty() == with.has_value())
      refuse(with.value_or(value), with ? "changes the first load case" : "is the case as written once more",
             "`with` in all but the first, which is the case as written");
    e.load_cases.push_back({read_own_name(table.at("name"), e.load_cases), location_of(value), e.load_cases.size()});
  }
  if (e.load_cases.empty()) e.load_cases.push_back({"as written", {}});
}

void read_inputs(const TomlTable& document, Experiment& e) {
  using enum UncertainInput::Kind;
  for (const TomlValue& value : document.tables("input")) {
    const TomlTable table(value, keys_of("input"));
    const auto of = table.find("of"), u = table.find("u"), with = table.find("with"), fitted = table.find("fitted");
    if (of.has_value() != u.has_value() || of.has_value() == with.has_value())
      refuse(value, "is neither uncertain nor an alternative", "of and u, or with");
    if (u && as_number(*u) == 0) refuse(*u, "is 0", "the standard uncertainty of the input, above or below its value");
    for (const TomlValue& item : of ? one_or_several(*of) : std::vector<TomlValue>())
      if (!item.node->is_string())
        refuse(item, "is no key", "a key as written here, body.size_m[2], or a list of such");
    UncertainInput input{read_own_name(table.at("name"), e.inputs), with ? alternative : uncertain, location_of(value)};
    if (fitted && as_flag(*fitted)) input.kind = with ? alternative : UncertainInput::Kind::fitted;
    e.inputs.push_back(std::move(input));
  }
}

std::size_t read_load_case(const TomlValue& value, const Experiment& e) {
  std::vector<std::string> names;
  for (const LoadCase& c : e.load_cases) names.push_back(c.name);
  return as_choice_number(value, names);
}

/// A length that no part of the body can have moved by was written in another unit.
void check_size(const TomlValue& value, const Experiment& e, const MeasuredValue& m) {
  constexpr double farthest = 2;  // sizes of the body
  if (unit_of(m.quantity) == "m" && e.body.is_script() && std::abs(m.value) > farthest * e.body.size.maxCoeff())
    refuse(value, fmt::format("is {} m, more than twice the size of the body", m.value),
           fmt::format("a number in {}", unit_in(value.units, "m").name));
}

/// What a value and a history share; value and u are not read.
MeasuredValue read_quantity(const TomlTable& table, const Experiment& e) {
  MeasuredValue m{.name = read_own_name(table.at("name"), e.measured),
                  .quantity = read_row_name(table.at("quantity"), e),
                  .where = location_of(table.at("quantity"))};
  if (std::ranges::any_of(e.measured, [&](const auto& other) { return other.history == m.name; }))
    refuse(table.at("name"), fmt::format("'{}' is the name of a history", m.name), "a name of its own");
  if (is_distance(m.quantity) || is_deviation(m.quantity))
    refuse(table.at("quantity"), fmt::format("'{}' is a difference between computations", m.quantity),
           "a quantity that can be measured");
  if (m.quantity.starts_with("stress.") || m.quantity.starts_with("motion."))
    refuse(table.at("quantity"), fmt::format("'{}' is not known of the equilibria of models", m.quantity),
           "a quantity that the first model has");
  if (const auto arm = table.find("arm_m")) {
    m.arm = as_vector(*arm);
    if (!m.quantity.starts_with("mean_displacement.") || m.quantity.ends_with(".magnitude"))
      refuse(*arm, "turns with a patch", "beside the quantity mean_displacement.PATCH.x|y|z");
  }
  if (const auto of = table.find("load_case")) m.of = read_load_case(*of, e);
  return m;
}

MeasuredValue read_value(const TomlValue& value, const Experiment& e) {
  const TomlTable table(value, keys_of("measured.values"));
  MeasuredValue m = read_quantity(table, e);
  const auto number = table.find("value"), u = table.find("u");
  if (number.has_value() != u.has_value())
    throw InputError(
        location_of(value),
        fmt::format(
            "measured.values.{} (allowed: a finite number{}; neither value nor u where nothing is measured yet)",
            number ? "u: is missing" : "value: is missing", number ? " > 0" : ""));
  m.value = number ? as_number_of(m.quantity, *number) : std::numeric_limits<double>::quiet_NaN();
  m.u = u ? as_number_of(m.quantity, *u, positive_number) : std::numeric_limits<double>::quiet_NaN();
  if (number) check_size(*number, e, m);
  if (const auto minus = table.find("minus")) m.minus = read_load_case(*minus, e);
  if (m.minus == m.of) refuse(table.at("minus"), "is the same load case", "another one");
  if (const auto use = table.find("use")) m.fitted = as_choice(*use, {"fit", "predict"}) == "fit";
  if (m.fitted && !(std::abs(m.value) > 0))
    refuse(number.value_or(value), number ? "is 0, to which nothing can be fitted" : "is not measured yet",
           "another value");
  return m;
}

/// The load case after another time under its loads, which may be there already.
std::size_t load_case_after(double time, const LoadCase& of, Experiment& e) {
  const std::string name = fmt::format("{} after {} s", of.name, time);
  for (std::size_t c = 0; c < e.load_cases.size(); ++c)
    if (e.load_cases[c].name == name) return c;
  e.load_cases.push_back({name, of.where, of.table, time});
  return e.load_cases.size() - 1;
}

/// The samples of a history as values, each of a load case of its own.
void read_samples(const TomlValue& value, Experiment& e, const std::string& source, const std::string& licence) {
  const TomlTable table(value, keys_of("measured.histories"));
  if (!e.relaxation.acts() || e.dynamics)
    refuse(value, "is of a body whose equilibria do not change with time",
           "beside [material.relaxation], without [dynamics]");
  const MeasuredValue all = read_quantity(table, e);
  const LoadCase loads = e.load_cases[all.of];
  const Named unit = unit_in(e.units, unit_of(all.quantity));
  const TomlValue file = table.at("file");
  e.histories.push_back(std::filesystem::path(value.file).parent_path() / as_text(file));
  if (!std::filesystem::exists(e.histories.back()))
    refuse(file, fmt::format("there is no file {}", e.histories.back().string()),
           "a history, NAME.csv beside the case");
  const std::vector<HistorySample> samples = read_history(e.histories.back(), unit.name);
  const auto from_end = table.find("from_end");
  const bool subtracted = from_end && as_flag(*from_end);
  if (subtracted && samples.size() < 2)
    refuse(file, "has one sample, from which nothing is subtracted", "two at least");
  const HistorySample& last = samples.back();
  for (const HistorySample& s : samples) {
    MeasuredValue m = all;
    m.history = all.name;
    m.name = fmt::format("{}, {} s", all.name, s.time);
    m.time = s.time;
    m.of = load_case_after(s.time, loads, e);
    if (subtracted) m.minus = load_case_after(last.time, loads, e);
    m.value = unit.in_si * (s.value - (subtracted ? last.value : 0));
    m.u = unit.in_si * (subtracted ? std::hypot(s.u, last.u) : s.u);
    check_size(file, e, m);
    m.source = source;
    m.licence = licence;
    if (m.minus != m.of) e.measured.push_back(m);
  }
}

/// One input is fitted to one value, or none to none.
void check_fit(const TomlValue& first, const Experiment& e) {
  const auto inputs =
      std::ranges::count_if(e.inputs, [](const auto& i) { return i.kind == UncertainInput::Kind::fitted; });
  const auto values = std::ranges::count_if(e.measured, [](const auto& m) { return m.fitted; });
  if (inputs != values || inputs > 1)
    refuse(first, fmt::format("{} inputs are fitted to {} values", inputs, values),
           "one [[input]] with fitted = true beside one value with use = \"fit\", or neither");
}

void read_measured_set(const TomlValue& value, Experiment& e) {
  const TomlTable table(value, keys_of("measured"));
  if (e.models.empty() || e.settings().size() != 1)
    refuse(value, e.models.empty() ? "has no model beside it" : "is of one body, and the case has several materials",
           "models in [compare], and one Poisson's ratio");
  const std::string source = as_text(table.at("source")), licence = as_text(table.at("licence"));
  if (const auto left_out = table.find("left_out")) e.left_out.push_back(as_text(*left_out));
  const auto values = table.find("values"), histories = table.find("histories");
  if (!values && !histories) refuse(value, "has no values", "values, histories, or both");
  if (values)
    for (const TomlValue& item : as_list(*values, "a list of { name, quantity, value, u }")) {
      e.measured.push_back(read_value(item, e));
      e.measured.back().source = source;
      e.measured.back().licence = licence;
    }
  if (histories)
    for (const TomlValue& item : as_list(*histories, "a list of { name, quantity, file }"))
      read_samples(item, e, source, licence);
}

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

void read_measured(const TomlTable& document, Experiment& e) {
  read_load_cases(document, e);
  read_inputs(document, e);
  const std::vector<TomlValue> sets = document.tables("measured");
  for (const char* beside : {"load_case", "input"})
    if (const auto alone = document.find(beside); alone && sets.empty())
      refuse(*alone, "is for measured values", "beside [[measured]], or no such table");
  if (sets.empty()) return;
  for (const TomlValue& set : sets) read_measured_set(set, e);
  check_fit(sets.front(), e);
  if (!e.asks_for("measured")) e.measures.emplace_back("measured");
  const bool turns = std::ranges::any_of(e.measured, [](const auto& m) { return !m.arm.isZero(0); });
  if (turns && !e.asks_for("turn")) e.measures.emplace_back("turn");
  for (std::size_t c = 0; c < e.load_cases.size(); ++c) {
    if (c > 0) varied(e, {c, {}});
    for (std::size_t i = 0; i < e.inputs.size(); ++i) varied(e, {c, i});
  }
}

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
    const HistorySample sample{at(0), at(1), at(2)};
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
