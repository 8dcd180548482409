// Formats the findings as a text table.
#pragma once

#include <string>

#include "comparisons/bench/machine.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

std::string table_text(const Machine& machine, const Findings& findings);

}  // namespace springproof::bench
