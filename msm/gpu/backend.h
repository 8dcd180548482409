// Memory and parallel loops of a GPU, by CUDA.  Where a source is compiled without CUDA, the same by the processor,
// thread by thread: slow, and how the tests run a GPU's code on a machine that has none.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#define SPRINGPROOF_ONE_LANE
#define SPRINGPROOF_KERNEL_NAMESPACE gpu
#include "msm/kernels/compiled/one_lane.h"

namespace springproof::gpu {

constexpr int tile_x = 32, tile_y = 8;  ///< threads of a block of a sweep
constexpr int sums_of_launch = 2;       ///< sums that a sweep can form, over all its threads

/// Before a loop: the compiler for GPUs repeats its body, so that the loads of all passes are under way together.
#ifdef __CUDACC__
#define SPRINGPROOF_UNROLL _Pragma("unroll")
#else
#define SPRINGPROOF_UNROLL
#endif

/// Where a thread of a sweep is.
struct ThreadPlace {
  int lane, line;  ///< in its block
  int block[3];
};

#ifdef __CUDACC__

inline void check(cudaError_t status) {
  if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}
inline void* allocate(std::size_t bytes) {
  void* p = nullptr;
  if (cudaMalloc(&p, bytes) != cudaSuccess)
    throw std::runtime_error("the GPU has no " + std::to_string(bytes >> 20) +
                             " MiB left (without SPRINGPROOF_DEVICE = gpu the processor computes)");
  return p;
}
inline void release(void* p) { cudaFree(p); }
inline void clear(void* p, std::size_t bytes) { check(cudaMemset(p, 0, bytes)); }
inline void upload(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
}
inline void download(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost));
}
inline void wait() { check(cudaDeviceSynchronize()); }

/// Adds the threads' sums of a block and stores them at partial[block][...].
__device__ inline void add_up(const double (&sums)[sums_of_launch], int thread, int threads, long block,
                              double* partial) {
  __shared__ double shared[sums_of_launch][32];
  for (int i = 0; i < sums_of_launch; ++i) {
    double sum = sums[i];
    for (int offset = 16; offset > 0; offset /= 2) sum += __shfl_down_sync(0xffffffff, sum, offset);
    if (thread % 32 == 0) shared[i][thread / 32] = sum;
  }
  __syncthreads();
  if (thread != 0) return;
  for (int i = 0; i < sums_of_launch; ++i) {
    double sum = 0;
    for (int warp = 0; warp < threads / 32; ++warp) sum += shared[i][warp];
    partial[block * sums_of_launch + i] = sum;
  }
}

template <class Sweep>
__global__ void __launch_bounds__(tile_x* tile_y, Sweep::blocks_at_once)
    sweep_on_device(const __grid_constant__ Sweep sweep) {
  __shared__ typename Sweep::Shared shared[2];
  typename Sweep::Thread t;
  const ThreadPlace place = {int(threadIdx.x), int(threadIdx.y), {int(blockIdx.x), int(blockIdx.y), int(blockIdx.z)}};
  sweep.start(place, t);
  for (int z = sweep.first_plane(place) - 1; z < sweep.end_plane(place); ++z) {
    sweep.cells(place, z, t, shared[z & 1]);
    if (Sweep::exchanges) __syncthreads();  // one is enough: the other half is read by nobody any more
    sweep.nodes(place, z, t, shared[z & 1]);
  }
  if (sweep.partial)
    add_up(t.sums, threadIdx.y * tile_x + threadIdx.x, tile_x * tile_y,
           (blockIdx.z * long(gridDim.y) + blockIdx.y) * gridDim.x + blockIdx.x, sweep.partial);
}

template <class Each>
__global__ void each_on_device(const __grid_constant__ Each each, long n) {
  for (long i = blockIdx.x * long(blockDim.x) + threadIdx.x; i < n; i += long(blockDim.x) * gridDim.x) each(i);
}

/// Runs a sweep (msm/gpu/sweep.h) on blocks of tile_x x tile_y threads.
template <class Sweep>
void launch(const Sweep& sweep, const int (&blocks)[3]) {
  sweep_on_device<<<dim3(blocks[0], blocks[1], blocks[2]), dim3(tile_x, tile_y)>>>(sweep);
  check(cudaGetLastError());
}

/// each(i) for 0 <= i < n.
template <class Each>
void launch_each(const Each& each, long n) {
  constexpr long most_blocks = 1024, threads = 256;
  if (n == 0) return;
  each_on_device<<<std::min(most_blocks, (n + threads - 1) / threads), threads>>>(each, n);
  check(cudaGetLastError());
}

#else

inline void* allocate(std::size_t bytes) { return ::operator new(bytes); }
inline void release(void* p) { ::operator delete(p); }
inline void clear(void* p, std::size_t bytes) { std::memset(p, 0, bytes); }
inline void upload(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
inline void download(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
inline void wait() {}

template <class Sweep>
void launch(const Sweep& sweep, const int (&blocks)[3]) {
  const auto shared = std::make_unique<typename Sweep::Shared[]>(2);
  std::vector<typename Sweep::Thread> threads(tile_x * tile_y);
  const auto each_thread = [&](const int(&block)[3], const auto& work) {
    for (int line = 0; line < tile_y; ++line)
      for (int lane = 0; lane < tile_x; ++lane)
        work(ThreadPlace{lane, line, {block[0], block[1], block[2]}}, threads[line * tile_x + lane]);
  };
  long number = 0;
  for (int bz = 0; bz < blocks[2]; ++bz)
    for (int by = 0; by < blocks[1]; ++by)
      for (int bx = 0; bx < blocks[0]; ++bx, ++number) {
        const int block[3] = {bx, by, bz};
        const ThreadPlace any = {0, 0, {bx, by, bz}};
        each_thread(block, [&](const ThreadPlace& place, auto& t) {
          t = {};
          sweep.start(place, t);
        });
        for (int z = sweep.first_plane(any) - 1; z < sweep.end_plane(any); ++z) {
          each_thread(block, [&](const ThreadPlace& place, auto& t) { sweep.cells(place, z, t, shared[z & 1]); });
          each_thread(block, [&](const ThreadPlace& place, auto& t) { sweep.nodes(place, z, t, shared[z & 1]); });
        }
        if (!sweep.partial) continue;
        for (int i = 0; i < sums_of_launch; ++i) {
          double& sum = sweep.partial[number * sums_of_launch + i] = 0;
          for (const auto& t : threads) sum += t.sums[i];
        }
      }
}

template <class Each>
void launch_each(const Each& each, long n) {
  for (long i = 0; i < n; ++i) each(i);
}

#endif

/// Values in the device's memory.
template <class T>
class Array {
 public:
  Array() = default;
  explicit Array(long size) : size_(size), data_(static_cast<T*>(allocate(bytes()))) { clear(); }
  explicit Array(const std::vector<T>& values) : Array(static_cast<long>(values.size())) { write(values.data()); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Array() {
    if (data_) release(data_);
  }

  T* data() const { return data_; }
  long size() const { return size_; }
  std::size_t bytes() const { return sizeof(T) * static_cast<std::size_t>(size_); }
  void clear() {
    if (size_) gpu::clear(data_, bytes());
  }
  void write(const T* values) {
    if (size_) upload(data_, values, bytes());
  }
  void read(T* values) const {
    if (size_) download(values, data_, bytes());
  }
  void swap(Array& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

 private:
  long size_ = 0;
  T* data_ = nullptr;
};

}  // namespace springproof::gpu
