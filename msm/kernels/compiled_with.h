// The instructions that the kernels of each set were compiled with: constants of each copy of lattice_kernel.cpp.
#pragma once

namespace springproof {

struct CompiledWith {
  bool avx2, avx512;
};

namespace portable {
extern const CompiledWith compiled_with;
}
namespace avx2 {
extern const CompiledWith compiled_with;
}
namespace avx512 {
extern const CompiledWith compiled_with;
}

}  // namespace springproof
