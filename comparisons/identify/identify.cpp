#include "comparisons/identify/identified.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "comparisons/identify/least_squares.h"
#include "comparisons/identify/model_values.h"
#include "comparisons/judge/validation.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Maybe = std::optional<double>;
using Numbers = std::vector<double>;
using ValueNumbers = std::vector<std::size_t>;

constexpr int most_corrections = 4;
constexpr double smallest_correction = 0.05;  // of a value, in its standard uncertainties
constexpr double log_step = 0.03, step_of_range = 0.02;
constexpr double limits_of_95_percent = 1.96;  // standard uncertainties

double sought_of(const SoughtParameter& p, double number) { return p.logarithmic ? std::log(number) : number; }

VectorXd sought_of(const Identification& s, double SoughtParameter::*member) {
  VectorXd out(static_cast<Index>(s.parameters.size()));
  for (Index i = 0; i < out.size(); ++i) {
    const SoughtParameter& p = s.parameters[static_cast<std::size_t>(i)];
    out[i] = sought_of(p, p.*member);
  }
  return out;
}

Numbers numbers_of(const Identification& s, const VectorXd& sought) {
  Numbers out;
  for (const SoughtParameter& p : s.parameters) {
    const double x = sought[static_cast<Index>(out.size())];
    out.push_back(p.logarithmic ? std::exp(x) : x);
  }
  return out;
}

/// One identification, while it is made.
class Fitting {
 public:
  Fitting(const Experiment& e, const Identification& s, const std::filesystem::path& folder)
      : e_(e), s_(s), model_(e, s, folder), correction_(e.measured.size(), 1) {
    for (const std::size_t m : s.fitted) {
      data_.push_back(e.measured[m].value);
      u_.push_back(e.measured[m].u);
    }
    problem_ = {[this](const VectorXd& at) { return residuals(at, data_); },
                sought_of(s, &SoughtParameter::start),
                sought_of(s, &SoughtParameter::lower),
                sought_of(s, &SoughtParameter::upper),
                {}};
    const VectorXd range = problem_.upper - problem_.lower;
    problem_.step = step_of_range * range;
    for (Index i = 0; i < range.size(); ++i)
      if (s.parameters[static_cast<std::size_t>(i)].logarithmic) problem_.step[i] = std::min(log_step, range[i] / 4);
  }

  Identified result(int synthetic) {
    Identified out;
    out.case_name = e_.name;
    out.name = s_.name;
    out.model = s_.model;
    correct();
    out.iterations = found_.fit.iterations;
    out.ok = found_.fit.converged && found_.jacobian.size() > 0;
    out.message = found_.fit.message + (out.ok || model_.message().empty() ? "" : ": " + model_.message());
    if (out.ok) {
      limits(all_values());
      read_influences();
      set_parameters(out);
      set_values(out);
      out.chi2 = found_.fit.residuals.squaredNorm();
      out.freedom = static_cast<int>(s_.fitted.size()) - static_cast<int>(free_.size());
      Index worst = 0;
      found_.fit.residuals.cwiseAbs().maxCoeff(&worst);
      out.worst = e_.measured[s_.fitted[static_cast<std::size_t>(worst)]].name;
      if (synthetic > 0) out.synthetic = synthetic_sets(synthetic);
      out.sentences = sentences_of(out);
    }
    out.cells = model_.cells();
    out.runs = model_.runs();
    out.kept = model_.kept();
    return out;
  }

 private:
  std::optional<VectorXd> residuals(const VectorXd& at, const Numbers& data) {
    const std::vector<Maybe> values = model_.at(numbers_of(s_, at), 0, s_.fitted);
    VectorXd r(static_cast<Index>(s_.fitted.size()));
    for (std::size_t i = 0; i < s_.fitted.size(); ++i) {
      const std::size_t m = s_.fitted[i];
      if (!values[m] || !std::isfinite(*values[m])) return {};
      r[static_cast<Index>(i)] = (correction_[m] * *values[m] - data[i]) / u_[i];
    }
    return r;
  }

