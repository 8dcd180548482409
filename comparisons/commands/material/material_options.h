// Options of subcommands that are made of the tables of moduli and of models.
#pragma once

#include "problem/material.h"
#include "problem/model_choice.h"

namespace CLI {
class App;
}

namespace springproof {

/// --youngs-modulus, ...: an option for each modulus.
/// @param moduli takes those that are given; must outlive the command
void add_moduli(CLI::App& command, Moduli& moduli);

/// The material of two of them.
/// @throws InputError naming the modulus, if they are not two or admit no solid
IsotropicMaterial material_of(const Moduli& moduli, double density = 1000);

/// --model, and an option for each option of models on which their moduli can depend.
/// @param choice takes those that are given; must outlive the command
void add_model(CLI::App& command, ModelChoice& choice);

}  // namespace springproof
