#include "comparisons/sweep/status.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>

#include "problem/processes/child.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto rewrite_every = std::chrono::milliseconds(200);
constexpr double long_phase = 10;  // [s]
constexpr const char clear_line[] = "\r\x1b[K";

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Of the first status of the program: a bar goes on where the one before has ended.
Clock::time_point first_begun() {
  static const Clock::time_point begun = Clock::now();
  return begun;
}

/// Columns of the terminal; 80 if unknown.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Characters, not bytes, of UTF-8.
bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string cut(const std::string& text, std::size_t width) {
  if (length(text) <= width) return text;
  if (width < 3) return {};
  std::size_t kept = 0, bytes = 0;
  for (; kept < width - 3 || !begins_character(text[bytes]); ++bytes) kept += begins_character(text[bytes]);
  return text.substr(0, bytes) + "...";
}

std::string joined(const std::string& a, const std::string& separator, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + separator + b;
}

std::string words(const Activity& a) { return joined(a.title, ": ", joined(a.phase, ", ", a.detail)); }

std::string left_words(std::optional<double> left) {
  return left ? fmt::format(", about {} left", time_words(*left)) : "";
}

/// "[####......] "
std::string bar_of(double share) {
  constexpr int tenths = 10;
  const int done = std::clamp(static_cast<int>(share * tenths), 0, tenths);
  return fmt::format("[{}{}] ", std::string(done, '#'), std::string(tenths - done, '.'));
}

/// Clears the live line before the process is killed by a signal.
void clear_and_die(int signal) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, clear_line, sizeof clear_line - 1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void clear_on_death() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_DFL) std::signal(signal, clear_and_die);
  }
}

}  // namespace

struct Status::Entry {
  std::string title;
  Clock::time_point start = Clock::now(), phase_start = start;
  std::string phase = {}, detail = {};
  bool phase_is_said = false;

  Activity activity() const { return {title, phase, detail, seconds_since(start), seconds_since(phase_start)}; }
};

std::string time_words(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const long minutes = std::lround(seconds / 60);
  if (minutes < 100) return fmt::format("{} min", minutes);
  const long tens = std::lround(seconds / 600);
  return tens % 6 == 0 ? fmt::format("{} h", tens / 6) : fmt::format("{} h {} min", tens / 6, tens % 6 * 10);
}

std::string live_line(const std::vector<Activity>& running, const Span& span, std::size_t width) {
  if (running.empty()) return {};
  constexpr std::size_t width_for_a_bar = 79;
  const bool has_bar = span.left && width >= width_for_a_bar;
  const std::string bar = has_bar ? bar_of(span.spent / std::max(span.spent + *span.left, 1e-9)) : "";
  width -= bar.size();
  const Activity& first = running.front();
  const std::string tail = fmt::format(", {}{}{}", time_words(first.seconds), left_words(span.left),
                                       running.size() > 1 ? fmt::format(" (and {} more)", running.size() - 1) : "");
  return bar + cut(cut(words(first), width - std::min(width, length(tail))) + tail, width);
}

std::string phase_line(const Activity& a, std::optional<double> left) {
  return fmt::format("  {} ({} so far{})", words(a), time_words(a.phase_seconds), left_words(left));
}

Status::Status(bool quiet, std::function<std::optional<double>()> left)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO)), left_(std::move(left)) {
  if (quiet_) return;
  first_begun();
  if (terminal_) clear_on_death();
  thread_ = std::jthread([this](const std::stop_token& ended) {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, ended, rewrite_every, [&] { return ended.stop_requested(); })) show();
  });
}

Status::~Status() {
  thread_ = {};
  if (line_is_shown_) to_stderr(clear_line);
}

void Status::print(const std::string& line) {
  const std::lock_guard lock(mutex_);
  to_stderr("{}{}\n", line_is_shown_ ? clear_line : "", line);
  line_is_shown_ = false;
}

void Status::show() {
  if (children_interrupted()) return rewrite({});
  const std::optional<double> left = left_ ? left_() : std::nullopt;
  std::vector<Activity> running;
  for (Entry& e : entries_) {
    running.push_back(e.activity());
    if (terminal_ || e.phase_is_said || running.back().phase_seconds < long_phase) continue;
    e.phase_is_said = true;
    to_stderr("{}\n", phase_line(running.back(), left));
  }
  if (terminal_) rewrite(live_line(running, {seconds_since(first_begun()), left}, terminal_width() - 1));
}

void Status::rewrite(const std::string& live_line) {
  if (live_line.empty() && !line_is_shown_) return;
  to_stderr("{}{}", clear_line, live_line);
  line_is_shown_ = !live_line.empty();
}

Status::Working::Working(Status& status, const std::string& title)
    : status_(status),
      entry_([&] {
        const std::lock_guard lock(status.mutex_);
        return status.entries_.insert(status.entries_.end(), Entry{title});
      }()),
      listening_([&status, entry = entry_](const std::string& phase, const std::string& detail) {
        const std::lock_guard lock(status.mutex_);
        if (phase != entry->phase) {
          entry->phase = phase;
          entry->phase_start = Clock::now();
          entry->phase_is_said = false;
        }
        entry->detail = detail;
      }) {}

Status::Working::~Working() {
  const std::lock_guard lock(status_.mutex_);
  status_.entries_.erase(entry_);
}

}  // namespace springproof
