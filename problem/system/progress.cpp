#include "problem/system/progress.h"

#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <utility>

namespace springproof::progress {
namespace {

using Clock = std::chrono::steady_clock;

thread_local Listener* current = nullptr;
thread_local std::string current_phase;
thread_local Clock::time_point last_said;

constexpr auto readable = std::chrono::milliseconds(100);  // between two details
constexpr auto look_again = std::chrono::milliseconds(200);

void say(const std::string& text) {
  last_said = Clock::now();
  (*current)(current_phase, text);
}

}  // namespace

Listening::Listening(Listener listener)
    : listener_(std::move(listener)),
      before_(std::exchange(current, &listener_)),
      phase_before_(std::exchange(current_phase, {})) {}

Listening::~Listening() {
  current = before_;
  current_phase = phase_before_;
}

void phase(const std::string& text) {
  if (!current) return;
  current_phase = text;
  say({});
}

void detail(const std::string& text) {
  if (current) say(text);
}

bool due() { return current && Clock::now() - last_said >= readable; }

Listener into_file(const std::filesystem::path& file) {
  return [file, beside = file.string() + ".new"](const std::string& phase, const std::string& detail) {
    std::ofstream(beside) << phase << '\n' << detail << '\n';
    std::error_code ignored;
    std::filesystem::rename(beside, file, ignored);
  };
}

Relay::Relay(std::filesystem::path file) : file_(std::move(file)) {
  if (!current) return;
  thread_ = std::jthread([this, to = *current](const std::stop_token& ended) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wake;
    while (!wake.wait_for(lock, ended, look_again, [&] { return ended.stop_requested(); })) pass_on(to);
  });
}

void Relay::pass_on(const Listener& to) {
  std::ifstream in(file_);
  std::string phase, detail;
  if (!std::getline(in, phase) || !std::getline(in, detail)) return;
  if (std::string now = phase + '\n' + detail; now != last_) {
    last_ = std::move(now);
    to(phase, detail);
  }
}

}  // namespace springproof::progress
