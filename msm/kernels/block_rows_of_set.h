// Kernels of block rows defined by each instruction set's copy of block_rows_kernel.cpp.
#pragma once

#include "msm/kernels/block_rows.h"

namespace springproof {
namespace portable {
extern const BlockRowKernels<float> block_row_kernels_float;
extern const BlockRowKernels<double> block_row_kernels_double;
}  // namespace portable
namespace avx2 {
extern const BlockRowKernels<float> block_row_kernels_float;
extern const BlockRowKernels<double> block_row_kernels_double;
}  // namespace avx2
namespace avx512 {
extern const BlockRowKernels<float> block_row_kernels_float;
extern const BlockRowKernels<double> block_row_kernels_double;
}  // namespace avx512
}  // namespace springproof
