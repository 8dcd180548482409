// Moduli by name, for case files and the command line.
#pragma once

#include <optional>

#include "problem/material.h"

namespace springproof {

/// A modulus as case files and the command line name it.
struct ModulusName {
  const char* key;     ///< with its unit: "youngs_modulus_Pa"
  const char* symbol;  ///< "E"; null: none in ASCII
  std::optional<double> Moduli::*member;
};

inline constexpr ModulusName modulus_names[] = {{"youngs_modulus_Pa", "E", &Moduli::youngs_modulus},
                                                {"poisson_ratio", "nu", &Moduli::poisson_ratio},
                                                {"shear_modulus_Pa", "G", &Moduli::shear_modulus},
                                                {"bulk_modulus_Pa", "K", &Moduli::bulk_modulus},
                                                {"lame_lambda_Pa", nullptr, &Moduli::lame_lambda}};

}  // namespace springproof
