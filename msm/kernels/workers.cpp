#include "msm/kernels/workers.h"

namespace springproof {
namespace {

constexpr int patience = 4000;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Waits for a change from `old`: first by spinning, then asleep.
void wait_for_change(const std::atomic<int>& value, int old) {
  for (int i = 0; i < patience; ++i) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Workers::Workers(int count) {
  for (int w = 1; w < count; ++w) threads_.emplace_back([this, w] { work(w); });
}

Workers::~Workers() {
  job_ = nullptr;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void Workers::run(const std::function<void(int)>& job) {
  if (!threads_.empty()) {
    job_ = &job;
    busy_.store(static_cast<int>(threads_.size()), std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
  }
  job(0);
  for (int left = busy_.load(std::memory_order_acquire); left > 0; left = busy_.load(std::memory_order_acquire))
    wait_for_change(busy_, left);
}

void Workers::work(int worker) {
  for (int round = 0;; ++round) {
    wait_for_change(round_, round);
    if (!job_) return;
    (*job_)(worker);
    busy_.fetch_sub(1, std::memory_order_release);
    busy_.notify_one();
  }
}

void wait_until(const std::atomic<long>& reached, long value) {
  for (int i = 0; reached.load(std::memory_order_acquire) < value; ++i) {
    if (i < patience)
      pause();
    else
      std::this_thread::yield();
  }
}

}  // namespace springproof
