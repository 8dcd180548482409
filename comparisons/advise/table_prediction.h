// Errors predicted from measured.csv alone, without a case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/advise/measurement.h"
#include "comparisons/advise/pilot.h"

namespace springproof {

/// A body and what is done to it, as far as the measurements know it.
struct Loading {
  std::string load = "bending";
  std::string body = "block";
  double slenderness = 1, strain = 0;
};

/// The measurements of one model in one kind of load.
class ErrorTable {
 public:
  ErrorTable(const std::vector<Measurement>& all, const Loading& loading, const std::string& model);

  /// Nothing where the model was not measured so.  log e is linear between measured log n, and beyond the finest falls
  /// as the last three; e is linear in ln(1 - 2 nu).  A power of the slenderness comes from two of them; where one was
  /// measured, errors that arise at held ends (axial, torsion) fall with the length, those at the free sides of a
  /// sheared layer with its width, and those of bending do neither.  The factor is that which nine of ten measurements
  /// are off when they are predicted from the others.
  std::optional<Prediction> at(double poisson_ratio, double cells_across) const;

 private:
  /// One curve e(n), at a slenderness and a Poisson's ratio.
  struct Curve {
    double slenderness, poisson_ratio;
    std::vector<std::pair<double, double>> points;  ///< n, e, ascending
  };
  static Prediction on(const Curve& curve, double n, int without = -1);
  Prediction in(double slenderness, double nu, double n, const Curve* without = nullptr) const;
  double residual_factor() const;
  double exponent(double shorter, double longer, double nu, double n) const;

  std::vector<Curve> curves_;
  double slenderness_ = 1, factor_ = 1;
  double by_length_ = 0;  ///< power of the slenderness where one was measured
};

/// The same for any strain: what strain adds was measured in one slenderness, and is taken as proportional to it.
std::optional<Prediction> predict(const std::vector<Measurement>& all, const Loading& loading, const std::string& model,
                                  double poisson_ratio, double cells_across);

}  // namespace springproof
