#include "msm/kernels/kernels.h"

#include <algorithm>
#include <stdexcept>

namespace springproof {

// msm/kernels/compiled/all_kernels.cpp, once per instruction set.
namespace portable {
template <class Real>
Kernels<Real> all_kernels();
}
namespace avx2 {
template <class Real>
Kernels<Real> all_kernels();
}
namespace avx512 {
template <class Real>
Kernels<Real> all_kernels();
}

template <class Real>
const Kernels<Real>& kernels_of(InstructionSet set) {
  const auto& usable = usable_instruction_sets();
  if (std::find(usable.begin(), usable.end(), set) == usable.end())
    throw std::invalid_argument("instruction set " + name_of(set) + " cannot be used here");
#ifdef SPRINGPROOF_X86_KERNELS
  if (set == InstructionSet::avx512) {
    static const Kernels<Real> of_avx512 = avx512::all_kernels<Real>();
    return of_avx512;
  }
  if (set == InstructionSet::avx2) {
    static const Kernels<Real> of_avx2 = avx2::all_kernels<Real>();
    return of_avx2;
  }
#endif
  static const Kernels<Real> of_any = portable::all_kernels<Real>();
  return of_any;
}

template const Kernels<double>& kernels_of<double>(InstructionSet set);
template const Kernels<float>& kernels_of<float>(InstructionSet set);

}  // namespace springproof
