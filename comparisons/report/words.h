// Numbers and lists in the sentences of the verdict.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof::words {

/// With a minus sign instead of a hyphen.
std::string minus(std::string number);

/// As many digits as read back exactly; "nothing" if empty or not finite.
std::string number_text(std::optional<double> x);

/// Two significant digits, a fraction as percent, without its sign %: 0.0191 -> "1.9".
std::string percent(double fraction);

/// At most six significant digits: 0.499975.
std::string nu_text(double nu);

/// "ν = 0.45", "ν of tumour = 0.3", "E of tumour = 10000 Pa".
std::string setting_text(const Experiment& experiment, double setting);

/// "bunny at ν = 0.45".
std::string at_nu(const std::string& name, double nu);

/// Of one of a case's settings: "liver at ν of tumour = 0.3".
std::string at_setting(const Experiment& experiment, const std::string& name, double setting);

/// "10×10×10 cells" or "812 tets".
std::string cells_words(const Cells& cells);

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& items);

}  // namespace springproof::words
