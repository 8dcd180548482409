// What a long run is at: said where the work is done, heard by whoever shows it.  Without a listener it costs next to
// nothing.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>

namespace springproof::progress {

/// Told the phase that the work is in, "finite elements 2 of 5, q2 on 12 x 12 x 12 cells", and how far it is in it,
/// "120 iterations" (may be empty).  Called from the thread that works, and from a Relay's.
using Listener = std::function<void(const std::string& phase, const std::string& detail)>;

/// This thread's listener to the end of the scope; then that from before.
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

/// How far this thread is in its phase.
void detail(const std::string& text);

/// True if this thread has a listener and the last detail was said a tenth of a second ago.
bool due();

/// detail(describe()), not more often than it can be read.
template <class Describe>
requires std::is_invocable_v<Describe>
void detail(const Describe& describe) {
  if (due()) detail(std::string(describe()));
}

/// Writes what it is told into a file, whole each time.
Listener into_file(const std::filesystem::path& file);

/// Passes on to this thread's listener what another program writes by into_file(), to the end of the scope.
class Relay {
 public:
  explicit Relay(std::filesystem::path file);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

 private:
  void pass_on(const Listener& to);

  const std::filesystem::path file_;
  std::string last_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace springproof::progress