  /// Fits until what the lattices add no longer matters.
  void correct() {
    for (int round = 0; round < most_corrections; ++round) {
      found_ = fit_what_is_told(problem_);
      if (!found_.fit.converged) return;
      const std::vector<double> before = correction_;
      limits(s_.fitted);
      double largest = 0;
      for (std::size_t i = 0; i < s_.fitted.size(); ++i) {
        const std::size_t m = s_.fitted[i];
        largest = std::max(largest, std::abs((correction_[m] / before[m] - 1) * data_[i] / u_[i]));
      }
      if (largest < smallest_correction) return;
      for (std::size_t p = 0; p < found_.held.size(); ++p)
        if (!found_.held[p]) problem_.start[static_cast<Index>(p)] = found_.fit.parameters[static_cast<Index>(p)];
    }
    found_.fit.converged = false;
    found_.fit.message = "the correction for the lattices has not come to rest";
  }

  /// Sets the values on the lattices at the fit, and the uncertainties of their limits.
  void limits(const ValueNumbers& wanted) {
    const Numbers at = numbers_of(s_, found_.fit.parameters);
    on_lattices_.assign(e_.measured.size(), {});
    u_numerical_.assign(e_.measured.size(), {});
    for (std::size_t lattice = 0; lattice < model_.lattices(); ++lattice) {
      const std::vector<Maybe> values = model_.at(at, lattice, wanted);
      for (const std::size_t m : wanted)
        if (values[m] && model_.cells().size() > lattice) {
          on_lattices_[m].cells.push_back(model_.cells()[lattice]);
          on_lattices_[m].values.push_back(*values[m]);
        }
    }
    for (const std::size_t m : wanted) {
      const LatticeValues& values = on_lattices_[m];
      const std::optional<ReferenceValue> limit = limit_of(values);
      correction_[m] = limit && values.values.front() != 0 ? limit->value / values.values.front() : 1;
      if (limit) u_numerical_[m] = limit->uncertainty / 2;  // about two standard ones
    }
  }

  void set_parameters(Identified& out) {
    const MatrixXd& J = found_.jacobian;
    const Certainty all = certainty_of(J);
    for (std::size_t p = 0; p < found_.held.size(); ++p)
      if (!found_.held[p]) free_.push_back(static_cast<Index>(p));
    const MatrixXd of_free = J(Eigen::all, free_);
    const Certainty told = certainty_of(of_free);
    answer_ = -told.covariance * of_free.transpose();
    for (Index d = 0; d < all.along.size(); ++d)
      out.directions.push_back({{all.directions.col(d).begin(), all.directions.col(d).end()}, all.along[d]});
    MatrixXd correlation = all.correlation;
    correlation(free_, free_) = told.correlation;
    for (Index i = 0; i < all.u.size(); ++i)
      out.correlation.emplace_back(correlation.row(i).begin(), correlation.row(i).end());
    VectorXd u = all.u;
    u(free_) = told.u;
    for (Index p = 0; p < u.size(); ++p) out.parameters.push_back(parameter(static_cast<std::size_t>(p), u[p]));
  }

  void set_values(Identified& out) {
    for (std::size_t m = 0; m < e_.measured.size(); ++m) {
      const MeasuredValue& D = e_.measured[m];
      IdentifiedValue v{.name = D.name,
                        .load_case = e_.load_cases[D.of].name + (D.minus ? " − " + e_.load_cases[*D.minus].name : ""),
                        .unit = unit_of(D.quantity),
                        .fitted = std::ranges::find(s_.fitted, m) != s_.fitted.end(),
                        .measured = D.value,
                        .u_measured = D.u,
                        .u_numerical = u_numerical_[m]};
      if (!on_lattices_[m].values.empty()) {
        v.simulated = correction_[m] * on_lattices_[m].values.front();
        if (std::isfinite(D.value)) v.residual = (*v.simulated - D.value) / D.u;
        if (!v.fitted) set_prediction(m, v);
      }
      out.values.push_back(v);
    }
  }

