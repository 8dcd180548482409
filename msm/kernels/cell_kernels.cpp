#include "msm/kernels/cell_kernels.h"

#include "msm/kernels/cell_kernels_of_set.h"

namespace springproof {

template <>
const CellKernels<float>& cell_kernels<float>(InstructionSet set) {
  switch (set) {
#ifdef SPRINGPROOF_X86_KERNELS
    case InstructionSet::avx2:
      return avx2::cell_kernels_float;
    case InstructionSet::avx512:
      return avx512::cell_kernels_float;
#endif
    default:
      return portable::cell_kernels_float;
  }
}

template <>
const CellKernels<double>& cell_kernels<double>(InstructionSet set) {
  switch (set) {
#ifdef SPRINGPROOF_X86_KERNELS
    case InstructionSet::avx2:
      return avx2::cell_kernels_double;
    case InstructionSet::avx512:
      return avx512::cell_kernels_double;
#endif
    default:
      return portable::cell_kernels_double;
  }
}

}  // namespace springproof
