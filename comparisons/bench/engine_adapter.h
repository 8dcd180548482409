// Real-time engines as programs of their own: what is installed, a task in, a checked answer out.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparisons/bench/engine_bar.h"
#include "problem/system/child.h"

namespace springproof::bench {

/// What an engine is asked to do with the bar: forces at prescribed displacements, or steps, or both.
struct EngineTask {
  double time_step = 1.0 / 60;  ///< [s]
  int iterations = 1;           ///< per step, of engines that iterate
  std::string integrator = {};
  double duration = 0;                 ///< [s]; 0: no steps
  double damping = 0;                  ///< velocities are scaled by exp(-damping dt) after each step [1/s]
  double free = 0;                     ///< but for this last time [s]
  double gravity = 0;                  ///< the engine's own, along -z [m/s^2]
  NodalVectors forces = {};            ///< on the nodes [N]; empty: none
  NodalVectors velocities = {};        ///< at the start [m/s]; empty: at rest
  bool pinned = true;                  ///< x = 0 is held
  std::vector<NodalVectors> fields{};  ///< displacements at which forces are asked for [m]

  long steps() const;
};

/// The state after a step: time [s], kinetic energy [J], mean position of the watched nodes [m], angular momentum about
/// the rest centre [N m s].
struct EngineSample {
  double time, kinetic_energy;
  Vec3 tip, spin;
};

struct EngineAnswer {
  std::string engine;  ///< its name and version
  std::vector<EngineSample> samples;
  NodalVectors x;      ///< final positions [m]
  double seconds = 0;  ///< CPU time of the steps alone
  long steps = 0;
  bool burst = false;                ///< positions that are no numbers, or far away
  std::vector<NodalVectors> forces;  ///< at the fields [N]; empty: the engine gives none
};

/// Reads an adapter's answer.
/// @throws std::runtime_error if it is not what was asked for: numbers of nodes, steps or samples, a start that is not
/// the bar's, held nodes that moved.
EngineAnswer read_answer(const nlohmann::json& answer, const EngineTask& task, const EngineBar& bar);

/// An engine with a way to set it up: a row of the comparison.
struct EngineSetUp {
  enum class File { edges, tetrahedra, mjcf };

  std::string name;     ///< "MuJoCo, trilinear"
  std::string adapter;  ///< "mujoco", "jolt", "bullet", "springs"
  std::string set_up;   ///< passed on to the adapter
  File file = File::tetrahedra;
  bool any_poisson_ratio = true;  ///< else 1/4 alone, or none at all
  bool own_masses = false;        ///< other masses than ours, so that its gravity is another load
  bool gives_forces = true;
  /// Steps that are measured, the first being the one recommended; `motion`: those of the rows on motion.
  struct Step {
    double dt;
    int iterations;
    std::string integrator;
    bool motion = true;
  };
  std::vector<Step> steps;
};

/// The set-ups of `bench engines`.
const std::vector<EngineSetUp>& engine_set_ups();

/// The folder of the adapters, and that of the packages which they load ($XDG_CACHE_HOME/springproof/engines).
std::filesystem::path adapters_folder();
std::filesystem::path packages_folder();

/// Why the adapter cannot run and how to install what it needs; empty: it can.
std::string missing_for(const std::string& adapter);

/// `npm ci` of the locked packages in packages_folder().
/// @throws std::runtime_error if it fails.
void install_packages();

/// Runs adapters on the bar at one resolution; keeps the exported files.
class EngineRuns {
 public:
  explicit EngineRuns(const Cells& cells) : bar_(engine_bar(cells)) {}

  const EngineBar& bar() const { return bar_; }

  /// @throws std::runtime_error if the adapter fails or its answer cannot be believed, with its last words.
  EngineAnswer run(const EngineSetUp& set_up, double poisson_ratio, const EngineTask& task);

  /// Substeps per step of this length [s] that the exported file of edges asks for.
  int exported_substeps(double time_step);

 private:
  std::filesystem::path file(EngineSetUp::File kind, double poisson_ratio, bool pinned);

  EngineBar bar_;
  TemporaryFolder folder_;
  std::map<std::string, std::filesystem::path> files_;
};

}  // namespace springproof::bench
