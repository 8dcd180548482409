#include "comparisons/bench/machine.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>

#include "comparisons/advise/speed.h"
#include "comparisons/bench/timer.h"

namespace springproof::bench {
namespace {

/// "512K", "32M" in bytes.
double size_of(const std::string& text) {
  const double number = std::atof(text.c_str());
  return number * (text.ends_with("M") ? 1048576 : text.ends_with("K") ? 1024 : 1);
}

std::string first_word(const std::string& file) {
  std::string word;
  std::ifstream(file) >> word;
  return word;
}

std::vector<MemoryLevel> caches() {
  std::vector<MemoryLevel> levels;
  for (int i = 0; i < 8; ++i) {
    const std::string at = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    const std::string type = first_word(at + "type");
    if (type == "Data" || type == "Unified")
      levels.push_back({"L" + first_word(at + "level"), size_of(first_word(at + "size"))});
  }
  if (levels.empty()) levels = {{"L1", 32768}, {"L2", 524288}, {"L3", 16777216}};  // if the system does not report them
  return levels;
}

struct Array {
  explicit Array(long n)
      : data(static_cast<double*>(::operator new[](std::size_t(n) * 8, std::align_val_t(4096)))), size(n) {
    std::fill(data, data + n, 1.0);
  }
  ~Array() { ::operator delete[](data, std::align_val_t(4096)); }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  double* data;
  long size;
};

Arithmetic measure_arithmetic(InstructionSet set, const TimerOptions& options) {
  const BenchKernels k = kernels_of(set);
  double sink64 = 1;
  float sink32 = 1;
  const std::vector<double> seconds =
      least_seconds({[&](long n) { k.fma64(1000 * n, &sink64); }, [&](long n) { k.fma32(1000 * n, &sink32); },
                     [&](long n) { k.root64(100 * n, &sink64); }, [&](long n) { k.root32(100 * n, &sink32); }},
                    options);
  const double flops = 2.0 * fma_per_round * 1000, roots = 1e-9 * roots_per_round * 100;
  return {name_of(set), 1e-9 * flops * k.lanes64 / seconds[0], 1e-9 * flops * k.lanes32 / seconds[1],
          seconds[2] / (roots * k.lanes64), seconds[3] / (roots * k.lanes32)};
}

double read_GB_s(const BenchKernels& k, double bytes, const TimerOptions& options) {
  const Array a(std::max(1L, long(bytes / 8 / 64)) * 64);
  volatile double sink = 0;
  const double seconds = least_seconds({[&](long n) {
                                         for (long i = 0; i < n; ++i) sink = sink + k.read(a.data, a.size);
                                       }},
                                       options)[0];
  return 8e-9 * double(a.size) / seconds;
}

/// Best bandwidth over a few array sizes between two cache levels.
double level_GB_s(const BenchKernels& k, double inner, double bytes, const TimerOptions& options) {
  double best = 0;
  for (const double part : {0.125, 0.25, 0.5})
    if (const double size = part * bytes; size >= 1.5 * inner) best = std::max(best, read_GB_s(k, size, options));
  return best > 0 ? best : read_GB_s(k, 0.5 * bytes, options);
}

/// Triad of `threads` threads at once, each on its own part of arrays larger than any cache.
double triad_GB_s(const BenchKernels& k, double last_cache, int threads, TimerOptions options) {
  const long n = std::max(4194304L, long(2 * last_cache / 8 / 64) * 64) / threads / 64 * 64;
  const Array a(n * threads), b(n * threads), c(n * threads);
  options.clock = threads > 1 ? Clock::wall : Clock::thread;
  const double seconds = least_seconds({[&](long steps) {
                                         const auto work = [&](int t) {
                                           for (long i = 0; i < steps; ++i)
                                             k.triad(a.data + t * n, b.data + t * n, c.data + t * n, 0.5, n);
                                         };
                                         std::vector<std::jthread> others;
                                         for (int t = 1; t < threads; ++t) others.emplace_back(work, t);
                                         work(0);
                                       }},
                                       options)[0];
  return 32e-9 * double(n * threads) / seconds;
}

}  // namespace

const MemoryLevel& Machine::level_for(double bytes) const {
  for (const MemoryLevel& level : memory)
    if (bytes <= 0.9 * level.bytes) return level;
  return memory.back();
}

BenchKernels kernels_of([[maybe_unused]] InstructionSet set) {
#ifdef SPRINGPROOF_X86_BENCH_KERNELS
  if (set == InstructionSet::avx2) return avx2::bench_kernels();
  if (set == InstructionSet::avx512) return avx512::bench_kernels();
#endif
  return portable::bench_kernels();
}

Machine this_machine() {
  const std::string name = processor_name();
  return {name.empty() ? "unknown" : name, std::max(1, int(std::thread::hardware_concurrency())), {}, caches()};
}

void measure_limits(bool quick, Machine& machine) {
  const TimerOptions options{2e-3, quick ? 0.03 : 0.2, Clock::thread};
  for (const InstructionSet set : usable_instruction_sets())
    machine.arithmetic.push_back(measure_arithmetic(set, options));
  const BenchKernels widest = kernels_of(usable_instruction_sets().back());
  double inner = 0;
  for (MemoryLevel& level : machine.memory) {
    level.GB_s = level_GB_s(widest, inner, level.bytes, options);
    inner = level.bytes;
  }
  TimerOptions longer = options;
  longer.budget = quick ? 0.2 : 1;
  machine.memory.push_back(
      {"DRAM", 0, triad_GB_s(widest, inner, 1, longer), triad_GB_s(widest, inner, machine.cores, longer)});
}

nlohmann::json to_json(const Machine& machine) {
  nlohmann::json memory = nlohmann::json::array(), arithmetic = nlohmann::json::array();
  for (const MemoryLevel& l : machine.memory)
    memory.push_back({{"name", l.name}, {"bytes", l.bytes}, {"GB_per_s", l.GB_s}, {"GB_per_s_all_cores", l.all_cores}});
  for (const Arithmetic& a : machine.arithmetic)
    arithmetic.push_back({{"instruction_set", a.instruction_set},
                          {"gflops_fp64", a.gflops64},
                          {"gflops_fp32", a.gflops32},
                          {"inverse_root_ns_fp64", a.root64},
                          {"inverse_root_ns_fp32", a.root32}});
  return {{"processor", machine.processor}, {"cores", machine.cores}, {"memory", memory}, {"arithmetic", arithmetic}};
}

}  // namespace springproof::bench
