// The runs of a part (a grid of the finite elements, a model on a lattice), one by one: each is kept when it is
// finished, so that --resume goes on from there, and what it took is told, from which the time left is estimated.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

namespace springproof {

/// Runs whose times are in proportion to what is expected of them: springs at rest, at large strain, at random places,
/// fitted to the patch test, and in motion; whole cases under another load case or with another input; finite elements
/// without and with an assembled matrix, and in motion.
enum class RunKind {
  springs,
  springs_at_large_strain,
  springs_at_random,
  springs_fitted,
  springs_in_motion,
  of_variations,
  matrix_free,
  assembled,
  finite_elements_in_motion
};
inline constexpr int run_kinds = 9;

/// What a run is expected to take on one core [s].
struct RunCost {
  RunKind kind = RunKind::springs;
  double seconds = 0;
};

/// Several threads may have one each, not share one.
class RunKeeper {
 public:
  /// Called once for each run, after it, with what was expected of it and what it took [s]; nothing if it was kept from
  /// before.
  using Listener = std::function<void(const RunCost& expected, std::optional<double> took)>;

  RunKeeper() = default;  ///< keeps nothing and tells nobody

  using Words = std::function<std::string()>;

  /// Told what is known before the part is finished, in words that are found only if they are asked for.
  using Sayer = std::function<void(const Words& words)>;

  /// @param folder for the files, made when it is needed
  /// @param stamp identifies the inputs: runs of others are not taken
  RunKeeper(std::filesystem::path folder, std::string stamp, Listener listener, Sayer sayer = {});

  bool keeps() const { return !folder_.empty(); }

  /// What was kept under this name; else what `make` returns, which is kept as JSON.
  template <class Make>
  auto run(const std::string& name, const RunCost& expected, const Make& make) const {
    if (const std::optional<nlohmann::json> kept = find(name)) {
      tell(name, expected, {});
      return kept->get<decltype(make())>();
    }
    const auto start = std::chrono::steady_clock::now();
    auto result = make();
    tell(name, expected, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (keeps()) keep(name, result);
    return result;
  }

  void say(const Words& words) const {
    if (sayer_) sayer_(words);
  }

  /// Keeps a run that was made elsewhere, in place of one of this name.
  void keep(const std::string& name, const nlohmann::json& content) const;

  /// Removes what is kept.
  void forget() const;

 private:
  std::optional<nlohmann::json> find(const std::string& name) const;
  void tell(const std::string& name, const RunCost& expected, std::optional<double> took) const;

  std::filesystem::path folder_;
  std::string stamp_;
  Listener listener_;
  Sayer sayer_;
  mutable std::set<std::string> told_;
};

}  // namespace springproof
