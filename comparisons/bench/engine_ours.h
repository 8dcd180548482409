// Our models as engines of the bench: forces, equilibria and motion of the bar.
#pragma once

#include <optional>

#include "comparisons/bench/engine_adapter.h"
#include "msm/laws/laws.h"

namespace springproof::bench {

/// A model of the table on the bar.
MassSpringModel model_of_bar(const std::string& name, const EngineBar& bar, double poisson_ratio);

/// Displacement of the nodes in equilibrium [m], of the model linearised at rest.
NodalVectors equilibrium_of_bar(const MassSpringModel& model, const EngineBar& bar, BarLoad load);

/// Sinking of the end face under gravity [m], at finite displacement.
double finite_tip(const MassSpringModel& model, const EngineBar& bar);

/// The task by our forces: semi-implicit Euler with the largest number of equal steps per time_step that is needed for
/// 0.9 of the safe one.
EngineAnswer run_ours(const MassSpringModel& model, const EngineBar& bar, const EngineTask& task);

}  // namespace springproof::bench
