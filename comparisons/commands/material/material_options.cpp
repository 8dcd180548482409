#include "comparisons/commands/material/material_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "msm/parameters/model_options.h"
#include "problem/case_file/keys.h"
#include "problem/moduli.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

/// --min-length of min_length.
std::string option_named(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

template <class T>
void add_model_option(CLI::App& command, ModelChoice& choice, const ModelOption& option) {
  command
      .add_option_function<T>(
          option_named(option.name), [&choice, key = option.name](const T& value) { choice.options[key] = value; },
          fmt::format("{}: {}", option.what, option.allowed))
      ->type_name(option.type == ModelOption::Type::number ? "NUMBER"
                  : option.type == ModelOption::Type::flag ? "BOOL"
                                                           : "NAME");
}

}  // namespace

void add_moduli(CLI::App& command, Moduli& moduli) {
  const auto keys = keys_of("material");
  for (const ModulusName& modulus : modulus_names) {
    const std::string name = modulus.key;
    const Key& key = *std::ranges::find_if(keys, [&](const Key& k) { return k.name == name; });
    const std::string shorter = modulus.symbol ? modulus.symbol : "";
    const std::string alias = shorter.empty() ? "" : (shorter.size() == 1 ? ",-" : ",--") + shorter;
    command.add_option(option_named(name.substr(0, name.rfind("_Pa"))) + alias, moduli.*modulus.member,
                       std::string(key.what) + (name.ends_with("_Pa") ? " [Pa]" : ""));
  }
}

IsotropicMaterial material_of(const Moduli& moduli, double density) try {
  return material_from(moduli, density);
} catch (const std::invalid_argument& e) {
  throw InputError(e.what());
}

void add_model(CLI::App& command, ModelChoice& choice) {
  command.add_option("--model", choice.name, "row of the model table (springproof list)")->capture_default_str();
  for (const ModelOption& option : model_options()) {
    if (option.of_body) continue;
    if (option.type == ModelOption::Type::flag)
      add_model_option<bool>(command, choice, option);
    else if (option.type == ModelOption::Type::number)
      add_model_option<double>(command, choice, option);
    else
      add_model_option<std::string>(command, choice, option);
  }
}

}  // namespace springproof
