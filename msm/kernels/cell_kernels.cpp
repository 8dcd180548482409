#include "msm/kernels/cell_kernels.h"

#include "msm/kernels/kernels_of_set.h"

namespace springproof {

template <>
const CellKernels<float>& cell_kernels<float>(InstructionSet set) {
  return SPRINGPROOF_KERNELS_OF(set, cell_kernels_float);
}

template <>
const CellKernels<double>& cell_kernels<double>(InstructionSet set) {
  return SPRINGPROOF_KERNELS_OF(set, cell_kernels_double);
}

}  // namespace springproof
