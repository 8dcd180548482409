// Helpers for the sentences of the verdict: reading results.json, and formatting numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "problem/case_file/experiment.h"

namespace springproof::words {

using Json = nlohmann::json;

// A member of an object, or a default value where it is missing or of another type.
std::string string_of(const Json& object, const char* key);  ///< else ""
std::optional<double> number_of(const Json& object, const char* key);
const Json& list_of(const Json& object, const char* key);    ///< else []
const Json& object_of(const Json& object, const char* key);  ///< else {}
Cells cells_of(const Json& item);                            ///< else {0, 0, 0}

/// With a minus sign instead of a hyphen.
std::string minus(std::string number);

/// As many digits as read back exactly; "nothing" if empty.
std::string number_text(std::optional<double> x);

/// Two significant digits, a fraction as percent, without its sign %: 0.0191 -> "1.9".
std::string percent(double fraction);

/// At most six significant digits: 0.499975.
std::string nu_text(std::optional<double> nu);

/// "bunny at ν = 0.45".
std::string at_nu(const std::string& name, std::optional<double> nu);

/// "10×10×10 cells" or "812 tets".
std::string cells_words(const Json& item);

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& items);

}  // namespace springproof::words
