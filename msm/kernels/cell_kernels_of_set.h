// Cell kernels defined by each instruction set's copy of cell_operator_kernel.cpp.
#pragma once

#include "msm/kernels/cell_kernels.h"

namespace springproof {
namespace portable {
extern const CellKernels<float> cell_kernels_float;
extern const CellKernels<double> cell_kernels_double;
}  // namespace portable
namespace avx2 {
extern const CellKernels<float> cell_kernels_float;
extern const CellKernels<double> cell_kernels_double;
}  // namespace avx2
namespace avx512 {
extern const CellKernels<float> cell_kernels_float;
extern const CellKernels<double> cell_kernels_double;
}  // namespace avx512
}  // namespace springproof
