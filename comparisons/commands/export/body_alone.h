// A body without a case: what the command line says of it.
#pragma once

#include <string>
#include <vector>

#include "comparisons/commands/export/export_request.h"
#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// A model without options, labelled by its name.
ModelChoice named_model(const std::string& name);

/// A case of the body, with the material, the model and the patches of the command line, and without loads.
/// @throws InputError for a script without its size, moduli that give no solid, a rule that is none.
Experiment body_alone(const ExportRequest& request);

/// The names of the patches of --hold: sides as they are called, other rules "held", "held_2", ...
std::vector<std::string> held_patches(const ExportRequest& request);

/// @throws InputError for a patch of the command line that is the whole surface.
void refuse_whole_surface(const PreparedCase& prepared);

}  // namespace springproof
