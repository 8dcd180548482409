// The table of an instruction set.
#include "msm/kernels/compiled/all_kernels.h"

#include "msm/kernels/kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

#if defined(__AVX512F__)
extern const CompiledWith compiled_with = {true, true};
#elif defined(__AVX2__)
extern const CompiledWith compiled_with = {true, false};
#else
extern const CompiledWith compiled_with = {false, false};
#endif

template <class Real>
Kernels<Real> all_kernels() {
  return {lattice_kernels<Real>(),   cell_kernels<Real>(),      list_kernels<Real>(),
          cell_list_kernels<Real>(), block_row_kernels<Real>(), dense_kernels<Real>()};
}

template Kernels<double> all_kernels();
template Kernels<float> all_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
