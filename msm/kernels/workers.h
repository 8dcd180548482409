// Persistent worker threads: the parts of a time step are too short to start threads for.
#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "msm/kernels/aligned_array.h"

namespace springproof {

class Workers {
 public:
  /// `count` workers, of which the calling thread is number 0.
  explicit Workers(int count);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return static_cast<int>(threads_.size()) + 1; }

  /// Runs the job once for each worker, at the same time; returns when all are done.  Jobs must not throw.
  void run(const std::function<void(int worker)>& job);

 private:
  void work(int worker);

  std::vector<std::thread> threads_;
  const std::function<void(int)>* job_ = nullptr;  ///< nullptr: stop the worker
  std::atomic<int> round_ = 0;
  std::atomic<int> busy_ = 0;
};

/// Waits until `reached` is at least `value`: first by spinning, then yielding to other threads.
void wait_until(const std::atomic<long>& reached, long value);

/// Number of steps that a slab has completed; read by its neighbours.
struct alignas(cache_line) Progress {
  std::atomic<long> swept = 0;       ///< forces of all planes are computed
  std::atomic<long> first_done = 0;  ///< the first plane has moved
};

}  // namespace springproof
