// Models and resolutions that reach an error within a budget.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/advise/pilot.h"
#include "comparisons/advise/speed.h"
#include "comparisons/advise/table_prediction.h"

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

/// Where predictions come from: measurements or a pilot, at all of the wanted Poisson's ratios (the worst counts).
struct Forecast {
  std::string basis;                            ///< in words
  std::string geometry;                         ///< in words
  double solved_cells = 0, solved_seconds = 0;  ///< of a solve of this body by hybmss_avg, CPU time; 0: none
  IsotropicMaterial material;                   ///< the one nearest to nu = 1/2, whose solves take longest
  bool small_strain = true;
  std::string load;                     ///< "bending", ...; empty: not known
  std::optional<LoadShares> shares;     ///< of a case
  std::vector<Resolution> resolutions;  ///< ascending
  std::vector<std::string> models;      ///< labels
  std::function<std::optional<Prediction>(const std::string& model, const Resolution&)> predict;
  std::function<std::optional<Prediction>(const std::string& element, const Resolution&)> predict_element;
  std::vector<std::string> notes;
};

/// A model on a lattice, with what is predicted of it.
struct Choice {
  std::string model;
  Resolution resolution;
  Prediction prediction;
  std::optional<double> ms_per_step;  ///< empty: not known, or elements, which make no explicit steps
  double safe_step = 0;               ///< [s]
  double seconds = 0, MiB = 0;        ///< of a static solve
  bool accurate = false, affordable = false;
};

struct Advice {
  Forecast forecast;
  Wish wish;
  std::string machine;
  std::vector<Choice> choices;   ///< one per model, the best first: accurate and affordable ones by their cost
  std::vector<Choice> elements;  ///< finite elements that reach the error, coarsest each
  std::vector<std::string> words;
};

/// From the measurements: a block or a round bar without a case.
Forecast forecast_from(const std::vector<Measurement>& measured, const Loading& loading, double thickness,
                       const std::vector<IsotropicMaterial>& materials, const std::vector<std::string>& models);

/// From pilots of a case, one per material.
Forecast forecast_from(const std::vector<Measurement>& measured, const std::vector<Pilot>& pilots);

/// Calibrates this machine for what may be advised (seconds).
Advice advise(const Forecast& forecast, const Wish& wish);

std::string text_of(const Advice& advice);
nlohmann::json json_of(const Advice& advice);

}  // namespace springproof