  /// What moves a free parameter by so much in each fitted value; empty: one is not known.
  Maybe moved(Index free, const std::vector<Maybe>& change) const {
    double sum = 0;
    for (std::size_t f = 0; f < s_.fitted.size(); ++f) {
      const Maybe here = change[s_.fitted[f]];
      if (!here) return {};
      sum += answer_(free, static_cast<Index>(f)) * *here / u_[f];
    }
    return sum;
  }

  /// What is not known of the limits moves a free parameter by: all lattices are too stiff, or too soft, together.
  Maybe moved_by_limits(Index free) const {
    std::vector<Maybe> in_limits = u_numerical_;
    for (std::size_t m = 0; m < in_limits.size(); ++m)
      if (in_limits[m] && on_lattices_[m].values.back() < on_lattices_[m].values.front()) in_limits[m] = -*in_limits[m];
    return moved(free, in_limits);
  }

  /// Sets the uncertainties by inputs and lattices, as it is sought, of a parameter that is not held.
  void set_uncertainties(Index free, double scale, IdentifiedParameter& p) const {
    double squares = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const Maybe change = moved(free, by_input_[i]);
      squares += std::pow(change.value_or(0), 2);
      p.inputs.push_back({e_.inputs[inputs_[i]].name, change ? Maybe(scale * *change) : Maybe(), false});
    }
    p.u_inputs = scale * std::sqrt(squares);
    if (const Maybe change = moved_by_limits(free)) p.u_numerical = scale * std::abs(*change);
  }

  IdentifiedParameter parameter(std::size_t number, double u) const {
    const SoughtParameter& sought = s_.parameters[number];
    const double value = numbers_of(s_, found_.fit.parameters)[number], scale = sought.logarithmic ? value : 1;
    IdentifiedParameter p{sought.name,  sought.of,          sought.start,        sought.lower,
                          sought.upper, sought.logarithmic, found_.held[number], value};
    const auto place = std::ranges::find(free_, static_cast<Index>(number));
    if (place != free_.end()) set_uncertainties(place - free_.begin(), scale, p);
    p.u_data = scale * u;
    p.u = std::hypot(p.u_data, p.u_inputs.value_or(0), p.u_numerical.value_or(0));
    const auto limit = [&](double sign) {
      const double x = sought_of(sought, value) + sign * limits_of_95_percent * p.u / scale;
      return std::clamp(sought.logarithmic ? std::exp(x) : x, sought.lower, sought.upper);
    };
    p.from = limit(-1);
    p.to = limit(1);
    return p;
  }

  /// What is left of a change of a value by an input, when the fit has answered to what it does to the fitted values.
  Maybe change_by_input(std::size_t m, std::size_t input) const {
    Maybe change = by_input_[input][m];
    for (std::size_t k = 0; k < free_.size() && change; ++k) {
      const Maybe slope = by_parameter_[static_cast<std::size_t>(free_[k])][m],
                  by = moved(static_cast<Index>(k), by_input_[input]);
      change = slope && by ? Maybe(*change + *slope * *by) : Maybe();
    }
    return change;
  }

  /// Sets what is known of a value that is not fitted.
  void set_prediction(std::size_t m, IdentifiedValue& v) const {
    VectorXd slope(static_cast<Index>(free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const Maybe of = by_parameter_[static_cast<std::size_t>(free_[k])][m];
      if (!of) return;
      slope[static_cast<Index>(k)] = *of;
    }
    v.u_fit = (answer_.transpose() * slope).norm();
    double squares = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const Maybe change = change_by_input(m, i);
      if (!change) return;
      squares += std::pow(*change, 2);
    }
    v.u_input = std::sqrt(squares);
    double by_limits = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const Maybe change = moved_by_limits(static_cast<Index>(k));
      if (!change) return;
      by_limits += slope[static_cast<Index>(k)] * *change;
    }
    v.u_fit_numerical = std::abs(by_limits);
    if (!v.u_numerical) return;
    v.u_val = std::hypot(std::hypot(*v.u_input, *v.u_numerical), std::hypot(*v.u_fit, *v.u_fit_numerical),
                         v.residual ? v.u_measured : 0);
    if (!v.residual) return;  // not measured yet
    v.ratio = std::abs(*v.simulated - v.measured) / *v.u_val;
  }

  /// Sets what the parameters and the inputs do to each value, on the coarsest lattice and corrected.
  void read_influences() {
    const ValueNumbers all = all_values();
    const VectorXd& at = found_.fit.parameters;
    const std::vector<Maybe> here = model_.at(numbers_of(s_, at), 0, all);
    const auto change = [&](const std::vector<Maybe>& there, double over) {
      std::vector<Maybe> out(all.size());
      for (const std::size_t m : all)
        if (here[m] && there[m]) out[m] = correction_[m] * (*there[m] - *here[m]) / over;
      return out;
    };
    for (Index p = 0; p < at.size(); ++p) {
      const VectorXd moved = beside(problem_, at, p);
      by_parameter_.push_back(change(model_.at(numbers_of(s_, moved), 0, all), moved[p] - at[p]));
    }
    for (const OtherInput& input : s_.inputs) {
      const bool found = std::ranges::any_of(input.sought, [&](std::size_t p) { return !found_.held[p]; });
      if (found) continue;
      inputs_.push_back(input.number);
      by_input_.push_back(change(model_.at(numbers_of(s_, at), 0, all, input.number), 1));
    }
  }

  SyntheticSets synthetic_sets(int sets) {
    SyntheticSets out{sets, std::vector<int>(free_.size(), 0)};
    const VectorXd truth = found_.fit.parameters;
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int s = 0; s < sets; ++s) {
      Numbers data = data_;
      for (std::size_t f = 0; f < data.size(); ++f)
        data[f] += u_[f] * (found_.fit.residuals[static_cast<Index>(f)] + normal(random));
      BoundedFit problem = problem_;
      problem.residuals = [this, &data](const VectorXd& at) { return residuals(at, data); };
      for (std::size_t p = 0; p < found_.held.size(); ++p)
        if (found_.held[p]) problem.start[static_cast<Index>(p)] = truth[static_cast<Index>(p)];
      const HeldFit again = fit_what_is_told(problem);
      if (!again.fit.converged || again.held != found_.held) continue;
      const VectorXd u = certainty_of(again.jacobian(Eigen::all, free_)).u;
      for (std::size_t k = 0; k < free_.size(); ++k)
        out.inside[k] += std::abs(again.fit.parameters[free_[k]] - truth[free_[k]]) <
                         limits_of_95_percent * u[static_cast<Index>(k)];
    }
    return out;
  }

  ValueNumbers all_values() const {
    ValueNumbers all(e_.measured.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  const Experiment& e_;
  const Identification& s_;
  ModelValues model_;
  std::vector<double> correction_;  ///< limit over value on the coarsest lattice, of each measured value
  Numbers data_, u_;                ///< of the fitted values
  BoundedFit problem_;
  HeldFit found_;
  std::vector<LatticeValues> on_lattices_;        ///< of each measured value, at the fit
  std::vector<Maybe> u_numerical_;                ///< of each
  std::vector<std::size_t> inputs_;               ///< uncertain, and of no parameter that is found
  std::vector<std::vector<Maybe>> by_input_;      ///< of each of these, the change of each value
  std::vector<std::vector<Maybe>> by_parameter_;  ///< derivative of each value by each parameter, as it is sought
  MatrixXd answer_;                               ///< change of the free parameters per residual
  std::vector<Index> free_;
};

}  // namespace

Identified identify(const Experiment& e, const Identification& sought, const std::filesystem::path& folder,
                    int synthetic) {
  return Fitting(e, sought, folder).result(synthetic);
}

}  // namespace springproof
