// Shows the running work on standard error: on a terminal one line, rewritten in place; elsewhere a line per long
// phase.
#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "problem/system/progress.h"

namespace springproof {

/// "12 s", "3 min", "1 h 20 min": suitably rounded.
std::string time_words(double seconds);

/// A running piece of work.
struct Activity {
  std::string title;          ///< "[3/8] golec_2019/bending  nu0.3"
  std::string phase, detail;  ///< as in problem/system/progress.h
  double seconds = 0;         ///< since it began
  double phase_seconds = 0;   ///< since its phase began
};

/// Seconds since everything began and, where known, to its end.
struct Span {
  double spent = 0;
  std::optional<double> left = {};
};

/// The running work in at most `width` characters: a bar of the time spent, where its end is known and 80 are there,
/// the first (the oldest) with its phase, the time left, the number of others.
std::string live_line(const std::vector<Activity>& running, const Span& span, std::size_t width);

/// "  golec_2019/bending  nu0.3: finite elements 2 of 5, ... (10 s so far, about 3 min left)".
std::string phase_line(const Activity& activity, std::optional<double> left);

/// Shows the progress of all Working scopes, from any number of threads, and the lines printed through it.
class Status {
 public:
  /// `left`: seconds to the end of everything, if known.  Quiet: shows nothing but what is printed.
  explicit Status(bool quiet = false, std::function<std::optional<double>()> left = {});
  ~Status();  ///< removes the live line, also after an interrupt
  Status(const Status&) = delete;
  Status& operator=(const Status&) = delete;

  /// Prints a permanent line.
  void print(const std::string& line);

  /// This thread's work, to the end of the scope.
  class Working;

 private:
  struct Entry;
  void show();
  void rewrite(const std::string& live_line);

  const bool quiet_, terminal_;
  const std::function<std::optional<double>()> left_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool line_is_shown_ = false;
  std::list<Entry> entries_;
  std::jthread thread_;  ///< last: it ends before what it uses
};

class Status::Working {
 public:
  Working(Status& status, const std::string& title);
  ~Working();
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

 private:
  Status& status_;
  std::list<Entry>::iterator entry_;
  progress::Listening listening_;
};

}  // namespace springproof
