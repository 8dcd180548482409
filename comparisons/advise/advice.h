// Models and resolutions that reach an error within a budget.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/advise/pilot.h"
#include "comparisons/advise/speed.h"

namespace springproof {

/// What is wanted; an empty budget is no limit.
struct Wish {
  double error = 0.03;  ///< of the displacement
  std::optional<double> ms_per_step, seconds, MiB, cells_across;
  std::vector<std::string> models;
};

/// A lattice that may be advised.
struct Resolution {
  double cells = 0;
  double across = 0;  ///< cells across the thinnest part; of a body of voxels 0
  double edge = 0;    ///< [m]
};

/// What is predicted of a case, at all of the wanted Poisson's ratios (the worst counts).
struct Forecast {
  std::string basis;                            ///< in words
  std::string geometry;                         ///< in words
  double solved_cells = 0, solved_seconds = 0;  ///< of a solve of this body by hybmss_avg, CPU time; 0: none
  std::vector<IsotropicMaterial> materials;
  IsotropicMaterial material;  ///< the one nearest to nu = 1/2, whose solves take longest
  LoadShares shares;
  std::vector<Resolution> resolutions;        ///< ascending
  std::vector<std::string> models;            ///< labels
  std::map<std::string, double> making;       ///< CPU time per cell [s] of cells measured or refined, by label
  std::map<std::string, StepCost> cut_steps;  ///< of the models in cut cells, by label; others: of the machine's blocks
  /// Of a model, or "fem_q1", "fem_q2".
  std::function<std::optional<Prediction>(const std::string& model, const Resolution&)> predict;
  std::vector<std::string> notes;
};

/// Whether costs are within the budget; unknown: one that is limited could not be measured.
enum class Budget { within, unknown, over };

/// A model on a lattice, with what is predicted of it.
struct Choice {
  std::string model;
  Resolution resolution;
  Prediction prediction;               ///< the largest error of this lattice and all finer ones
  std::optional<double> ms_per_step;   ///< empty: not known, or elements, which make no explicit steps
  double safe_step = 0;                ///< [s]
  std::optional<double> seconds, MiB;  ///< of a static solve; empty: not known
  std::string unmeasured;              ///< why a cost is not known
  std::optional<double> own_ratio;     ///< nu of the only solid that the model is, where another one is wanted
  bool accurate = false;
  Budget budget = Budget::within;

  bool suits() const { return accurate && budget == Budget::within && !own_ratio; }
};

struct Advice {
  Forecast forecast;
  Wish wish;
  std::string machine;
  std::vector<Choice> choices;   ///< one per model, the best first: accurate and affordable ones by their cost
  std::optional<Choice> safer;   ///< the first model on a finer lattice, whose whole range is below the error
  std::vector<Choice> elements;  ///< finite elements that reach the error, coarsest each
  std::vector<std::string> words;
};

/// From pilots of a case, one per material.
Forecast forecast_from(const std::vector<Pilot>& pilots);

/// Calibrates this machine for what may be advised (seconds).
Advice advise(const Forecast& forecast, const Wish& wish);

/// What to take, or why none.
std::vector<std::string> words_of(const Advice& advice);

std::string text_of(const Advice& advice);
nlohmann::json json_of(const Advice& advice);

}  // namespace springproof
