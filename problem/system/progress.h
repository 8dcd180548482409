// Progress of long runs, reported where the work is done to a listener that displays it.  Without a listener the cost
// is negligible.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <type_traits>

namespace springproof::progress {

/// Called with the current phase, "finite elements 2 of 5, q2 on 12 x 12 x 12 cells", and the progress within it, "120
/// iterations" (may be empty), from the working thread or from that of a Relay.
using Listener = std::function<void(const std::string& phase, const std::string& detail)>;

/// Sets this thread's listener until the end of the scope, then restores the previous one.
class Listening {
 public:
  explicit Listening(Listener listener);
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  Listener listener_;
  Listener* before_;
  std::string phase_before_;
};

/// Begins a phase.
void phase(const std::string& text);

/// Reports the progress of this thread within its phase.
void detail(const std::string& text);

/// True if this thread has a listener and its last report is at least a tenth of a second old.
bool due();

/// detail(describe()), if due().
template <class Describe>
requires std::is_invocable_v<Describe>
void detail(const Describe& describe) {
  if (due()) detail(std::string(describe()));
}

/// A listener that replaces the contents of a file at each report.
Listener into_file(const std::filesystem::path& file);

/// Forwards what another program reports by into_file() to this thread's listener, until the end of the scope.
class Relay {
 public:
  explicit Relay(std::filesystem::path file);

 private:
  void pass_on(const Listener& to);

  const std::filesystem::path file_;
  std::string last_;
  std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace springproof::progress
