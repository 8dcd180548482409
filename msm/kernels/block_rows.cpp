#include "msm/kernels/block_rows.h"

#include "msm/kernels/kernels_of_set.h"

namespace springproof {

template <>
const BlockRowKernels<float>& block_row_kernels<float>(InstructionSet set) {
  return SPRINGPROOF_KERNELS_OF(set, block_row_kernels_float);
}

template <>
const BlockRowKernels<double>& block_row_kernels<double>(InstructionSet set) {
  return SPRINGPROOF_KERNELS_OF(set, block_row_kernels_double);
}

}  // namespace springproof
