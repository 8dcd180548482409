#include "msm/kernels/block_rows.h"

#include "msm/kernels/block_rows_of_set.h"

namespace springproof {

template <>
const BlockRowKernels<float>& block_row_kernels<float>(InstructionSet set) {
  switch (set) {
#ifdef SPRINGPROOF_X86_KERNELS
    case InstructionSet::avx2:
      return avx2::block_row_kernels_float;
    case InstructionSet::avx512:
      return avx512::block_row_kernels_float;
#endif
    default:
      return portable::block_row_kernels_float;
  }
}

template <>
const BlockRowKernels<double>& block_row_kernels<double>(InstructionSet set) {
  switch (set) {
#ifdef SPRINGPROOF_X86_KERNELS
    case InstructionSet::avx2:
      return avx2::block_row_kernels_double;
    case InstructionSet::avx512:
      return avx512::block_row_kernels_double;
#endif
    default:
      return portable::block_row_kernels_double;
  }
}

}  // namespace springproof
