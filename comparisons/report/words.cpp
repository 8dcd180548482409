#include "comparisons/report/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "comparisons/results/records.h"

namespace springproof::words {

std::string minus(std::string number) {
  for (std::size_t i = 0; (i = number.find('-', i)) != std::string::npos; ++i) number.replace(i, 1, "−");
  return number;
}

std::string number_text(std::optional<double> x) {
  return x && std::isfinite(*x) ? minus(fmt::format("{}", *x)) : "nothing";
}

std::string percent(double fraction) {
  const double x = 100 * fraction;
  if (x < 1e-3) return "0.001";
  return x >= 99.5 ? fmt::format("{:.0f}", x) : fmt::format("{:.2g}", x);
}

std::string nu_text(double nu) { return minus(fmt::format("{:.6g}", nu)); }

std::string at_nu(const std::string& name, double nu) { return fmt::format("{} at ν = {}", name, nu_text(nu)); }

std::string setting_text(const Experiment& experiment, double setting) {
  return fmt::format("{} = {}{}", experiment.listed_symbol(), nu_text(setting),
                     experiment.listed.stiffness ? " Pa" : "");
}

std::string at_setting(const Experiment& experiment, const std::string& name, double setting) {
  return fmt::format("{} at {}", name, setting_text(experiment, setting));
}

std::string cells_words(const Cells& cells) { return cells_text(cells, "×") + (is_tetrahedra(cells) ? "" : " cells"); }

std::string listed(const std::vector<std::string>& items) {
  if (items.size() < 2) return items.empty() ? "" : items.front();
  return fmt::format("{} and {}", fmt::join(items.begin(), items.end() - 1, ", "), items.back());
}

}  // namespace springproof::words
