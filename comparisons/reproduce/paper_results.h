// The results from which figures of a paper are drawn, read from folders that `springproof compare` wrote.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/results/records.h"

namespace springproof {

/// A value that a paper prints, beside ours.
struct PrintedValue {
  std::string case_name;
  std::string model;
  double poisson_ratio = 0;
  Cells cells = {0, 0, 0};
  std::string measure, unit;
  double printed = 0;
  std::optional<double> ours, fem;  ///< fem: the converged finite elements
  std::string where, remark;
};

/// The deformed surface of one run.
struct Shape {
  std::vector<Vec3> rest, displaced;  ///< nodes [m]
  std::vector<std::array<int, 4>> facets;
};

class PaperResults {
 public:
  /// A case that several folders hold is that of the last.
  /// @throws InputError if a folder holds no results of `springproof compare`.
  explicit PaperResults(const std::vector<std::filesystem::path>& folders);

  bool has(const std::string& case_name) const;

  /// Rows of a case in the order of its file; empty if there is no such case.
  const std::vector<Row>& rows(const std::string& case_name) const { return read(case_name).rows; }
  const std::vector<LineRecord>& lines(const std::string& case_name) const { return read(case_name).lines; }

  /// The row of a model; without cells that of the coarsest lattice.  Null: none.
  const Row* row(const std::string& case_name, const std::string& model, double poisson_ratio,
                 const std::string& measure, const std::optional<Cells>& cells = {}) const;

  /// Printed values of a case whose place begins with `where` ("Table 2", "Fig. 13") and is not longer by a digit; by
  /// Poisson's ratio and cells.
  std::vector<PrintedValue> printed(const std::string& case_name, const std::string& where) const;

  /// The outer facets of a model's cells; without cells those of the coarsest lattice.  Empty: no such picture.
  std::optional<Shape> shape(const std::string& case_name, const std::string& model, double poisson_ratio,
                             const std::optional<Cells>& cells = {}) const;

  /// Cracks of a model in a drying body seen from above, on the finest lattice: an SVG document.  Empty: there is none.
  /// @throws InputError if the folder holds another file in its place.
  std::string cracks(const std::string& case_name, const std::string& model) const;

  /// Why a model has no result: "no stable equilibrium beyond 0.21 of the load"; empty: it has one, or was not run.
  std::string failure(const std::string& case_name, const std::string& model, double poisson_ratio) const;

 private:
  struct FailedRun {
    std::string model;
    double poisson_ratio = 0;
    std::string message;
  };
  struct ReadCase {
    std::vector<Row> rows;
    std::vector<PrintedValue> printed;
    std::vector<LineRecord> lines;
    std::vector<FailedRun> failed;
    std::filesystem::path folder;
  };
  void add(const std::filesystem::path& folder);
  const ReadCase& read(const std::string& case_name) const;  ///< empty: there is none
  const std::vector<Picture>& pictures(const std::string& case_name) const;

  std::map<std::string, ReadCase> cases_;                         ///< by their last folder and name
  mutable std::map<std::string, std::vector<Picture>> pictures_;  ///< read when first asked for
};

}  // namespace springproof
