// Selects the bench's kernels for an instruction set of this processor.
#pragma once

#include "comparisons/bench/kernels/bench_kernels.h"
#include "msm/kernels/instruction_set.h"

namespace springproof::bench {

inline BenchKernels kernels_of(InstructionSet set) {
  switch (set) {
#ifdef SPRINGPROOF_X86_BENCH_KERNELS
    case InstructionSet::avx2:
      return avx2::bench_kernels();
    case InstructionSet::avx512:
      return avx512::bench_kernels();
#endif
    default:
      return portable::bench_kernels();
  }
}

}  // namespace springproof::bench
